"use strict";
// The measurement, how its figures are written, and which run answers which wish.

// What is not finite is null in trade.json: an error that no number holds.
const embedded = id => JSON.parse(document.getElementById(id).textContent, (key, value) => value === null ? Infinity : value);
const trade = embedded("trade"), commands = embedded("commands"), pictures = embedded("embedded");
const reference = trade.reference;
const runs = trade.runs, measured = runs.filter(run => !run.refused);
const runNamed = name => runs.find(run => run.name === name);
const byId = id => document.getElementById(id);

const own = measured.find(run => run.setting.overrides.length === 0);
const cheap = measured.find(run => run.name === "cheap");
const front = measured.filter(run => run.on_front).sort((a, b) => a.seconds.value - b.seconds.value);

/// Text as HTML shows it.
const esc = text => String(text).replace(/[&<>"']/g, c => `&#${c.charCodeAt(0)};`);

/// Three digits of a figure.
function figure(value) {
  if (!isFinite(value)) return "unknown";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e3 && size < 1e6) return String(Math.round(value));
  return size >= 1e-3 && size < 1e3 ? value.toPrecision(3) : value.toExponential(2).replace("e+", "e");
}
const percent = share => isFinite(share) ? `${figure(100 * share)} %` : "unknown";
const similarity = ssim => isFinite(ssim) ? ssim.toFixed(4) : "unknown";
const seconds = value => `${figure(value)} s`;
const bytes = value => value >= 1e9 ? `${figure(value / 1e9)} GB` : `${figure(value / 1e6)} MB`;

/// An error may be less than the reference can tell: then only its upper end is known.
const isTold = error => error.value > 0 && isFinite(error.value);
const errorText = error => isTold(error) || !isFinite(error.value) ? figure(error.value) : `below ${figure(error.high)}`;
const errorRange = error => !isTold(error) ? "" : error.low > 0 ? `${figure(error.low)} to ${figure(error.high)}` : `up to ${figure(error.high)}`;
const errorWithRange = error => errorText(error) + (isTold(error) ? ` (${errorRange(error)})` : "");
const secondsRange = time => `${figure(time.low)} to ${figure(time.high)}`;
/// Of a picture of the scene's own size: the stage render grows with the pixels, and the light does not.
const fullPixels = trade.full_width * trade.full_height, isFull = fullPixels === trade.width * trade.height;
const fullSize = `${trade.full_width} x ${trade.full_height}`;
const fullSeconds = run => run.seconds.value + (run.stages.render || 0) * (fullPixels / (trade.width * trade.height) - 1);
/// What the scene has of the knobs that were measured.
const ownValues = trade.knobs.filter(curve => curve.own && curve.runs.length).map(curve => `${curve.knob} ${curve.own}`);
const settingsText = run => run.setting.overrides.length ? run.setting.overrides.join("  ") : "the scene’s own setting";
/// Seconds with a visibility map that an earlier run has kept; empty where it was not measured.
const warmText = run => run.warm_seconds > 0 ? seconds(run.warm_seconds) : "";

/// The same choice as fastest_within_error and most_accurate_within of host/measure/trade.h; undefined: no run.
const fastestWithinError = error => least(measured.filter(run => run.error.value <= error), fullSeconds);
const mostAccurateWithin = limit => least(measured.filter(run => fullSeconds(run) <= limit), run => run.error.value);
const least = (candidates, by) => [...candidates].sort((a, b) => by(a) - by(b))[0];

/// Methods and stages have colours by their places in these lists; methods have marks, too, for who sees no colours.
const methods = [...new Set(measured.map(run => run.setting.method))].sort();
const stages = stageNames();
const colour = index => `var(--c${index < 0 ? 7 : index % 8})`;
const methodColour = run => colour(methods.indexOf(run.setting.method));

function stageNames() {
  const total = new Map();
  for (const run of front)
    for (const [name, time] of Object.entries(run.stages)) total.set(name, (total.get(name) || 0) + time);
  return [...total.keys()].filter(name => total.get(name) > 0).sort((a, b) => total.get(b) - total.get(a));
}

/// What the page shows now. Words behind # in its address set it, so that a view can be passed on.
const defaults = () => ({
  select: (fastestWithinError(own ? own.error.value : Infinity) || measured[0] || {name: ""}).name,
  against: "reference", view: "side", flip: "", bars: "seconds", sort: "seconds", error: "", seconds: "",
});
let state = defaults();

function readAddress() {
  state = defaults();
  for (const [key, value] of new URLSearchParams(location.hash.slice(1)))
    if (key in state) state[key] = value;
  if (state.flip && !location.hash.includes("view=")) state.view = "flip";
  if (!measured.some(run => run.name === state.select)) state.select = defaults().select;
  if (!measured.some(run => run.name === state.against)) state.against = "reference";
  if (!["side", "flip", "slide", "heat"].includes(state.view)) state.view = "side";
  if (state.bars !== "shares") state.bars = "seconds";
}

function writeAddress() {
  const usual = defaults(), changed = new URLSearchParams();
  for (const key of Object.keys(state))
    if (state[key] !== usual[key]) changed.set(key, state[key]);
  try {
    history.replaceState(null, "", `#${changed}`);
  } catch (refused) { // by browsers that let no local file do so; the page works without
  }
}
