// A stock viewer: draws glTF files with three.js, each from two sides, and sends the pictures back.
import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { RoomEnvironment } from "three/addons/environments/RoomEnvironment.js";

const EDGE = 256;
const pictures = [];
const renderer = new THREE.WebGLRenderer({ preserveDrawingBuffer: true });
renderer.setSize(EDGE, EDGE);
renderer.toneMapping = THREE.NeutralToneMapping;
const environment = new THREE.PMREMGenerator(renderer).fromScene(new RoomEnvironment()).texture;

async function draw(url) {
  const { scene: model } = await new GLTFLoader().loadAsync(url);
  const scene = new THREE.Scene();
  scene.environment = environment;
  scene.background = new THREE.Color(0x8090a0);
  scene.add(model);
  const box = new THREE.Box3().setFromObject(model);
  const centre = box.getCenter(new THREE.Vector3());
  const radius = Math.max(box.getSize(new THREE.Vector3()).length() / 2, 1e-6);
  const drawn = [];
  for (const from of [[0.7, 0.5, 0.9], [-0.8, 0.25, 0.4]]) {
    const camera = new THREE.PerspectiveCamera(40, 1, radius / 100, radius * 10);
    camera.position.copy(centre).addScaledVector(new THREE.Vector3(...from).normalize(), 2 * radius);
    camera.lookAt(centre);
    renderer.render(scene, camera);
    drawn.push(renderer.domElement.toDataURL("image/png"));
  }
  return drawn;
}

for (const url of JSON.parse(document.getElementById("files").textContent)) {
  try {
    pictures.push(await draw(url));
  } catch (error) {
    pictures.push(String(error));
  }
}
const { port } = document.getElementById("files").dataset;
await fetch(`http://127.0.0.1:${port}/`, { method: "POST", mode: "no-cors", body: JSON.stringify(pictures) });
