"use strict";
// Error against seconds of all runs, and the runs that no other beats.

function drawFront() {
  const box = byId("front"), width = Math.max(280, box.clientWidth), height = width < 560 ? 360 : 470;
  const left = 52, right = width - 12, top = 26, bottom = height - 44;
  const times = logDomain(measured.flatMap(run => [run.seconds.low, run.seconds.value, run.seconds.high]), 1.25);
  const errors = errorDomain(measured, 1.5);
  const x = logScale(times[0], times[1], left, right), y = logScale(errors[0], errors[1], bottom, top);
  const place = run => [x(run.seconds.value), y(run.error.value)];

  let out = "";
  for (const tick of logTicks(times[0], times[1], width / 60))
    out += line(x(tick), top, x(tick), bottom, "grid") + text(x(tick), bottom + 16, tickText(tick), "tick", "middle");
  for (const tick of logTicks(errors[0], errors[1], 9))
    out += line(left, y(tick), right, y(tick), "grid") + text(left - 6, y(tick) + 4, tickText(tick), "tick", "end");
  out += line(left, bottom, right, bottom, "axis") + line(left, top, left, bottom, "axis");
  out += text((left + right) / 2, height - 6, `seconds of a picture of ${trade.width} x ${trade.height} pixels`, "tick", "middle");
  out += text(4, 14, "error (relMSE)", "tick");

  const named = front.map((run, i) => ({at: place(run), words: width < 560 ? [`${i + 1}`] : [`${i + 1} ${run.name}`, `${i + 1}`]}));
  if (own && !own.on_front) named.push({at: place(own), words: ["the scene’s own"], led: true});
  if (reference.own_noise > errors[0] && reference.own_noise < errors[1]) {
    const level = y(reference.own_noise), far = right - left - 6;
    out += line(left, level, right, level, "floor");
    named.unshift({at: [left, level], words: [`noise of the reference, ${figure(reference.own_noise)}`, "noise of the reference"],
      places: [[6, -5, "start"], [6, 14, "start"], [far, -5, "end"], [far, 14, "end"]]});
  }
  out += `<path class="steps" d="${steps(front.map(place), top, right)}"/>`;

  const bar = (run, [px, py]) => errorBar(px, y, errors, run.error) +
    `<path class="bar" d="M${r(x(run.seconds.low))} ${r(py - 3)}v6M${r(x(run.seconds.low))} ${r(py)}H${r(x(run.seconds.high))}m0 -3v6"/>`;
  const draw = (run, size, kind) => runMark(run, ...place(run), size, bar(run, place(run)), kind);
  const bySeconds = [...measured].sort((a, b) => a.seconds.value - b.seconds.value);
  out += bySeconds.filter(run => !run.on_front).map(run => draw(run, 4.5, "off")).join("");
  out += front.map(run => draw(run, 6, "on")).join("");
  out += labels(named, measured.map(place), front.map(place), {left, right, top, bottom});
  box.innerHTML = `<svg viewBox="0 0 ${width} ${height}" role="group" ` +
    `aria-label="Error against seconds of ${measured.length} runs; arrow keys go from run to run">${out}</svg>`;
  reachable(box);
}

/// Between two runs of the line the more accurate one cannot be had: it goes right at the error of the faster, then down.
function steps(places, top, right) {
  if (places.length === 0) return "";
  let path = `M${r(places[0][0])} ${top}`;
  for (const [px, py] of places) path += `H${r(px)}V${r(py)}`;
  return `${path}H${right}`;
}

/// Labels where they cover neither each other nor a mark, and if they can not the line; else the next of their words; else
/// nothing, as the table below has them all. One that is led may stand further off, at the end of a line.
function labels(named, marks, stepped, area) {
  const taken = [];
  const meets = (a, b) => a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
  const dots = marks.map(([px, py]) => [px - 6, py - 6, px + 6, py + 6]);
  const edges = stepped.slice(1).flatMap(([px, py], i) =>
    [[px - 1, stepped[i][1], px + 1, py], [stepped[i][0], stepped[i][1] - 1, px, stepped[i][1] + 1]]);
  const around = [[-10, 16, "end"], [-10, -8, "end"], [10, -8, "start"], [10, 16, "start"], [-12, 4, "end"], [12, 4, "start"],
    [-22, 30, "end"], [-30, 46, "end"], [0, -14, "middle"], [0, 24, "middle"], [0, -28, "middle"]];
  const away = [50, 80, 110, 140].flatMap(d => [[d, -d, "middle"], [0, -d, "middle"], [d, d, "middle"], [0, d, "middle"]]);
  const share = {start: 0, middle: 0.5, end: 1};
  const placed = ([px, py], words, places) => {
    const length = words.length * 7 + 4;
    const spots = places.map(([dx, dy, anchor]) => {
      const start = px + dx - length * share[anchor];
      return {box: [start, py + dy - 11, start + length, py + dy + 3], x: px + dx, y: py + dy, anchor};
    });
    const inside = ({box}) => box[0] > area.left && box[2] < area.right && box[1] > area.top && box[3] < area.bottom;
    const free = spots.filter(inside).filter(({box}) => ![...taken, ...dots].some(other => meets(box, other)));
    return free.find(({box}) => !edges.some(edge => meets(box, edge))) || free[0];
  };
  let out = "";
  for (const {at, words, led, places: given} of named) {
    const places = given || (led ? [...around, ...away] : around);
    const fitting = words.map(choice => [choice, placed(at, choice, places)]).find(([, spot]) => spot);
    if (!fitting) continue;
    const [name, spot] = fitting;
    taken.push(spot.box);
    if (led && Math.abs(spot.y - at[1]) >= 50) out += line(at[0], at[1], spot.x, spot.y + (spot.y < at[1] ? 3 : -11), "axis");
    out += text(spot.x, spot.y, name, given ? "tick" : "label", spot.anchor);
  }
  return out;
}

/// One stop of the tab key for a chart: arrow keys go on from there.
function reachable(box) {
  const marks = [...box.querySelectorAll(".run")];
  const first = marks.find(mark => mark.dataset.run === state.select) || marks[0];
  if (first) first.setAttribute("tabindex", "0");
}

function showDetail(run) {
  if (!run) return;
  byId("detail").innerHTML = `<strong>${esc(run.name)}</strong> (${esc(run.setting.method)}): ${seconds(run.seconds.value)} ` +
    `(${secondsRange(run.seconds)}), error ${errorWithRange(run.error)}, bias ${percent(run.bias)}, ` +
    `SSIM ${similarity(run.ssim)}, ${bytes(run.memory_bytes)}.${warmText(run) ? ` With a kept visibility map ${warmText(run)}.` : ""}<br>` +
    `<code>${esc(settingsText(run))}</code>`;
  for (const mark of document.querySelectorAll(".run[data-run]"))
    mark.classList.toggle("shown", mark.dataset.run === run.name);
}
