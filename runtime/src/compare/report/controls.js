// The viewer's controls: each is created and wired once, and updated from the state by `showControls`.

const FAMILIES = { baked: "Baked", volumes: "Shadow volumes", map: "Shadow maps", truth: "Ray traced" };
/** How far an arrow key moves the divider, and how far with Shift. */
const KEY_STEPS = [0.01, 0.1];
/** Duration of each time while the day plays. */
const PLAY_STEP_MS = 400;
/** Differences at the ticks of the legend. */
const LEGEND = [0, 0.08, 0.24, 0.48, 1];

// --- Updated from the state -----------------------------------------------------------------------------------------

function showControls() {
  for (const side of SIDES) showSide(side);
  check("modes", state.mode);
  check("cameras", state.camera);
  check("gains", state.gain);
  showTime();
  showLegend();
  showDivider();
  showRows();
  const { left, right, mode } = state;
  element("canvas").setAttribute("aria-label", `${mode}: ${nameOf(left)} on the left, ${nameOf(right)} on the right`);
}

function check(group, value) {
  for (const input of element(group).querySelectorAll("input")) input.checked = input.value === String(value);
}

function showSide(side) {
  element(side).value = state[side];
  const isCommon = state.mode === "difference";
  const name = onSide("name", side);
  name.textContent = isCommon ? `${nameOf(state.left)} against ${nameOf(state.right)}` : nameOf(state[side]);
  name.hidden = isCommon && side === "right";
  showNumbers(side);
}

function showTime() {
  const moment = momentName(report.times[state.time]);
  element("time").value = state.time;
  element("time").setAttribute("aria-valuetext", moment);
  element("clock").textContent = moment;
}

/** The legend: each number is placed at its colour. */
function showLegend() {
  const { mode, gain } = state;
  element("legend").hidden = mode === "picture" || mode === "visibility";
  const ticks = LEGEND.map((step) => {
    const isOpen = gain > 1 && step === 1;
    const tick = made("span", `${isOpen ? "≥\u202f" : ""}${Number((step / gain).toPrecision(2))}`);
    tick.style.left = `${100 * srgbFromLinear(step)}%`;
    return tick;
  });
  element("scale").replaceChildren(...ticks);
  element("scale").style.setProperty("--heat", HEAT_STOPS.map((stop) => `rgb(${stop.join(" ")})`).join());
}

function showDivider() {
  const percent = Math.round(100 * state.split);
  const stage = element("stage");
  stage.dataset.mode = state.mode;
  stage.style.setProperty("--split", `${100 * state.split}%`);
  element("divider").setAttribute("aria-valuenow", percent);
  element("divider").setAttribute("aria-valuetext", `${percent}% ${nameOf(state.left)}`);
}

/** Marks the table rows of the two techniques shown. */
function showRows() {
  for (const row of document.querySelectorAll("tr[data-technique]")) {
    const on = SIDES.filter((side) => String(state[side]) === row.dataset.technique);
    row.dataset.shown = on.join(" ");
  }
}

// --- Numbers -------------------------------------------------------------------------------------------------------

const isNumber = (x) => typeof x === "number" && Number.isFinite(x);
const rounded = (x) => (isNumber(x) ? String(Number(x.toPrecision(3))) : "–");
const percentage = (x) => (isNumber(x) ? `${Number((100 * x).toPrecision(3))}%` : "–");
const milliseconds = (x) => (isNumber(x) ? `${rounded(x)} ms` : "–");

const made = (tag, textContent) => Object.assign(document.createElement(tag), { textContent });

function showNumbers(side) {
  const choice = state[side];
  const frames = report.techniques[choice]?.frames ?? [];
  const { error, frame_ms: frame } = frames.find((f) => f.camera === state.camera && f.time === state.time) ?? {};
  const numbers = [rounded(error?.mean), rounded(error?.p99), percentage(error?.wrong_share), milliseconds(frame)];
  const heading = made("th", side === "left" ? "Left" : "Right");
  heading.scope = "row";
  heading.append(made("span", `: ${nameOf(choice).replaceAll(":", ":\u200b")}`));
  const cells = [heading, ...numbers.map((text) => made("td", text))];
  element("root").querySelector(`tr[data-side=${side}]`).replaceChildren(...cells);
}

