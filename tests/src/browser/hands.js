// The hands and eyes of the probe: works controls as a reader would, and tells what the canvas should show from the pictures
// that the report holds. One module is made of this file and `probe.js`.
const { problems, release } = window.probe;
const counts = { checks: 0, pictures: 0, options: 0, moments: 0, columns: 0, rows: 0, plots: 0, twins: 0 };
let report, pictures, width, height;

const byId = (id) => document.getElementById(id);
const control = (name) => byId(`viewer-${name}`);
const settled = () => window.sunbakeViewer.settled();
const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
const json = (id) => JSON.parse(byId(id).textContent);

function expect(is, what) {
  counts.checks += 1;
  if (!is) problems.push(what);
}

// --- Working the page --------------------------------------------------------------------------------------------

async function enter(input, value) {
  input.value = value;
  for (const type of ["input", "change"]) input.dispatchEvent(new Event(type, { bubbles: true }));
  await settled();
}

async function pick(group, value) {
  control(group).querySelector(`input[value="${value}"]`).click();
  await settled();
}

async function press(target, key, more = {}) {
  target.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true, ...more }));
  await settled();
}

/** A pointer's event at a place of the picture, given as shares of its width and height. */
function pointer(type, x, y) {
  const box = control("canvas").getBoundingClientRect();
  const place = { clientX: box.left + x * box.width, clientY: box.top + y * box.height };
  const common = { bubbles: true, cancelable: true, pointerId: 1, isPrimary: true, button: type === "pointermove" ? -1 : 0 };
  control("stage").dispatchEvent(new PointerEvent(type, { ...common, ...place }));
}

function drag(from, to) {
  pointer("pointerdown", from, 0.5);
  pointer("pointermove", (from + to) / 2, 0.5);
  pointer("pointermove", to, 0.5);
  pointer("pointerup", to, 0.5);
}

// --- Pictures ----------------------------------------------------------------------------------------------------

/** The pictures decoded last; a large report holds more than should be in memory at once. */
const recent = new Map();
const KEPT = 24;

/** A picture's pixels; nothing if it is missing or broken. */
async function decode(url) {
  if (!url) return undefined;
  const pixels = recent.get(url) ?? (await decodeAnew(url).catch(() => undefined));
  recent.set(url, pixels);
  if (recent.size > KEPT) recent.delete(recent.keys().next().value);
  return pixels;
}

async function decodeAnew(url) {
  const image = new Image();
  image.src = url;
  await image.decode();
  const canvas = Object.assign(document.createElement("canvas"), { width: image.naturalWidth, height: image.naturalHeight });
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.drawImage(image, 0, 0);
  return context.getImageData(0, 0, canvas.width, canvas.height);
}

const onCanvas = () => control("canvas").getContext("2d").getImageData(0, 0, width, height).data;
const isSame = (a, b) => a.length === b.length && a.every((code, i) => code === b[i]);
/** Tells pictures apart. */
const fingerprint = (codes) => codes.reduce((sum, code) => (Math.imul(sum, 31) + code) | 0, 7);
const isOpaque = (codes) => codes.every((code, i) => i % 4 < 3 || code === 255);
const frameOf = (camera, time) => pictures.frames.find((f) => f.camera === camera && f.time === time);
const stateOf = (side) => window.sunbakeViewer.state[side];

/** What the report holds of what a side is meant to see now. */
async function heldFor(side) {
  const { camera, time } = window.sunbakeViewer.state;
  const frame = frameOf(camera, time);
  const choice = stateOf(side);
  return (await decode(choice === "reference" ? frame?.reference : frame?.seen[choice]))?.data;
}

/** Whether a visibility picture shows the left side up to the divider and the right side beyond it. */
async function isDividedAt(split) {
  const [codes, left, right] = [onCanvas(), await heldFor("left"), await heldFor("right")];
  if (!left || !right) return false;
  const isLeft = (i) => Math.floor(i / 4) % width < Math.round(split * width);
  return codes.every((code, i) => code === (isLeft(i) ? left : right)[i]);
}

const messages = () => [...document.querySelectorAll(".viewer-missing, .viewer-failed")].filter((m) => !m.hidden);

/** The canvas shows what a side, which has all of it, is meant to see; or the page says that it cannot. */
async function expectShown(side, when) {
  const held = await heldFor(side);
  if (held) expect(isSame(onCanvas(), held), `${when}: the canvas does not show the picture of ${stateOf(side)}`);
  else expect(isSaidToBeMissing(side), `${when}: the page does not say that the picture of ${stateOf(side)} is missing`);
  const other = messages().find((message) => message.dataset.side === side);
  expect(!held || !other, `${when}: the page says "${other?.textContent}"`);
}

function isSaidToBeMissing(side) {
  const { text } = control(side).selectedOptions[0];
  return messages().some((message) => message.dataset.side === side && message.textContent.includes(text));
}
