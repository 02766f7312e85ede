// A waveform in SVG, with zoom, and the files that it can be read from.

import { html, svg, ticks, digits } from "./svg.js";

const ROW = 24;
// Drawn at most of a signal, so that a long capture does not stop the browser.
const MOST = 4000;

// Signals as { name, width, changes: [[time, value], ...] } of a value change dump, times in its unit.
export function readVcd(text) {
  const [signals, byId] = [[], new Map()];
  const scope = [];
  let [time, unit] = [0, 1];
  let body = false;
  for (const line of text.split("\n")) {
    const word = line.trim();
    if (!word) continue;
    if (!body) {
      const parts = word.split(/\s+/);
      if (parts[0] === "$scope") scope.push(parts[2]);
      else if (parts[0] === "$upscope") scope.pop();
      else if (parts[0] === "$var") {
        const found = byId.get(parts[3]);
        const signal = { name: [...scope.slice(1), parts[4]].join("."), width: Number(parts[2]), changes: found?.changes ?? [] };
        byId.set(parts[3], signal);
        signals.push(signal);
      } else if (parts[0] === "$timescale") unit = /(\d+)\s*ps/.exec(word)?.[1] ?? unit;
      else if (parts[0] === "$enddefinitions") body = true;
      continue;
    }
    const first = word[0];
    if (first === "#") time = Number(word.slice(1)) * unit;
    else if (first === "b" || first === "r") {
      const [value, id] = word.slice(1).split(/\s+/);
      byId.get(id)?.changes.push([time, /[xz]/i.test(value) ? null : BigInt(`0b${value}`)]);
    } else if ("01xzXZ".includes(first)) {
      byId.get(word.slice(1))?.changes.push([time, first === "0" ? 0n : first === "1" ? 1n : null]);
    }
  }
  return { signals, end: time };
}

// The same of a capture's CSV, times in samples: one window, from its first sample.
export function readCsv(text, probes, from, samples) {
  const rows = text.split("\n").slice(2).filter(Boolean).slice(from, from + samples).map((row) => row.split(","));
  const radices = text.split("\n")[1].split(",");
  const parse = (cell, radix) => {
    if (radix === "SIGNED" || radix === "UNSIGNED") return BigInt(cell);
    return BigInt({ HEX: "0x", BINARY: "0b", OCTAL: "0o" }[radix] + cell);
  };
  const signals = probes.map(({ name, width }, k) => {
    const [column, changes] = [k + 3, []];
    let last = null;
    rows.forEach((cells, sample) => {
      if (cells[column] === last) return;
      last = cells[column];
      changes.push([sample, parse(last, radices[column].trim())]);
    });
    return { name, width, changes };
  });
  return { signals, end: rows.length };
}

