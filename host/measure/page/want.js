"use strict";
// Which setting for which wish.

function drawWant() {
  const wishes = [
    ["error", "an error", fastestWithinError, "No measured run has so small an error."],
    ["seconds", "a time", mostAccurateWithin, "No measured run is so fast."],
  ];
  for (const [key, noun, choose, none] of wishes) {
    const field = byId(`want-${key}`), card = byId(`for-${key}`);
    // Half of the scene's own, to begin with; an error that cannot be told is known by its upper end.
    const usual = !own ? 0 : key === "seconds" ? fullSeconds(own) / 2 : (isTold(own.error) ? own.error.value : own.error.high) / 2;
    if (document.activeElement !== field) field.value = state[key] || (usual > 0 && isFinite(usual) ? figure(usual) : "");
    const limit = state[key] ? Number(state[key].trim().replace(",", ".")) : usual;
    const run = limit > 0 ? choose(limit) : undefined;
    card.dataset.want = key;
    card.dataset.run = run ? run.name : "";
    const nearest = least(measured, one => key === "seconds" ? fullSeconds(one) : one.error.value);
    const reached = nearest ? ` The least is that of ${pick(nearest)}, ${key === "seconds" ? timeText(nearest) : errorText(nearest.error)}.` : "";
    card.innerHTML = run ? recommendation(run, key, limit)
      : `<p>${limit > 0 ? `${none}${reached}` : `Write ${noun} above 0, such as 0.01.`}</p>`;
  }
}

function recommendation(run, key, limit) {
  const high = key === "seconds" ? fullSeconds(run) - run.seconds.value + run.seconds.high : run.error.high;
  const doubt = high > limit ? ` Its interval reaches ${figure(high)}${key === "seconds" ? " s" : ""}, which is more than you asked for.` : "";
  const kept = warmText(run) ? ` A second picture takes ${warmText(run)}: the visibility map is kept.` : "";
  return `<p>${pick(run)}: ${timeText(run)}${isFull ? "" : ` (${seconds(run.seconds.value)} at the measured size)`}, error ${errorWithRange(run.error)}, ` +
    `${bytes(run.memory_bytes)}.${doubt}${kept}</p>` + command(run);
}

const command = run => `<div class="command"><code>${unbroken(commands[run.name] || "")}</code>` +
  `<button type="button" data-copy="${esc(commands[run.name] || "")}">Copy</button></div>`;

const timeText = run => isFull ? seconds(run.seconds.value) : `about ${seconds(fullSeconds(run))} at ${fullSize}`;

/// A command whose words do not break at their hyphens.
const unbroken = command => command.split(" ").map(word => `<span>${esc(word)}</span>`).join(" ");

const pick = run => `<a class="pick" href="#compare" data-pick="${esc(run.name)}"><strong>${esc(run.name)}</strong></a>`;

function drawSentences() {
  byId("sentences").innerHTML = sentences().map(([key, run, words]) =>
    `<li data-sentence="${key}" data-run="${run ? esc(run.name) : ""}">${words}</li>`).join("");
}

/// [what it is about, run, HTML]
function sentences() {
  if (!own) return [["own", undefined, "The scene’s own setting was not measured."]];
  const list = [["own", own, `The scene’s own setting takes ${timeText(own)} and has an error of ` +
    `${errorText(own.error)}. ${own.on_front ? "No measured run beats it in both." : "It is not on the line."}`]];
  const half = mostAccurateWithin(fullSeconds(own) / 2);
  list.push(["half-time", half, half
    ? `For half the time: ${pick(half)} takes ${timeAgainstOwn(half)}; ${errorAgainstOwn(half)}${command(half)}`
    : "For half the time: no measured run is so fast."]);
  if (!isTold(own.error)) {
    list.push(["half-error", undefined, "For half the error: the scene’s own error is not one that this reference can tell."]);
    return list;
  }
  const better = fastestWithinError(own.error.value / 2);
  list.push(["half-error", better, better
    ? `For half the error: ${pick(better)} takes ${timeAgainstOwn(better)}; ${errorAgainstOwn(better)}${command(better)}`
    : "For half the error: no measured run is so accurate."]);
  const same = fastestWithinError(own.error.value);
  if (same && same !== own && same !== better)
    list.push(["same-error", same, `For no more error: ${pick(same)} takes ${timeAgainstOwn(same)}.${command(same)}`]);
  return list;
}

function errorAgainstOwn(run) {
  const ratio = isTold(run.error) && isTold(own.error) ? `, ${figure(run.error.value / own.error.value)} times the scene’s own` : "";
  const doubt = isTold(run.error) ? ` (${errorRange(run.error)})` : "";
  return `its error is ${errorText(run.error)}${doubt}${ratio}.`;
}

function timeAgainstOwn(run) {
  return `${timeText(run)}, ${figure(fullSeconds(run) / fullSeconds(own))} times the scene’s own`;
}

/// Local files may not use the clipboard in every browser; there the text is selected and copied the old way.
async function copy(button) {
  try {
    await navigator.clipboard.writeText(button.dataset.copy);
  } catch (refused) {
    getSelection().selectAllChildren(button.previousElementSibling);
    if (!document.execCommand("copy")) return;
  }
  button.textContent = "Copied";
  setTimeout(() => { button.textContent = "Copy"; }, 2000);
}
