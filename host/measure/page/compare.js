"use strict";
// Two pictures: beside each other, in turn, under a slider, and their difference.

function pictureOf(name) {
  const found = pictures[name === "reference" ? reference.picture : (runNamed(name) || {}).picture];
  return found && !found.startsWith("data:") ? pictures[found] : found; // the name of the same one
}
const captionOf = name => {
  if (name === "reference") return `the reference: ${reference.source}`;
  const run = runNamed(name);
  return `${name}: ${seconds(run.seconds.value)}, error ${errorText(run.error)}`;
};

function drawCompare() {
  const option = name => `<option value="${esc(name)}">${esc(name === "reference" ? "the reference" : name)}</option>`;
  byId("picture-a").innerHTML = measured.map(run => option(run.name)).join("");
  byId("picture-b").innerHTML = ["reference", ...measured.map(run => run.name)].map(option).join("");
  byId("picture-a").value = state.select;
  byId("picture-b").value = state.against;
  for (const radio of document.getElementsByName("view")) radio.checked = radio.value === state.view;
  byId("flip").hidden = state.view !== "flip";

  const box = byId("pictures");
  Object.assign(box.dataset, {a: state.select, b: state.against, view: state.view, flip: state.flip ? "1" : "0"});
  delete box.dataset.meanDifference;
  const missing = [state.select, state.against].filter(name => !pictureOf(name));
  if (missing.length) {
    const names = missing.map(name => name === "reference" ? "the reference" : esc(name)).join(" or ");
    box.innerHTML = state.select ? `<p>No picture of ${names} lay in the folder when this page was written.</p>` : "<p>No run was measured.</p>";
    return;
  }
  ({side: drawSide, flip: drawFlip, slide: drawSlide, heat: drawHeat})[state.view](box, state.select, state.against);
}

const image = (name, kind) => `<img src="${pictureOf(name)}" alt="Picture of ${esc(name)}" class="${kind || ""}">`;
const shown = (letter, name) => `<figcaption><strong>${letter}</strong> ${esc(captionOf(name))}</figcaption>`;

function drawSide(box, a, b) {
  box.innerHTML = `<div class="pair"><figure>${image(a)}${shown("A", a)}</figure><figure>${image(b)}${shown("B", b)}</figure></div>`;
}

/// Both are in the page, so that the change has no flash between them.
function drawFlip(box, a, b) {
  const [letter, name] = state.flip ? ["B", b] : ["A", a];
  box.innerHTML = `<figure class="one"><div class="over">${image(a)}<div class="above"${state.flip ? "" : " hidden"}>${image(b)}</div></div>` +
    `${shown(letter, name)}</figure>`;
}

function drawSlide(box, a, b) {
  box.innerHTML = `<figure class="one"><div class="over">${image(b)}<div class="above">${image(a)}</div><div class="edge"></div></div>` +
    `<input type="range" id="slide" min="0" max="100" value="50" aria-label="Share of picture A, from the left">` +
    `<figcaption>Left of the edge: <strong>A</strong> ${esc(captionOf(a))}.<br>Right: <strong>B</strong> ${esc(captionOf(b))}.</figcaption></figure>`;
  const slide = byId("slide");
  const cut = () => {
    box.querySelector(".above").style.clipPath = `inset(0 ${100 - slide.value}% 0 0)`;
    box.querySelector(".edge").style.left = `${slide.value}%`;
  };
  slide.addEventListener("input", cut);
  cut();
}

async function drawHeat(box, a, b) {
  box.innerHTML = `<p>Taking the difference of the two pictures.</p>`;
  const [first, second] = await Promise.all([a, b].map(decoded));
  if (state.view !== "heat" || state.select !== a || state.against !== b) return;
  if (first.width !== second.width || first.height !== second.height) {
    box.innerHTML = "<p>The two pictures differ in size.</p>";
    return;
  }
  const steps = differences(first.data, second.data), sorted = Uint8Array.from(steps).sort();
  const brightest = [4, 8, 16, 32, 64, 128, 255].find(limit => sorted[Math.floor(sorted.length * 0.99)] <= limit);
  const mean = steps.reduce((sum, step) => sum + step, 0) / steps.length;
  box.innerHTML = `<figure class="one"><canvas width="${first.width}" height="${first.height}" role="img" ` +
    `aria-label="Difference of ${esc(a)} and ${esc(b)}"></canvas><div class="scale"></div>` +
    `<div class="ends"><span>0</span><span>${brightest} steps of 255 and more</span></div>` +
    `<figcaption>|A - B|, the largest of red, green and blue, taken from the two PNG pictures: what a screen shows, not radiance. ` +
    `Mean ${figure(mean)}, largest ${sorted[sorted.length - 1]} steps of 255.<br><strong>A</strong> ${esc(captionOf(a))}.<br>` +
    `<strong>B</strong> ${esc(captionOf(b))}.</figcaption></figure>`;
  const canvas = box.querySelector("canvas"), context = canvas.getContext("2d");
  const pixels = context.createImageData(first.width, first.height);
  steps.forEach((step, i) => pixels.data.set([...heat(Math.min(1, step / brightest)), 255], i * 4));
  context.putImageData(pixels, 0, 0);
  box.dataset.meanDifference = mean.toFixed(4);
}

async function decoded(name) {
  const picture = new Image();
  await new Promise((done, failed) => { picture.onload = done; picture.onerror = failed; picture.src = pictureOf(name); });
  const canvas = document.createElement("canvas");
  canvas.width = picture.naturalWidth;
  canvas.height = picture.naturalHeight;
  const context = canvas.getContext("2d");
  context.drawImage(picture, 0, 0);
  return context.getImageData(0, 0, canvas.width, canvas.height);
}

/// The largest difference of the three colours of each pixel, 0 to 255.
function differences(a, b) {
  const steps = new Uint8Array(a.length / 4);
  for (let i = 0; i < steps.length; ++i)
    for (let c = 0; c < 3; ++c) steps[i] = Math.max(steps[i], Math.abs(a[i * 4 + c] - b[i * 4 + c]));
  return steps;
}

/// Black, violet, red, yellow, pale: rises in brightness throughout. The scale of page.css has the same colours.
const heatColours = [[0, 0, 4], [66, 10, 104], [147, 38, 103], [221, 81, 58], [252, 165, 10], [252, 255, 164]];
function heat(share) {
  const at = share * (heatColours.length - 1), i = Math.min(heatColours.length - 2, Math.floor(at));
  return heatColours[i].map((low, c) => low + (heatColours[i + 1][c] - low) * (at - i));
}
