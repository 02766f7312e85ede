// Elements by their names, and what plots have in common.

const SVG = "http://www.w3.org/2000/svg";

export const $ = (id) => document.getElementById(id);

function fill(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

export const html = (tag, attributes = {}, ...children) => fill(document.createElement(tag), attributes, children);

export const svg = (tag, attributes = {}, ...children) => fill(document.createElementNS(SVG, tag), attributes, children);

// Sets a text if it is another one, so that nothing is read out twice.
export function say(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

// Steps of 1, 2 or 5 that divide a span into about so many parts.
export function ticks(from, to, parts) {
  const span = to - from;
  if (!(span > 0)) return [from];
  const power = 10 ** Math.floor(Math.log10(span / parts));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((step) => span / step <= parts * 1.2) ?? 10 * power;
  const first = Math.ceil(from / step - 1e-9);
  return Array.from({ length: Math.floor(to / step + 1e-9) - first + 1 }, (_, k) => (first + k) * step);
}

// A number with as many decimals as its steps have.
export function digits(value, step) {
  const decimals = Math.max(0, Math.min(9, -Math.floor(Math.log10(step) + 1e-9)));
  return value.toFixed(decimals);
}

// The frame of a plot: its size, its scales and its axes.
export function plot(place, [x0, x1], [y0, y1], { left = 52, bottom = 34, top = 8, right = 8, xLabel, yLabel }) {
  const [width, height] = [Math.max(place.clientWidth, 120), Math.max(place.clientHeight, 100)];
  const x = (value) => left + ((value - x0) / (x1 - x0)) * (width - left - right);
  const y = (value) => height - bottom - ((value - y0) / (y1 - y0)) * (height - bottom - top);
  const root = svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img" });
  const xTicks = ticks(x0, x1, width / 90);
  const yTicks = ticks(y0, y1, height / 45);
  for (const value of yTicks) {
    root.append(svg("line", { class: "grid", x1: left, x2: width - right, y1: y(value), y2: y(value) }));
    const text = digits(value, Math.abs(yTicks[1] - yTicks[0]) || 1);
    root.append(svg("text", { x: left - 6, y: y(value) + 4, "text-anchor": "end" }, text));
  }
  const under = height - bottom;
  root.append(svg("line", { class: "axis", x1: left, x2: width - right, y1: under, y2: under }));
  for (const value of xTicks) {
    root.append(svg("line", { class: "axis", x1: x(value), x2: x(value), y1: under, y2: under + 4 }));
    const text = digits(value, Math.abs(xTicks[1] - xTicks[0]) || 1);
    const end = x(value) > width - 24 ? "end" : "middle";
    root.append(svg("text", { x: Math.min(x(value), width - 2), y: under + 16, "text-anchor": end }, text));
  }
  if (xLabel) root.append(svg("text", { x: width - 2, y: height - 2, "text-anchor": "end" }, xLabel));
  if (yLabel) root.append(svg("text", { x: left + 4, y: top + 9 }, yLabel));
  return { root, x, y, width, height, under, top, left };
}

// Calls at most once in so many milliseconds, the last time with the newest arguments.
export function seldom(milliseconds, call) {
  let [timer, latest, last] = [null, null, 0];
  return (...args) => {
    latest = args;
    if (timer) return;
    const wait = Math.max(0, last + milliseconds - performance.now());
    timer = setTimeout(() => {
      [timer, last] = [null, performance.now()];
      call(...latest);
    }, wait);
  };
}
