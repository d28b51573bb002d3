"use strict";
// Axes and marks of charts, as SVG text. Written out because the page has to work without a network, and the chart
// libraries that systems package would each put more text into it than all of this.

/// value -> place on a logarithmic axis; what lies beyond an end, or below zero, stands at the end
function logScale(low, high, from, to) {
  const a = Math.log(low), b = Math.log(high);
  const share = value => value > 0 ? Math.min(1, Math.max(0, (Math.log(value) - a) / (b - a))) : 0;
  return value => from + share(value) * (to - from);
}

/// At most `most` round values between low and high, at least two where there is room for them.
function logTicks(low, high, most) {
  let chosen = [];
  for (const digits of [[1], [1, 3], [1, 2, 5], [1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9]]) {
    const ticks = decades(low, high, digits);
    if (chosen.length === 0 || ticks.length <= most) chosen = ticks;
  }
  if (chosen.length < 2) chosen = evenTicks(low, high, most);
  const step = Math.ceil(chosen.length / most);
  return chosen.filter((_, i) => i % step === 0);
}

function decades(low, high, digits) {
  const ticks = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.log10(high); ++power)
    for (const digit of digits) ticks.push(Number(`${digit}e${power}`));
  return ticks.filter(tick => tick >= low && tick <= high);
}

function evenTicks(low, high, most) {
  const rough = (high - low) / Math.max(1, most - 1), power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find(digit => digit * power >= rough);
  const ticks = [];
  for (let tick = Math.ceil(low / step) * step; tick <= high; tick += step) ticks.push(Number(tick.toPrecision(6)));
  return ticks;
}

const tickText = value => value >= 1e-3 && value < 1e5 ? String(value) : value.toExponential().replace("e+", "e");

/// Ends of an axis that holds all values with some room.
function logDomain(values, room) {
  const positive = values.filter(value => value > 0 && isFinite(value));
  if (positive.length === 0) return [0.1, 1];
  return [Math.min(...positive) / room, Math.max(...positive) * room];
}

/// Ends of an axis of errors. What lies below them, or below zero, is drawn at the lower end with an arrow.
function errorDomain(shown, room) {
  const values = shown.flatMap(run => [run.error.high, isTold(run.error) && run.error.low > 0 ? run.error.value : 0,
    Math.max(run.error.low, run.error.value / 10)]);
  if (shown.some(run => run.error.low <= 0)) values.push(reference.own_noise);
  return logDomain(values, room);
}

const line = (x1, y1, x2, y2, kind) => `<line x1="${r(x1)}" y1="${r(y1)}" x2="${r(x2)}" y2="${r(y2)}" class="${kind}"/>`;
const text = (x, y, words, kind, anchor) =>
  `<text x="${r(x)}" y="${r(y)}" class="${kind}" text-anchor="${anchor || "start"}">${esc(words)}</text>`;
const r = value => Math.round(value * 10) / 10;

/// The mark of a method, `size` its half width.
function mark(index, x, y, size) {
  const points = list => `<polygon class="mark" points="${list.map(([u, v]) => `${r(x + u * size)},${r(y + v * size)}`).join(" ")}"/>`;
  switch (index % 7) {
    case 0: return `<circle class="mark" cx="${r(x)}" cy="${r(y)}" r="${r(size)}"/>`;
    case 1: return points([[-.9, -.9], [.9, -.9], [.9, .9], [-.9, .9]]);
    case 2: return points([[0, -1.15], [1.1, .85], [-1.1, .85]]);
    case 3: return points([[0, -1.25], [1.25, 0], [0, 1.25], [-1.25, 0]]);
    case 4: return points([[0, 1.15], [1.1, -.85], [-1.1, -.85]]);
    case 5: return points([[-.35, -1.1], [.35, -1.1], [.35, -.35], [1.1, -.35], [1.1, .35], [.35, .35], [.35, 1.1],
      [-.35, 1.1], [-.35, .35], [-1.1, .35], [-1.1, -.35], [-.35, -.35]]);
    default: return points([0, 1, 2, 3, 4].map(k => [1.2 * Math.sin(k * 1.2566), -1.2 * Math.cos(k * 1.2566)]));
  }
}

/// The bar of an estimate along y, with an arrow down where its low end is below what the axis shows.
function errorBar(x, y, domain, error) {
  const high = y(error.high), low = y(error.low);
  const foot = error.low < domain[0] ? `M${r(x - 4)} ${r(low - 7)}L${r(x)} ${r(low)}L${r(x + 4)} ${r(low - 7)}` : `M${r(x - 3)} ${r(low)}h6`;
  return `<path class="bar" d="M${r(x - 3)} ${r(high)}h6M${r(x)} ${r(high)}V${r(low)}${foot}"/>`;
}

/// One run: its bars, its mark, and what a screen reader says. `bars`: SVG text.
function runMark(run, x, y, size, bars, kind) {
  const words = `${run.name}: ${seconds(run.seconds.value)}, error ${errorText(run.error)}, ${settingsText(run)}`;
  return `<g class="run ${kind}" data-run="${esc(run.name)}" style="--c:${methodColour(run)}" ` +
    `role="button" tabindex="-1" aria-label="${esc(words)}">${bars}` +
    `<circle class="halo" cx="${r(x)}" cy="${r(y)}" r="${size + 5}"/>` +
    `<circle cx="${r(x)}" cy="${r(y)}" r="${size + 6}" fill="transparent"/>` +
    `${mark(methods.indexOf(run.setting.method), x, y, size)}</g>`;
}

/// A legend of names with their colours; `drawn` makes the sign of a row.
const legend = (names, drawn) => names.map((name, i) => `<span style="--c:${colour(i)}">${drawn(i)} ${esc(name)}</span>`).join("");
const markSign = i => `<svg viewBox="0 0 16 16" aria-hidden="true"><g class="run">${mark(i, 8, 8, 5)}</g></svg>`;
