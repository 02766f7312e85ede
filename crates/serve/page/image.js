// The depth image of an array: a picture in colour, and the values of one pixel.

import { $, html, say } from "./svg.js";
import { text } from "./server.js";
import { INVALID, bar, colour, ends } from "./colours.js";
import { facts, words } from "./pixel.js";

const mm = (metres) => (metres === null ? null : 1e3 * metres);
const valid = (image, values) => values.map((value, place) => (image.valid[place] ? value : null));
const QUANTITIES = {
  depth: { title: "Depth along the line of sight", unit: "m", digits: 3, of: (image) => valid(image, image.depth_m) },
  sigma: { title: "Standard deviation of the depth", unit: "mm", digits: 2, of: (image) => valid(image, image.sigma_m.map(mm)) },
  hits: { title: "Hits in the histogram", unit: "hits", digits: 0, of: (image) => image.hits },
};
const STEPS = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] };
// The image and its scale, the pixel that is selected, and the one under the pointer, by row and column.
let [image, scale] = [null, {}];
let [selected, hovered] = [null, null];
// The newest image of the server, and whether it is on its way.
let [wanted, loading] = [null, false];

const quantity = () => document.querySelector("[name=quantity]:checked").value;
const within = (value, count) => Math.min(Math.max(value, 0), count - 1);

export function setUp() {
  for (const input of document.querySelectorAll("[name=quantity]")) input.onchange = draw;
  const pixels = $("pixels");
  pixels.onpointermove = (event) => { hovered = event.pointerType === "mouse" ? pixelAt(event) : null; mark(); };
  pixels.onpointerleave = () => { hovered = null; mark(); };
  pixels.onclick = (event) => select(pixelAt(event));
  pixels.onkeydown = (event) => {
    const step = STEPS[event.key];
    if (!step || !image || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    select(selected.map((value, k) => value + step[k]));
  };
  for (const id of ["pixel-row", "pixel-column"]) $(id).onchange = () => select([Number($("pixel-row").value), Number($("pixel-column").value)]);
  document.addEventListener("visibilitychange", load);
}

// Selects the quantity that is shown.
export const choose = (name) => { const input = $(`show-${name}`); if (!input.disabled) input.click(); };

function pixelAt({ clientX, clientY }) {
  if (!image) return null;
  const { left, top, width, height } = $("picture").getBoundingClientRect();
  return [within(Math.floor(((clientY - top) / height) * image.rows), image.rows), within(Math.floor(((clientX - left) / width) * image.columns), image.columns)];
}

function select(pixel) {
  if (!image || !pixel) return;
  [selected, hovered] = [[within(Math.round(pixel[0]), image.rows), within(Math.round(pixel[1]), image.columns)], null];
  [$("pixel-row").value, $("pixel-column").value] = selected;
  mark();
  say($("pixel-words"), words(image, selected));
}

export function show(state) {
  const { time, progress, fault } = state;
  say($("images-done"), String(time.images));
  say($("images-rate"), time.images_per_s ? time.images_per_s.toFixed(2) : "–");
  say($("images-firmware"), time.firmware_images_per_s ? time.firmware_images_per_s.toFixed(2) : "cannot scan it");
  say($("images-here"), `${time.here_s.toFixed(1)} s`);
  $("image-progress").max = progress.of;
  $("image-progress").value = progress.pixels;
  const next = state.image && !state.scene_coming ? state.image.number + 1 : 0;
  say($("image-next"), fault ? "" : `Image ${next}: ${progress.pixels} of ${progress.of} pixels simulated`);
  say($("image-fidelity"), state.fidelity === "histogram" ? "Fidelity histogram: each pixel's histogram is drawn from its distribution." : `Fidelity ${state.fidelity}: each pixel's shots are simulated.`);
  wanted = state.image;
  if (wanted) load(); else clear();
}

function clear() {
  [image, scale] = [null, {}];
  say($("image-facts"), "No image has ended yet.");
  for (const id of ["picture-bar", "pixel-facts"]) $(id).replaceChildren();
  $("picture").width = $("picture").width;
  $("image-command").hidden = $("pixel-mark").hidden = true;
}

const isThere = ({ restart, number }) => image !== null && (image.restart > restart || (image.restart === restart && image.number >= number));

async function load() {
  if (loading || !wanted || isThere(wanted) || document.hidden) return;
  loading = true;
  const found = await text("image", { quiet: true });
  loading = false;
  if (found === null || !wanted) return;
  const next = JSON.parse(found);
  if (image?.restart !== next.restart) scale = {};
  image = next;
  selected ??= [Math.floor(image.rows / 2), Math.floor(image.columns / 2)];
  draw();
  load();
}

function draw() {
  if (!image) return;
  const sigmas = image.sigma_m.some((sigma) => sigma !== null);
  $("show-sigma").disabled = !sigmas;
  if (!sigmas && quantity() === "sigma") $("show-depth").checked = true;
  const { title, unit, digits, of } = QUANTITIES[quantity()];
  const values = of(image);
  const ends_ = ends(values, scale[unit]);
  scale[unit] = ends_;
  paint(values, ends_);
  const range = ends_ ? `${ends_[0].toFixed(digits)} to ${ends_[1].toFixed(digits)} ${unit}` : "no pixel is valid";
  const share = `${image.valid_pixels} of ${image.valid.length} pixels valid (${(100 * image.fill_rate).toFixed(1)} %)`;
  const median = image.median_sigma_m === null ? "" : `, median sigma ${(1e3 * image.median_sigma_m).toFixed(2)} mm`;
  $("picture").setAttribute("aria-label", `${title}, image ${image.number}: ${range}; ${share}`);
  say($("image-title"), title);
  say($("image-facts"), `Image ${image.number}: ${share}${median}.`);
  if (ends_) bar($("picture-bar"), ends_, unit, `Scale: ${range}`); else $("picture-bar").replaceChildren();
  $("image-invalid").hidden = !values.includes(null);
  $("image-command").hidden = false;
  say($("image-command"), `# gives images 0 to ${image.number} as files\n${image.command}`);
  mark();
}

function paint(values, scale) {
  const picture = $("picture");
  [picture.width, picture.height] = [image.columns, image.rows];
  $("pixels").style.aspectRatio = `${image.columns} / ${image.rows}`;
  $("pixels").style.maxWidth = `${(33 * image.columns) / Math.max(image.rows, image.columns)}rem`;
  const data = new ImageData(image.columns, image.rows);
  values.forEach((value, place) => data.data.set([...(scale ? colour(value, scale) : INVALID), 255], 4 * place));
  picture.getContext("2d", { willReadFrequently: true }).putImageData(data, 0, 0);
}

// Marks a pixel in the picture, and lists its values.
function mark() {
  const pixel = hovered ?? selected;
  if (!image || !pixel) return;
  const [row, column] = pixel;
  const { style } = $("pixel-mark");
  [style.left, style.top] = [`${(100 * column) / image.columns}%`, `${(100 * row) / image.rows}%`];
  [style.width, style.height] = [`${100 / image.columns}%`, `${100 / image.rows}%`];
  $("pixel-mark").hidden = false;
  for (const [id, value, count] of [["pixel-row", row, image.rows], ["pixel-column", column, image.columns]]) {
    $(id).max = count - 1;
    // What is being typed stays.
    if (document.activeElement !== $(id)) $(id).value = value;
  }
  $("pixel-facts").replaceChildren(...facts(image, pixel).flatMap(([name, value]) => [html("dt", {}, name), html("dd", {}, value)]));
}

export const redraw = draw;
