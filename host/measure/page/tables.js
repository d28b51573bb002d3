"use strict";
// The settings on the line, their stages, and all runs.

const cell = (main, range) => `<td class="figure">${main}${range ? `<small>${range}</small>` : ""}</td>`;
const nameCell = run => `<td class="name"><a class="pick" href="#compare" data-pick="${esc(run.name)}">${esc(run.name)}</a></td>`;
const methodCell = run => `<td class="name"><span class="dot" style="--c:${methodColour(run)}"></span>${esc(run.setting.method)}</td>`;
const dataOf = run => `data-run="${esc(run.name)}" data-seconds="${run.seconds.value}" data-error="${run.error.value}"`;

function drawBest() {
  byId("best").innerHTML = "<thead><tr><th class='figure'>#</th><th>run</th><th class='figure'>seconds</th>" +
    (isFull ? "" : `<th class='figure'>at ${fullSize}</th>`) + "<th class='figure'>error (relMSE)</th>" +
    "<th class='figure'>SSIM</th><th class='figure'>memory</th><th>settings</th></tr></thead><tbody>" +
    front.map((run, i) => `<tr ${dataOf(run)}><td class="figure">${i + 1}</td>${nameCell(run)}` +
      cell(figure(run.seconds.value), secondsRange(run.seconds)) + (isFull ? "" : cell(figure(fullSeconds(run)))) +
      cell(errorText(run.error), errorRange(run.error)) + cell(similarity(run.ssim)) + cell(bytes(run.memory_bytes)) +
      `<td class="settings"><code>${esc(settingsText(run))}</code></td></tr>`).join("") + "</tbody>";
}

function drawStages() {
  byId("stages-legend").innerHTML = legend(stages.slice(0, 7), () => `<span class="swatch"></span>`) +
    (front.some(run => rest(run) > 0) ? `<span style="--c:${colour(7)}"><span class="swatch"></span> all else</span>` : "");
  for (const radio of document.getElementsByName("bars")) radio.checked = radio.value === state.bars;
  const longest = Math.max(...front.map(run => run.seconds.value));
  byId("stages").innerHTML = front.map(run => {
    const full = state.bars === "shares" ? run.seconds.value : longest;
    const part = (name, time, i) => time > 0 ? `<span style="--c:${colour(i)};width:${(100 * time / full).toFixed(3)}%" ` +
      `title="${esc(name)}: ${seconds(time)}, ${Math.round(100 * time / run.seconds.value)} %" data-stage="${esc(name)}" data-seconds="${time}"></span>` : "";
    const parts = stages.slice(0, 7).map((name, i) => part(name, run.stages[name] || 0, i)).join("") + part("all else", rest(run), 7);
    const words = stages.map(name => `${name} ${seconds(run.stages[name] || 0)}`).join(", ");
    return `<div class="stage-row" data-run="${esc(run.name)}"><span class="name">${esc(run.name)}</span>` +
      `<div class="stage-bar" role="img" aria-label="${esc(words)}">${parts}</div><span>${seconds(run.seconds.value)}</span></div>`;
  }).join("");
}

/// Seconds of stages beyond the colours, and of what is no stage.
function rest(run) {
  const named = stages.slice(0, 7).reduce((sum, name) => sum + (run.stages[name] || 0), 0);
  const left = run.seconds.value - named;
  return left > 0.005 * run.seconds.value ? left : 0;
}

// key, title, whether a figure, what is sorted by
const columns = [
  ["name", "run", false, run => run.name],
  ["method", "method", false, run => run.setting.method],
  ["seconds", "seconds", true, run => run.seconds.value],
  ["error", "error (relMSE)", true, run => run.error.value],
  ["bias", "bias", true, run => Math.abs(run.bias)],
  ["ssim", "SSIM", true, run => -run.ssim],
  ["memory", "memory", true, run => run.memory_bytes],
  ["repeats", "runs", true, run => run.repeats.length],
  ...(measured.some(warmText) ? [["warm", "seconds, kept map", true, run => run.warm_seconds || Infinity]] : []),
  ["settings", "settings", false, run => settingsText(run)],
];

function drawAll() {
  const key = state.sort.replace(/^-/, ""), down = state.sort.startsWith("-");
  const [, , , by] = columns.find(column => column[0] === key) || columns[2];
  const order = (a, b) => by(a) < by(b) ? -1 : by(a) > by(b) ? 1 : 0;
  const sorted = [...measured].sort(order);
  if (down) sorted.reverse();
  const head = columns.map(([name, title, isFigure]) => `<th scope="col" class="${isFigure ? "figure" : ""}"` +
    `${name === key ? ` aria-sort="${down ? "descending" : "ascending"}"` : ""}><button type="button" data-sort="${name}">${title}</button></th>`);
  const row = run => `<tr ${dataOf(run)} class="${run.name === state.select ? "selected" : ""}">${nameCell(run)}${methodCell(run)}` +
    cell(figure(run.seconds.value), secondsRange(run.seconds)) + cell(errorText(run.error), errorRange(run.error)) +
    cell(percent(run.bias)) + cell(similarity(run.ssim)) + cell(bytes(run.memory_bytes)) +
    cell(run.repeats.length) + (measured.some(warmText) ? cell(warmText(run)) : "") +
    `<td class="settings"><code>${esc(settingsText(run))}</code></td></tr>`;
  const refused = run => `<tr data-refused="${esc(run.name)}"><td class="name">${esc(run.name)}</td><td>${esc(run.setting.method)}</td>` +
    `<td colspan="${columns.length - 3}">not run: ${esc(run.refused)}</td><td class="settings"><code>${esc(settingsText(run))}</code></td></tr>`;
  const focused = document.activeElement && document.activeElement.dataset.sort;
  byId("all").innerHTML = `<thead><tr>${head.join("")}</tr></thead><tbody>${sorted.map(row).join("")}` +
    `${runs.filter(run => run.refused).map(refused).join("")}</tbody>`;
  if (focused) byId("all").querySelector(`[data-sort=${focused}]`).focus();
}
