"use strict";
// Which setting for which wish.

function drawWant() {
  const wishes = [
    ["error", "an error", fastestWithinError, "No measured run has so small an error."],
    ["seconds", "a time", mostAccurateWithin, "No measured run is so fast."],
  ];
  for (const [key, noun, choose, none] of wishes) {
    const field = byId(`want-${key}`), card = byId(`for-${key}`);
    // The figure in the field is rounded, the scene's own is not; an error that cannot be told is known by its upper end.
    const usual = own ? (own[key].value > 0 ? own[key].value : own[key].high) : 0;
    if (document.activeElement !== field) field.value = state[key] || (usual > 0 && isFinite(usual) ? figure(usual) : "");
    const limit = state[key] ? Number(state[key].trim().replace(",", ".")) : usual;
    const run = limit > 0 ? choose(limit) : undefined;
    card.dataset.want = key;
    card.dataset.run = run ? run.name : "";
    card.innerHTML = run ? recommendation(run, key, limit) : `<p>${limit > 0 ? none : `Write ${noun} above 0, such as 0.01.`}</p>`;
  }
}

function recommendation(run, key, limit) {
  const doubt = run[key].high > limit
    ? ` Its interval reaches ${figure(run[key].high)}${key === "seconds" ? " s" : ""}, which is more than you asked for.` : "";
  const kept = warmText(run) ? ` A second picture takes ${warmText(run)}: the visibility map is kept.` : "";
  return `<p>${pick(run)}: ${seconds(run.seconds.value)}, error ${errorWithRange(run.error)}, ` +
    `${bytes(run.memory_bytes)}.${doubt}${kept}</p>` +
    `<div class="command"><code>${unbroken(commands[run.name] || "")}</code>` +
    `<button type="button" data-copy="${esc(commands[run.name] || "")}">Copy</button></div>`;
}

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
  const list = [["own", own, `The scene’s own setting takes ${seconds(own.seconds.value)} and has an error of ` +
    `${errorText(own.error)}. ${own.on_front ? "No measured run beats it in both." : "It is not on the line."}`]];
  const half = mostAccurateWithin(own.seconds.value / 2);
  list.push(["half-time", half, half
    ? `For half the time: ${pick(half)} takes ${seconds(half.seconds.value)}; ${errorAgainstOwn(half)}`
    : "For half the time: no measured run is so fast."]);
  if (!isTold(own.error)) {
    list.push(["half-error", undefined, "For half the error: the scene’s own error is not one that this reference can tell."]);
    return list;
  }
  const better = fastestWithinError(own.error.value / 2);
  list.push(["half-error", better, better
    ? `For half the error: ${pick(better)} takes ${timeAgainstOwn(better)}; ${errorAgainstOwn(better)}`
    : "For half the error: no measured run is so accurate."]);
  const same = fastestWithinError(own.error.value);
  if (same && same !== own && same !== better)
    list.push(["same-error", same, `For no more error: ${pick(same)} takes ${timeAgainstOwn(same)}.`]);
  return list;
}

function errorAgainstOwn(run) {
  const ratio = isTold(run.error) && isTold(own.error) ? `, ${figure(run.error.value / own.error.value)} times the scene’s own` : "";
  return `its error is ${errorText(run.error)}${ratio}.`;
}

function timeAgainstOwn(run) {
  const ratio = run.seconds.value / own.seconds.value;
  return `${seconds(run.seconds.value)}, ${figure(ratio)} times the scene’s own`;
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
