"use strict";
// A curve a knob: error and seconds against its values.

function drawKnobs() {
  const isCurve = curve => curve.runs.length > 1;
  const box = byId("knobs"), curves = trade.knobs.filter(isCurve), left = trade.knobs.filter(curve => !isCurve(curve));
  if (curves.length && box.children.length === 0)
    box.innerHTML = curves.map(curve => `<article class="knob" data-knob="${esc(curve.knob)}">` +
      `<h3>${esc(curve.knob)}${curve.about ? ` <small>about ${esc(curve.about)}</small>` : ""}</h3><div class="plot"></div>` +
      `<p class="${curve.falls && !fallsAsItShould(curve) ? "amiss" : ""}">${esc(findingText(curve))}</p></article>`).join("");
  [...box.querySelectorAll(".knob")].forEach((article, i) => {
    const plot = article.querySelector(".plot");
    plot.innerHTML = knobChart(curves[i], Math.max(240, plot.clientWidth));
    reachable(plot);
  });
  if (curves.length === 0) box.innerHTML = "<p>Of no knob two values were measured.</p>";
  byId("knobs-left").innerHTML = left.length === 0 ? "" : "<h3>Left out</h3><ul>" +
    left.map(curve => `<li><code>${esc(curve.knob)}</code>: ${esc(curve.finding.replace(/^left out: /, ""))}</li>`).join("") + "</ul>";
}

const fallsAsItShould = curve => /^falls\b/.test(curve.finding);

function findingText(curve) {
  if (curve.falls && curve.finding === "falls") return "The error falls along the values, as theory says.";
  const words = curve.finding.replace(/^falls\b/, "the error falls along the values");
  return words && words[0].toUpperCase() + words.slice(1).replace(/([^.])$/, "$1.");
}

function knobChart(curve, width) {
  const all = curve.runs.map(runNamed).filter(Boolean), done = all.filter(run => !run.refused);
  if (done.length === 0) return "<p>Every value was refused; the reasons stand in the table of all runs.</p>";
  const value = run => curve.values[curve.runs.indexOf(run.name)] || run.name;
  const step = (width - 62) / all.length, left = 50;
  const widest = Math.max(...all.map(run => value(run).length)) * 6.6;
  const slanted = widest > step - 4, foot = slanted ? 14 + widest * 0.64 : 18;
  const x = i => left + step * (i + 0.5);
  const numbers = curve.values.every(text => isFinite(Number(text)));
  const high = 105, gap = 20;
  let out = "";
  const panel = (top, title, domain, estimate) => {
    const bottom = top + high, y = logScale(domain[0], domain[1], bottom, top);
    for (const tick of logTicks(domain[0], domain[1], 4))
      out += line(left, y(tick), width - 8, y(tick), "grid") + text(left - 6, y(tick) + 4, tickText(tick), "tick", "end");
    out += line(left, bottom, width - 8, bottom, "axis") + text(left, top - 5, title, "tick");
    const points = all.map((run, i) => run.refused ? null : [x(i), y(estimate(run).value)]);
    if (numbers) out += `<path class="curve" style="--c:var(--soft)" d="${polyline(points)}"/>`;
    all.forEach((run, i) => {
      if (run.refused) out += `<g>${text(x(i), bottom - 4, "×", "label", "middle")}<title>refused: ${esc(run.refused)}</title></g>`;
      else out += runMark(run, x(i), points[i][1], 4.5, errorBar(x(i), y, domain, estimate(run)), "");
    });
    return bottom;
  };
  const middle = panel(18, "error (relMSE)", errorDomain(done, 1.4), run => run.error);
  const times = logDomain(done.flatMap(run => [run.seconds.low, run.seconds.high]), 1.4);
  const bottom = panel(middle + gap + 8, "seconds", times, run => run.seconds);
  all.forEach((run, i) => {
    const turn = slanted ? ` transform="rotate(-40 ${r(x(i))} ${r(bottom + 14)})"` : "";
    out += `<text x="${r(x(i) + (slanted ? 4 : 0))}" y="${r(bottom + 14)}" class="tick${value(run) === curve.own ? " own" : ""}" text-anchor="${slanted ? "end" : "middle"}"${turn}>` +
      `${esc(value(run))}</text>`;
  });
  return `<svg viewBox="0 0 ${width} ${r(bottom + foot)}" role="group" aria-label="Error and seconds against ${esc(curve.knob)}; ` +
    `arrow keys go from value to value">${out}</svg>`;
}

/// Broken where a value was refused.
function polyline(points) {
  let path = "", pen = "M";
  for (const point of points) {
    if (point) path += `${pen}${r(point[0])} ${r(point[1])}`;
    pen = point ? "L" : "M";
  }
  return path;
}