// A view of signals in `place`, with times told from `zero` on; `axis` turns a time into a text.
export function view(place, { signals, from, to, zero, mark, label, axis, unit }) {
  let [begin, end] = [from, to];
  const names = 14 + 6.7 * Math.max(...signals.map(({ name }) => name.length));
  const canvas = html("div", { class: "canvas", tabindex: 0, role: "group", "data-keys": "" , "aria-label": `${label}; plus and minus zoom, arrows move` });
  const range = html("span", { class: "hint" });
  const draw = () => {
    const width = Math.max(place.clientWidth, 280);
    const left = Math.min(names, width * 0.38);
    const height = signals.length * ROW + 24;
    const x = (time) => left + ((time - begin) / (end - begin)) * (width - left - 2);
    const root = svg("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": label });
    const steps = ticks(begin - zero, end - zero, (width - left) / 90).map((time) => time + zero);
    for (const time of steps) {
      root.append(svg("line", { class: "grid", x1: x(time), x2: x(time), y1: 0, y2: height - 18 }));
      const anchor = x(time) > width - 30 ? "end" : "middle";
      root.append(svg("text", { x: x(time), y: height - 5, "text-anchor": anchor }, axis(time, steps[1] - steps[0] || 1)));
    }
    root.append(svg("text", { x: 2, y: height - 5 }, unit));
    signals.forEach((signal, row) => one(root, signal, row * ROW + 4, { x, begin, end, left, width }));
    if (mark !== null && mark >= begin && mark <= end) {
      root.append(svg("line", { class: "trigger", x1: x(mark), x2: x(mark), y1: 0, y2: height - 18 }));
    }
    canvas.replaceChildren(root);
    range.textContent = `${axis(begin, (end - begin) / 1000)} to ${axis(end, (end - begin) / 1000)} ${unit}`;
  };
  const zoom = (factor) => {
    const middle = mark !== null && mark > begin && mark < end ? mark : (begin + end) / 2;
    const span = Math.min(to - from, Math.max((to - from) / 5000, (end - begin) * factor));
    move(middle - (middle - begin) * (span / (end - begin)), span);
  };
  const move = (start, span = end - begin) => {
    begin = Math.max(from, Math.min(start, to - span));
    end = begin + span;
    draw();
  };
  const all = () => move(from, to - from);
  const acts = { "+": () => zoom(0.5), "=": () => zoom(0.5), "-": () => zoom(2), ArrowLeft: () => move(begin - (end - begin) / 4), ArrowRight: () => move(begin + (end - begin) / 4), 0: all };
  canvas.onkeydown = (event) => {
    const act = acts[event.key];
    if (!act || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    act();
  };
  const button = (text, name, act) => {
    const made = html("button", { type: "button", "aria-label": name }, text);
    made.onclick = act;
    return made;
  };
  const tools = html("div", { class: "tools" },
    button("+", "Zoom in", () => zoom(0.5)), button("−", "Zoom out", () => zoom(2)),
    button("←", "Earlier", acts.ArrowLeft), button("→", "Later", acts.ArrowRight), button("all", "Show all", all), range);
  place.classList.add("waves");
  place.replaceChildren(tools, canvas);
  draw();
  return { draw, move };
}

function one(root, { name, width, changes }, top, { x, begin, end, left, width: right }) {
  const title = svg("title", {}, name);
  const room = Math.floor((left - 8) / 6.7);
  const shown = name.length > room ? `…${name.slice(1 - room)}` : name;
  root.append(svg("text", { class: "name", x: 2, y: top + 13 }, shown, title));
  const [low, high, middle] = [top + 16, top + 2, top + 9];
  const first = Math.max(0, changes.findLastIndex(([time]) => time <= begin));
  const part = [];
  for (let k = first; k < changes.length && changes[k][0] < end && part.length < MOST; k++) {
    const until = k + 1 < changes.length ? changes[k + 1][0] : end;
    part.push([Math.max(x(changes[k][0]), left), Math.min(x(until), right - 2), changes[k][1]]);
  }
  if (!part.length) return;
  if (width === 1) {
    const level = (value) => (value === null ? middle : value ? high : low);
    const d = part.map(([from, to, value], k) => `${k ? "L" : "M"}${from.toFixed(1)} ${level(value)}L${to.toFixed(1)} ${level(value)}`).join("");
    return root.append(svg("path", { class: "bit", d }));
  }
  let d = "";
  for (const [from, to, value] of part) {
    const slope = Math.min(3, (to - from) / 2);
    d += `M${from.toFixed(1)} ${middle}L${(from + slope).toFixed(1)} ${high}L${(to - slope).toFixed(1)} ${high}L${to.toFixed(1)} ${middle}L${(to - slope).toFixed(1)} ${low}L${(from + slope).toFixed(1)} ${low}Z`;
    const text = value === null ? "x" : width > 16 ? value.toString(16) : value.toString();
    if (to - from > 6 + 6.5 * text.length) root.append(svg("text", { class: "value", x: (from + to) / 2, y: middle + 4 }, text));
  }
  root.append(svg("path", { class: "bus", d }));
}
