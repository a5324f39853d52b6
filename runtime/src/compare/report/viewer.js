// The viewer: two techniques side by side, at any camera and time of the report.
//
// `pixels.js`, this file and `controls.js` are joined into one module, so that the only global is
// `window.sunbakeViewer`, which is for tests. `state` holds the current choices. Every control changes it through
// `change`, and `show` redraws the picture. Images are decoded when they are first needed. `show` waits for them, so a
// later change may overtake it: only the latest call draws. Moving the divider and reading a pixel need no new picture.

const REFERENCE = "reference";
const SIDES = ["left", "right"];
const MODES = ["picture", "visibility", "difference", "error"];
const GAINS = [1, 4, 16];
/** Bytes of decoded images kept. */
const CACHE_BYTES = 96e6;
/** Pixels shown to each side of the one that is read. */
const REACH_PX = 6;
/** Delay before the address is updated: browsers reject frequent updates. */
const ADDRESS_DELAY_MS = 250;

const element = (id) => document.getElementById(`viewer-${id}`);
const onSide = (kind, side) => element("stage").querySelector(`.viewer-${kind}[data-side=${side}]`);
const stored = (id) => JSON.parse(document.getElementById(id).textContent);
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

let report, pictures, width, height, state;
/** What the canvas shows: colour codes, visibility and error message of each side. */
let shown = { codes: {}, seen: {}, problem: {} };

// --- Names ---------------------------------------------------------------------------------------------------------

const nameOf = (choice) => (choice === REFERENCE ? report.reference.name : report.techniques[choice].name);
const choiceOf = (name) => (name === REFERENCE ? REFERENCE : report.techniques.findIndex((t) => t.name === name));
const isChoice = (choice) => choice === REFERENCE || choice in report.techniques;
const cameraName = (i) => report.cameras[i].name ?? `camera ${i + 1}`;

function momentName({ t, clock, elevation_deg: elevation }) {
  const when = clock ?? `t ${Number(t).toFixed(3)}`;
  return elevation == null ? when : `${when}, sun at ${Number(elevation).toFixed(1)}°`;
}

// --- State and address ---------------------------------------------------------------------------------------------

function firstState() {
  const baked = report.techniques.findIndex((t) => t.family === "baked");
  const left = report.techniques.length ? Math.max(baked, 0) : REFERENCE;
  const time = Math.floor((report.times.length - 1) / 2);
  return { camera: 0, time, left, right: REFERENCE, mode: "picture", gain: 1, split: 0.5, spot: null };
}

function address() {
  const { camera, time, left, right, mode, gain, split } = state;
  const side = (choice) => (choice === REFERENCE ? REFERENCE : nameOf(choice));
  const params = { camera, time, left: side(left), right: side(right), mode, gain, split: split.toFixed(3) };
  return `#${new URLSearchParams(params)}`;
}

/** The part of the state that an address contains; choices that this report does not have are left out. */
function stateIn(hash) {
  const params = new URLSearchParams(hash.slice(1));
  const number = (key) => Number.parseFloat(params.get(key) ?? "");
  const found = {};
  if (number("camera") in report.cameras) found.camera = number("camera");
  if (number("time") in report.times) found.time = number("time");
  for (const side of SIDES) {
    const choice = choiceOf(params.get(side));
    if (isChoice(choice)) found[side] = choice;
  }
  if (MODES.includes(params.get("mode"))) found.mode = params.get("mode");
  if (GAINS.includes(number("gain"))) found.gain = number("gain");
  if (number("split") >= 0 && number("split") <= 1) found.split = number("split");
  return found;
}

let addressTimer;
function followInAddress() {
  clearTimeout(addressTimer);
  addressTimer = setTimeout(() => history.replaceState(null, "", address()), ADDRESS_DELAY_MS);
}

// --- Images --------------------------------------------------------------------------------------------------------

const cache = new Map();
let scratch;

/** The RGBA bytes of an image of the stated size. */
async function decoded(url) {
  const image = new Image();
  image.src = url;
  await image.decode();
  const size = [image.naturalWidth, image.naturalHeight];
  if (size[0] !== width || size[1] !== height) throw new Error(`it has ${size.join(" × ")} pixels`);
  scratch.drawImage(image, 0, 0);
  return scratch.getImageData(0, 0, width, height).data;
}

/** As `decoded`, cached. The least recently used image is dropped first. */
function cached(url) {
  const image = cache.get(url) ?? decoded(url);
  cache.delete(url);
  cache.set(url, image);
  if (cache.size > Math.max(8, CACHE_BYTES / (width * height * 4))) cache.delete(cache.keys().next().value);
  return image;
}

/** An image, or an error message. */
async function fetched(url, what) {
  const where = `from ${cameraName(state.camera)} at ${momentName(report.times[state.time])}`;
  if (!url) return { problem: `There is no picture of ${what} ${where}.` };
  try {
    return { pixels: await cached(url) };
  } catch (error) {
    return { problem: `The picture of ${what} ${where} cannot be shown: ${error.message}` };
  }
}

