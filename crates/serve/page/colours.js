// The colours of an image, the same as in the SVG of `tofsim image`.

import { digits, svg, ticks } from "./svg.js";

// Viridis, which is read without colours too: dark is low, light is high.
const STOPS = [[68, 1, 84], [70, 50, 127], [54, 92, 141], [39, 127, 143], [31, 162, 136], [74, 194, 110], [160, 219, 57], [254, 232, 37]];
// Colour of an invalid pixel.
export const INVALID = [225, 225, 225];
// Part of the pixels beyond each end of a scale, and the change of an end that is followed, as a part of the scale.
const BEYOND = 0.01;
const FOLLOWED = 0.03;

export function colour(value, [low, high]) {
  if (value === null) return INVALID;
  const part = high > low ? Math.min(Math.max((value - low) / (high - low), 0), 1) : 0.5;
  const place = part * (STOPS.length - 1);
  const lower = Math.min(Math.floor(place), STOPS.length - 2);
  return STOPS[lower].map((from, k) => Math.round(from + (place - lower) * (STOPS[lower + 1][k] - from)));
}

// The ends of a scale that holds nearly all of some values; those before, where they are nearly the same.
export function ends(values, before) {
  const sorted = values.filter((value) => value !== null).sort((a, b) => a - b);
  if (!sorted.length) return null;
  const beyond = Math.floor(BEYOND * sorted.length);
  const found = [sorted[beyond], sorted[sorted.length - 1 - beyond]];
  const room = FOLLOWED * (found[1] - found[0]);
  return before && found.every((end, k) => Math.abs(end - before[k]) < room) ? before : found;
}

// A bar with the colours of a scale and its numbers, as high as its place.
export function bar(place, scale, unit, label) {
  const [width, height, top] = [72, Math.max(place.clientHeight, 100), 20];
  const root = svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": label });
  const stops = STOPS.map((rgb, k) => svg("stop", { offset: k / (STOPS.length - 1), "stop-color": `rgb(${rgb})` }));
  root.append(svg("linearGradient", { id: "scale", x1: 0, x2: 0, y1: 1, y2: 0 }, ...stops));
  root.append(svg("text", { x: 0, y: 12 }, unit));
  const under = height - 6;
  root.append(svg("rect", { x: 0, y: top, width: 14, height: under - top, fill: "url(#scale)" }));
  const [low, high] = scale;
  const values = high > low ? ticks(low, high, (under - top) / 40) : [low];
  const y = (value) => (high > low ? under - ((value - low) / (high - low)) * (under - top) : (under + top) / 2);
  for (const value of values) {
    root.append(svg("line", { class: "axis", x1: 14, x2: 19, y1: y(value), y2: y(value) }));
    root.append(svg("text", { x: 23, y: y(value) + 4 }, digits(value, Math.abs(values[1] - values[0]) || 0.001)));
  }
  place.replaceChildren(root);
}
