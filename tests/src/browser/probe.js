// Stands at the end of a report under test: works every control, and compares what the canvas shows with what the report
// holds. What it finds is left as JSON in `<pre id="verdict">`.

// --- Checks ------------------------------------------------------------------------------------------------------

function refersToNothingOutside() {
  const names = ["src", "href", "xlink:href", "srcset", "data", "poster", "action", "style"];
  const outside = /(^|[\s,(])["']?(https?:|ftp:|file:)?\/\//i;
  for (const element of document.querySelectorAll("*")) {
    const found = names.find((name) => outside.test(element.getAttribute(name)?.replace(/^data:.*/s, "") ?? ""));
    expect(!found, `<${element.localName}> refers to the network: ${element.getAttribute(found)}`);
  }
  const styles = [...document.querySelectorAll("style")].map((style) => style.textContent).join("\n");
  expect(!/@import|url\(\s*["']?(?!data:|#)/i.test(styles), "a style refers to another file");
  const fetched = performance.getEntriesByType("resource").filter((entry) => !entry.name.startsWith("data:"));
  expect(fetched.length === 0, `the page fetched ${fetched[0]?.name}`);
}

async function holdsEveryPicture() {
  for (const [camera, time] of moments()) {
    const frame = frameOf(camera, time);
    expect(frame, `there is no frame of camera ${camera} at time ${time}`);
    if (!frame) continue;
    for (const key of ["dark", "open", "reference"]) await holds(frame[key], `${key} of camera ${camera} at time ${time}`);
    for (const [i, { name, frames }] of report.techniques.entries()) {
      const isMeasured = frames.some((f) => f.camera === camera && f.time === time);
      if (isMeasured) await holds(frame.seen[i], `${name} of camera ${camera} at time ${time}`);
    }
  }
}

async function holds(url, what) {
  const image = await decode(url);
  expect(image, `the picture ${what} is missing or broken`);
  if (!image) return;
  counts.pictures += 1;
  expect(image.width === width && image.height === height, `the picture ${what} is ${image.width} by ${image.height}`);
}

const moments = () => report.cameras.flatMap((_, camera) => report.times.map((_, time) => [camera, time]));

async function everyOptionDraws() {
  await pick("modes", "visibility");
  for (const [side, key] of [["right", "Home"], ["left", "End"]]) {
    await press(control("divider"), key);
    const options = [...control(side).options];
    expect(options.length === report.techniques.length + 1, `${side} offers ${options.length} choices`);
    for (const { value, text } of options) {
      await enter(control(side), value);
      await expectShown(side, `${text} chosen on the ${side}`);
      counts.options += 1;
    }
  }
}

async function everyMomentDraws() {
  const seen = new Set();
  for (const [camera, time] of moments()) {
    await pick("cameras", camera);
    await enter(control("time"), time);
    const { clock } = report.times[time];
    expect(!clock || control("clock").textContent.includes(clock), `the clock does not say ${clock}`);
    for (const { value, text } of [...control("left").options].reverse()) {
      await enter(control("left"), value);
      await expectShown("left", `${text} by camera ${camera} at time ${time}`);
    }
    seen.add(fingerprint(onCanvas()));
    counts.moments += 1;
  }
  expect(seen.size > 1 || moments().length === 1, "the picture is the same at every moment");
}

async function quickMovesEndOnTheLatest() {
  for (const time of [...report.times.keys(), 0, report.times.length - 1]) enter(control("time"), time);
  await settled();
  await pause(300);
  expect(stateOf("time") === report.times.length - 1, "quick moves of the time end elsewhere");
  await expectShown("left", "after quick moves of the time");
}

async function dividerDivides() {
  await enter(control("left"), 0);
  await enter(control("right"), "reference");
  for (const [from, to] of [[0.5, 0.25], [0.25, 0.75]]) {
    drag(from, to);
    await settled();
    expect(Math.abs(stateOf("split") - to) < 0.02, `the divider was dragged to ${to} and is at ${stateOf("split")}`);
    expect(await isDividedAt(stateOf("split")), `the picture is not divided at ${to}`);
  }
  pointer("pointermove", 0.1, 0.5);
  expect(stateOf("split") > 0.5, "the divider follows a pointer that was let go");
  await dividerObeysKeys();
}

async function dividerObeysKeys() {
  const divider = control("divider");
  const moves = [["Home", 0], ["ArrowRight", 0.1, { shiftKey: true }], ["ArrowRight", 0.11], ["ArrowLeft", 0.1], ["End", 1]];
  for (const [key, split, more] of moves) {
    await press(divider, key, more);
    expect(Math.abs(stateOf("split") - split) < 1e-6, `after ${key} the divider is at ${stateOf("split")}`);
    expect(divider.getAttribute("aria-valuenow") === String(Math.round(100 * split)), `the divider does not say ${split}`);
    expect(await isDividedAt(split), `after ${key} the picture is not divided at ${split}`);
  }
}

async function sidesSwap() {
  const before = [stateOf("left"), stateOf("right")];
  control("swap").click();
  await settled();
  expect(stateOf("left") === before[1] && stateOf("right") === before[0], "the sides do not swap");
  await expectShown("left", "after a swap");
  await press(control("divider"), "s");
  expect(stateOf("left") === before[0], "the key S does not swap the sides");
}

async function everyModeDraws() {
  await press(control("divider"), "Home");
  await press(control("divider"), "End");
  const seen = new Set();
  for (const mode of ["picture", "visibility", "difference", "error"]) {
    await pick("modes", mode);
    expect(messages().length === 0, `${mode}: the page says "${messages()[0]?.textContent}"`);
    expect(isOpaque(onCanvas()), `${mode}: the canvas has holes`);
    const isHeat = mode === "difference" || mode === "error";
    expect(control("legend").hidden !== isHeat, `${mode}: the legend is ${isHeat ? "missing" : "there"}`);
    if (isHeat) await expectHeat(mode);
    seen.add(fingerprint(onCanvas()));
  }
  expect(seen.size >= 3, "modes look alike");
}

/** Against the reference, both heat maps show the same: the coldest colour just where nothing differs. */
async function expectHeat(mode) {
  const [codes, left, right] = [onCanvas(), await heldFor("left"), await heldFor("right")];
  const isCold = (i) => codes[i] === 16 && codes[i + 1] === 14 && codes[i + 2] === 22;
  const wrong = codes.findIndex((_, i) => i % 4 === 0 && isCold(i) !== (left[i] === right[i]));
  expect(wrong < 0, `${mode}: the colour of pixel ${wrong / 4} does not tell whether the sides differ`);
}

async function pixelsCanBeRead() {
  await pick("modes", "visibility");
  for (const [column, row] of [[0, 0], [width - 1, height - 1], [width >> 1, (2 * height) / 3 | 0]]) {
    pointer("pointermove", (column + 0.5) / width, (row + 0.5) / height);
    const at = 4 * (row * width + column);
    const [a, b] = [await heldFor("left"), await heldFor("right")].map((codes) => codes[at] / 255);
    for (const [of, value] of Object.entries({ left: a, right: b, difference: Math.abs(a - b) })) {
      const said = document.querySelector(`#viewer-readout output[data-of=${of}]`).textContent;
      expect(said === value.toFixed(3), `at ${column}, ${row} the readout of ${of} says ${said}, not ${value.toFixed(3)}`);
    }
  }
}

async function tableSortsAndChooses() {
  const table = document.querySelector("tr[data-technique]")?.closest("table");
  expect(table, "there is no table of techniques");
  if (!table) return;
  for (const [column, heading] of [...table.tHead.rows[0].cells].entries()) {
    for (const turn of ["first", "second"]) sortBy(table, column, heading, turn);
    counts.columns += 1;
  }
  for (const row of rowsOf(table)) {
    await choosesByClick(row.cells[0], row.dataset.technique, "row");
    counts.rows += 1;
  }
  const marks = document.querySelectorAll("svg [data-technique]");
  for (const mark of marks) await choosesByClick(mark, mark.dataset.technique, "mark");
}

async function choosesByClick(element, technique, kind) {
  await enter(control("left"), "reference");
  element.dispatchEvent(new MouseEvent("click", { bubbles: true }));
  await settled();
  expect(control("left").value === technique, `a click on the ${kind} of ${technique} does not choose it`);
  await expectShown("left", `the ${kind} of ${technique} clicked`);
}

const rowsOf = (table) => [...table.querySelectorAll("tr[data-technique]")];

/** A cell's key: `data-value` where it has one, or its text. */
function key(row, column) {
  const cell = row.cells[column];
  const text = cell.dataset.value ?? cell.textContent.trim();
  return text !== "" && Number.isFinite(Number(text)) ? Number(text) : text;
}

function sortBy(table, column, heading, turn) {
  const before = rowsOf(table);
  (heading.querySelector("button") ?? heading).click();
  const after = rowsOf(table);
  expect(new Set([...before, ...after]).size === before.length, "sorting loses rows");
  const keys = after.map((row) => key(row, column));
  const sign = { ascending: 1, descending: -1 }[heading.ariaSort];
  expect(sign, `${turn} click: heading ${heading.textContent.trim()} does not say how it sorts`);
  const numbers = keys.filter((k) => typeof k === "number");
  const compared = numbers.length ? numbers : keys;
  const isSorted = compared.every((k, i) => i === 0 || sign * order(compared[i - 1], k) <= 0);
  expect(isSorted, `${turn} click: column ${heading.textContent.trim()} is not ${heading.ariaSort}: ${keys.join(", ")}`);
}

const order = (a, b) => (typeof a === "number" ? a - b : a.localeCompare(b, "en", { numeric: true }));

async function addressFollowsAndLeads() {
  const last = report.times.length - 1;
  await enter(control("time"), last);
  await pick("modes", "error");
  await pause(400);
  const said = new URLSearchParams(location.hash.slice(1));
  expect(said.get("time") === String(last) && said.get("mode") === "error", `the address says ${location.hash}`);
  location.hash = "#time=0&mode=visibility&left=reference&right=no-such-technique";
  await pause(100);
  await settled();
  expect(stateOf("time") === 0 && stateOf("left") === "reference", "the page does not follow its address");
  await expectShown("left", "after the address changed");
}

async function dayPasses() {
  if (report.times.length < 2) return;
  const before = stateOf("time");
  control("play").click();
  await pause(600);
  control("play").click();
  await settled();
  const after = stateOf("time");
  expect(after !== before, "the day does not pass");
  await pause(600);
  expect(stateOf("time") === after, "the day does not stop");
}

/** Where a page says what its canvas must show (`#expected`): within one code of it. */
async function matchesItsTwins() {
  await press(control("divider"), "End");
  for (const { camera, time, left, right, mode, codes } of byId("expected") ? json("expected") : []) {
    await pick("cameras", camera);
    await enter(control("time"), time);
    await enter(control("left"), left);
    await enter(control("right"), right);
    await pick("modes", mode);
    await pick("modes", mode);
    const found = onCanvas();
    const off = codes.map((code, i) => Math.max(...code.map((c, k) => Math.abs(c - found[4 * i + k]))));
    const worst = Math.max(...off);
    expect(worst <= 1, `${mode} of ${left} at time ${time} is ${worst} codes off at pixel ${off.indexOf(worst)}`);
    counts.twins += 1;
  }
}

function fitsTheWindow() {
  const { scrollWidth, clientWidth } = document.documentElement;
  expect(scrollWidth <= clientWidth, `the page is ${scrollWidth} wide in a window of ${clientWidth}`);
  const plots = document.querySelectorAll("svg");
  counts.plots = plots.length;
  for (const plot of plots) expect(plot.getBoundingClientRect().width > 0, "a plot has no size");
}

// --- The run -----------------------------------------------------------------------------------------------------

async function run() {
  report = json("report");
  pictures = json("pictures");
  [width, height] = pictures.size;
  expect(window.sunbakeViewer, "the page has no viewer");
  const checks = [refersToNothingOutside, fitsTheWindow, holdsEveryPicture];
  const workings = [everyOptionDraws, everyMomentDraws, quickMovesEndOnTheLatest, dividerDivides, sidesSwap, everyModeDraws,
    pixelsCanBeRead, tableSortsAndChooses, addressFollowsAndLeads, dayPasses, matchesItsTwins];
  for (const check of window.sunbakeViewer ? [...checks, ...workings] : checks) {
    try {
      await check();
    } catch (error) {
      problems.push(`${check.name}: ${error}`);
    }
  }
}

function leaveVerdict() {
  const verdict = document.createElement("pre");
  verdict.id = "verdict";
  verdict.textContent = JSON.stringify({ ...counts, problems });
  document.body.replaceChildren(verdict);
  release();
}

// The page's own module runs once the page is parsed; this event follows it.
addEventListener("DOMContentLoaded", () => run().catch((error) => problems.push(String(error))).finally(leaveVerdict));