const frameOf = ({ camera, time }) => pictures.frames.find((f) => f.camera === camera && f.time === time) ?? {};

function seenBy(choice, frame) {
  const url = choice === REFERENCE ? frame.reference : frame.seen?.[choice];
  return fetched(url, choice === REFERENCE ? `the reference, ${nameOf(choice)},` : nameOf(choice));
}

// --- Showing -------------------------------------------------------------------------------------------------------

let latest = Promise.resolve();
let newest = 0;

/** Resolves when the canvas shows the current state. */
async function settled() {
  let seen;
  do await (seen = latest);
  while (seen !== latest);
}

function change(what) {
  state = { ...state, ...what };
  showControls();
  followInAddress();
  latest = show(++newest);
}

function moveDivider(split) {
  state.split = clamp(split, 0, 1);
  showDivider();
  followInAddress();
  paint();
}

function pointAt(spot) {
  state.spot = spot;
  showSpot();
}

async function show(ticket) {
  element("stage").setAttribute("aria-busy", "true");
  const asked = state;
  const made = await sides(asked, frameOf(asked));
  if (ticket !== newest) return;
  shown = made;
  for (const side of SIDES) showProblem(side);
  paint();
  showSpot();
  element("stage").setAttribute("aria-busy", "false");
}

/** Colour codes of both sides, and their visibility. */
async function sides(asked, frame) {
  const { mode, gain } = asked;
  const of = (key, what) => fetched(frame[key], what);
  const seen = await Promise.all(SIDES.map((side) => seenBy(asked[side], frame)));
  const lights = mode === "picture" ? [of("dark", "the scene in shade"), of("open", "the scene in the sun")] : [];
  const against = mode === "error" ? [seenBy(REFERENCE, frame)] : [];
  const common = await Promise.all([...lights, ...against]);
  const result = { codes: {}, seen: {}, problem: {} };
  SIDES.forEach((side, i) => {
    const needed = [...(mode === "difference" ? seen : [seen[i]]), ...common];
    result.seen[side] = seen[i].pixels;
    result.problem[side] = needed.find((image) => image.problem)?.problem;
    if (!result.problem[side]) result.codes[side] = composed(mode, gain, frame.scale, needed.map((image) => image.pixels));
  });
  return result;
}

function composed(mode, gain, scale, [seen, ...others]) {
  if (mode === "picture") return litPicture({ dark: others[0], open: others[1], scale }, seen);
  if (mode === "visibility") return seen;
  return heatPicture(seen, others[0], gain);
}

/** A difference is one picture, which the divider does not split. */
const dividedAt = () => Math.round(width * (state.mode === "difference" ? 1 : state.split));

function paint() {
  const context = element("canvas").getContext("2d");
  const x = dividedAt();
  const put = (codes, from, to) => {
    if (codes && to > from) context.putImageData(new ImageData(codes, width), 0, 0, from, 0, to - from, height);
  };
  context.clearRect(0, 0, width, height);
  put(shown.codes.left, 0, x);
  put(shown.codes.right, x, width);
}

function showProblem(side) {
  const problem = shown.problem[side];
  const message = onSide("missing", side);
  message.textContent = problem ?? "";
  message.hidden = !problem || (state.mode === "difference" && side === "right");
}

/** The pixel that is read: the visibility on both sides, and the pixels around it. */
function showSpot() {
  const { spot } = state;
  element("spot").hidden = !spot;
  if (!spot) return;
  const [left, right] = SIDES.map((side) => shown.seen[side] && around(shown.seen[side], [width, height], spot, REACH_PX));
  showTile("left", left, left && middle(left));
  showTile("right", right, right && middle(right));
  const both = left && right;
  showTile("difference", both && heatPicture(left, right, state.gain), both && Math.abs(middle(left) - middle(right)));
  element("place").textContent = `Visibility at column ${spot[0]}, row ${spot[1]}. The pixel stays selected when the time changes.`;
  element("spot").style.left = `${(100 * (spot[0] + 0.5)) / width}%`;
  element("spot").style.top = `${(100 * (spot[1] + 0.5)) / height}%`;
}

/** Visibility at the middle pixel of a square. */
const middle = (square) => square[4 * ((square.length / 4 - 1) / 2)] / 255;

function showTile(of, square, seen) {
  const canvas = element("readout").querySelector(`canvas[data-of=${of}]`);
  canvas.width = canvas.height = 2 * REACH_PX + 1;
  if (square) canvas.getContext("2d").putImageData(new ImageData(square, canvas.width), 0, 0);
  element("readout").querySelector(`output[data-of=${of}]`).textContent = seen?.toFixed(3) ?? "–";
}
