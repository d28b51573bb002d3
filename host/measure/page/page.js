"use strict";
// What stands at the head and the foot of the page, and what happens when a reader does something.

function drawHead() {
  const name = trade.scene.split("/").pop();
  byId("scene").textContent = name;
  document.title = `Speed against accuracy: ${name}`;
  const noise = reference.own_noise > 0 ? `; its own noise, ${figure(reference.own_noise)}, is taken off every error` : "";
  const facts = [
    ["Scene", [trade.scene, ...(trade.overrides || [])].join("  ")], ["Device", trade.device], ["Date", `${trade.date}, pointgi ${trade.version}`],
    ["Picture", `${trade.width} x ${trade.height} pixels${isFull ? "" : `; the scene asks for ${fullSize}`}`],
    ["Reference", `${reference.source}${reference.seconds > 0 ? `, ${seconds(reference.seconds)}` : ""}${noise}`],
    ["Budget", `${seconds(trade.budget_seconds)}, of which ${seconds(trade.spent_seconds)} were spent; ${runs.length} settings`],
  ];
  if (ownValues.length) facts.push(["The scene’s own", ownValues.join(", ")]);
  if (cheap) facts.push(["Run cheap", settingsText(cheap)]);
  byId("facts").innerHTML = facts.map(([title, words]) => `<div><dt>${title}</dt><dd>${esc(words)}</dd></div>`).join("");
  const terms = [
    ["seconds", "From the prepared cloud to the picture, by a process that has its kernels: the median of the repetitions, below it the interval that holds it in 95 of 100 measurements. " +
      `The stage render grows with the pixels of the picture; the others do not depend on them.${isFull ? "" : ` The seconds at ${fullSize} are reckoned by that.`}`],
    ["runs", "How often the setting was run, each time with another seed."],
    ["error (relMSE)", "As pointgi compare prints it: the mean over the pixels of the squared difference from the reference, relative to the squared reference. A quarter " +
      "of the error is half the difference. The noise of the reference is taken off, so that an interval may reach below 0: the reference cannot tell such an error from none. " +
      "The interval holds the error in 95 of 100 measurements. Of a single run it is too wide: places differ, not only chances."],
    ["bias", "Difference of the mean of the picture from the mean of the reference, relative."],
    ["SSIM", "Structural similarity with the reference; 1 is the same."],
    ...(measured.some(warmText) ? [["seconds, kept map", "Of one more run with the visibility map of an earlier one, where that took much of the time: a second picture of the same scene. The column seconds " +
      "is of runs that made the map anew."]] : []),
    ["memory", "The most that was in use on the device at a time."],
  ];
  byId("terms").innerHTML = terms.map(([title, words]) => `<dt>${title}</dt><dd>${words}</dd>`).join("");
  if (!isFull) document.querySelector("label[for=want-seconds]").textContent = `seconds, at most, at ${fullSize}`;
  byId("legend").innerHTML = legend(methods, markSign);
}

function drawCharts() {
  drawFront();
  drawKnobs();
  markSelected();
}

function markSelected() {
  for (const mark of document.querySelectorAll(".run[data-run]"))
    mark.classList.toggle("selected", mark.dataset.run === state.select);
}

function drawState() {
  drawWant();
  drawSentences();
  drawCompare();
  drawStages();
  drawAll();
  markSelected();
}

function change(changes) {
  Object.assign(state, changes);
  writeAddress();
  drawState();
}

function choose(name) {
  change({select: name});
  showDetail(runNamed(name));
}

document.addEventListener("click", event => {
  const at = kind => event.target.closest(kind);
  if (at("[data-copy]")) copy(at("[data-copy]"));
  else if (at("[data-sort]")) {
    const key = at("[data-sort]").dataset.sort;
    change({sort: state.sort === key ? `-${key}` : key});
  } else if (at("[data-pick]")) {
    event.preventDefault();
    choose(at("[data-pick]").dataset.pick);
    byId("compare").scrollIntoView();
  } else if (at(".run[data-run]")) choose(at(".run[data-run]").dataset.run);
});

for (const kind of ["mouseover", "focusin"])
  document.addEventListener(kind, event => {
    const mark = event.target.closest(".run[data-run]");
    if (mark) showDetail(runNamed(mark.dataset.run));
  });

document.addEventListener("keydown", event => {
  const mark = event.target.closest(".run[data-run]");
  if (mark) moveAmong(mark, event);
  else if (event.key.toLowerCase() === "f" && state.view === "flip" && !event.ctrlKey && !event.metaKey && !event.altKey &&
    !event.target.closest("input[type=text], select")) change({flip: state.flip ? "" : "1"});
});

/// Arrow keys go through the runs of a chart from left to right; Enter or space chooses.
function moveAmong(mark, event) {
  if (event.key === "Enter" || event.key === " ") {
    event.preventDefault();
    choose(mark.dataset.run);
    return;
  }
  const step = {ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1}[event.key];
  if (!step) return;
  event.preventDefault();
  const across = other => Number(other.querySelector(".halo").getAttribute("cx"));
  const marks = [...mark.closest("svg").querySelectorAll(".run")].sort((a, b) => across(a) - across(b));
  const next = marks[(marks.indexOf(mark) + step + marks.length) % marks.length];
  mark.setAttribute("tabindex", "-1");
  next.setAttribute("tabindex", "0");
  next.focus();
}

byId("want").addEventListener("submit", event => event.preventDefault());
for (const key of ["error", "seconds"])
  byId(`want-${key}`).addEventListener("input", event => change({[key]: event.target.value}));
byId("picture-a").addEventListener("change", event => choose(event.target.value));
byId("picture-b").addEventListener("change", event => change({against: event.target.value}));
byId("view").addEventListener("change", event => change({view: event.target.value, flip: ""}));
byId("bars").addEventListener("change", event => change({bars: event.target.value}));
byId("flip").addEventListener("click", () => change({flip: state.flip ? "" : "1"}));
addEventListener("hashchange", () => { readAddress(); drawState(); });

// Charts are drawn at the width that they have, so that their text keeps its size.
let drawnWidth = 0;
addEventListener("resize", () => {
  if (byId("front").clientWidth !== drawnWidth) {
    drawnWidth = byId("front").clientWidth;
    drawCharts();
  }
});

readAddress();
drawHead();
drawnWidth = byId("front").clientWidth;
drawCharts();
drawBest();
drawState();
showDetail(runNamed(state.select));