// --- Created once --------------------------------------------------------------------------------------------------

function fillSelect(select) {
  const reference = document.createElement("optgroup");
  reference.label = "Reference";
  reference.append(new Option(report.reference.name, REFERENCE));
  const groups = new Map([["", reference]]);
  report.techniques.forEach(({ name, family }, i) => {
    const group = groups.get(family) ?? document.createElement("optgroup");
    group.label = FAMILIES[family] ?? family;
    group.append(new Option(name, i));
    groups.set(family, group);
  });
  select.append(...groups.values());
}

function fillCameras() {
  report.cameras.forEach((_, i) => {
    const label = document.createElement("label");
    const input = Object.assign(document.createElement("input"), { type: "radio", name: "viewer-camera", value: i });
    label.append(input, cameraName(i));
    element("cameras").append(label);
  });
  element("cameras").hidden = report.cameras.length < 2;
}

function wireChoices() {
  for (const side of SIDES) {
    fillSelect(element(side));
    element(side).addEventListener("change", ({ target }) => {
      change({ [side]: target.value === REFERENCE ? REFERENCE : Number(target.value) });
    });
  }
  fillCameras();
  element("cameras").addEventListener("change", ({ target }) => change({ camera: Number(target.value) }));
  element("modes").addEventListener("change", ({ target }) => change({ mode: target.value }));
  element("gains").addEventListener("change", ({ target }) => change({ gain: Number(target.value) }));
  element("swap").addEventListener("click", swap);
}

const swap = () => change({ left: state.right, right: state.left });

// --- Time ----------------------------------------------------------------------------------------------------------

function wireTime() {
  element("time").max = report.times.length - 1;
  element("time").addEventListener("input", ({ target }) => change({ time: Number(target.value) }));
  element("play").addEventListener("click", play);
  element("time").disabled = element("play").hidden = report.times.length < 2;
}

const moveTime = (by) => change({ time: clamp(state.time + by, 0, report.times.length - 1) });

let playing;

function play() {
  const isStopped = playing === undefined;
  clearInterval(playing);
  const step = () => change({ time: (state.time + 1) % report.times.length });
  playing = isStopped ? setInterval(step, PLAY_STEP_MS) : undefined;
  element("play").setAttribute("aria-pressed", isStopped);
  element("play").textContent = isStopped ? "Stop" : "Play";
}

// --- The picture ---------------------------------------------------------------------------------------------------

/** The position of the pointer on the picture, as shares of its width and height. */
function shares({ clientX, clientY }) {
  const box = element("canvas").getBoundingClientRect();
  return [(clientX - box.left) / box.width, (clientY - box.top) / box.height].map((share) => clamp(share, 0, 1));
}

function read(event) {
  const [x, y] = shares(event);
  pointAt([Math.min(Math.floor(x * width), width - 1), Math.min(Math.floor(y * height), height - 1)]);
}

function drag(event) {
  read(event);
  if (state.mode !== "difference") moveDivider(shares(event)[0]);
}

function wireStage() {
  const stage = element("stage");
  stage.addEventListener("pointermove", read);
  stage.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    event.preventDefault();
    element("divider").focus({ preventScroll: true });
    drag(event);
    const ends = new AbortController();
    addEventListener("pointermove", drag, ends);
    for (const end of ["pointerup", "pointercancel"]) addEventListener(end, () => ends.abort(), ends);
  });
  element("divider").addEventListener("keydown", moveByKey);
  const fit = () => stage.classList.toggle("viewer-enlarged", stage.clientWidth * devicePixelRatio > width);
  new ResizeObserver(fit).observe(stage);
}

function moveByKey(event) {
  const step = KEY_STEPS[Number(event.shiftKey)];
  const { split } = state;
  const [less, more] = [split - step, split + step];
  const places = { ArrowLeft: less, ArrowDown: less, ArrowRight: more, ArrowUp: more, Home: 0, End: 1 };
  if (!(event.key in places) || hasModifier(event)) return;
  event.preventDefault();
  moveDivider(places[event.key]);
}

const hasModifier = ({ ctrlKey, altKey, metaKey }) => ctrlKey || altKey || metaKey;

// --- Keys and rows -------------------------------------------------------------------------------------------------

const KEYS = {
  ",": () => moveTime(-1),
  ".": () => moveTime(1),
  1: () => change({ mode: MODES[0] }),
  2: () => change({ mode: MODES[1] }),
  3: () => change({ mode: MODES[2] }),
  4: () => change({ mode: MODES[3] }),
  s: swap,
  c: () => change({ camera: (state.camera + 1) % report.cameras.length }),
  p: play,
};

function wireKeys() {
  element("root").addEventListener("keydown", (event) => {
    const act = KEYS[event.key.toLowerCase()];
    if (act && !hasModifier(event) && event.target.tagName !== "SELECT") act();
  });
}

/** A click on a row or a mark of a technique shows it on a side. */
function wireRows() {
  document.addEventListener("click", choose);
  for (const row of document.querySelectorAll("tr[data-technique]")) {
    row.tabIndex = 0;
    row.title = "Show on the left; with Shift, on the right";
    row.addEventListener("keydown", (event) => event.key === "Enter" && choose(event));
  }
}

function choose(event) {
  const choice = Number(event.target.closest("[data-technique]")?.dataset.technique ?? Number.NaN);
  const isOther = event.target.closest("a, button, input, label, select");
  if (isOther || !isChoice(choice)) return;
  getSelection()?.removeAllRanges();
  change({ [event.shiftKey ? "right" : "left"]: choice });
  const behavior = matchMedia("(prefers-reduced-motion: reduce)").matches ? "auto" : "smooth";
  element("stage").scrollIntoView({ block: "nearest", behavior });
}

// --- Start ---------------------------------------------------------------------------------------------------------

/** Rejects reports that cannot be shown, with one message at the start. */
function refuseWhatCannotBeShown() {
  const lacks = [report.cameras, report.times, pictures.frames].some((list) => !list?.length);
  if (lacks) throw new Error("it has no cameras, no times or no pictures");
  if (!(width > 0 && height > 0)) throw new Error("its pictures have no size");
  if (!pictures.frames.every((frame) => isNumber(frame.scale))) throw new Error("a frame has no scale");
}

function makeCanvases() {
  Object.assign(element("canvas"), { width, height });
  element("stage").style.setProperty("--ratio", `${width} / ${height}`);
  const canvas = Object.assign(document.createElement("canvas"), { width, height });
  scratch = canvas.getContext("2d", { willReadFrequently: true });
  scratch.globalCompositeOperation = "copy";
}

function start() {
  report = stored("report");
  pictures = stored("pictures");
  [width, height] = pictures.size ?? [];
  refuseWhatCannotBeShown();
  makeCanvases();
  element("reference").textContent = report.reference.name;
  element("frame-heading").textContent = report.machine?.is_software ? "Frame (software)" : "Frame";
  for (const wire of [wireChoices, wireTime, wireStage, wireKeys, wireRows]) wire();
  state = { ...firstState(), ...stateIn(location.hash) };
  showControls();
  latest = show(++newest);
  addEventListener("hashchange", () => change(stateIn(location.hash)));
  window.sunbakeViewer = { settled, get state() { return { ...state }; } };
}

element("root").hidden = false;
try {
  start();
} catch (error) {
  element("root").dataset.failed = "";
  element("failed").hidden = false;
  element("failed").textContent = `The pictures of this report cannot be shown: ${error.message}.`;
  console.error(error);
}
