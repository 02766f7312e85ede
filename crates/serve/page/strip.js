// The depths of the last frames, and the parts of a frame.

import { $, html, plot, say, svg } from "./svg.js";

let drawn = null;

export function show(state) {
  timeline(state);
  const { strip, frame } = state;
  const seen = `${strip.length} ${strip.at(-1)?.frame} ${$("strip").clientWidth}`;
  if (seen === drawn) return;
  drawn = seen;
  if (!strip.length || !frame) return $("strip").replaceChildren();
  const names = frame.depths.map(({ estimator }) => estimator);
  const [from, to] = range(strip);
  const [first, last] = [strip[0].frame, Math.max(strip.at(-1).frame, strip[0].frame + 10)];
  const { root, x, y, width } = plot($("strip"), [first, last], [from, to], { xLabel: "frame", yLabel: "m" });
  const clipped = (depth_m) => y(Math.min(Math.max(depth_m, from), to)).toFixed(1);
  const line = (style, of) => {
    let [d, on] = ["", false];
    for (const point of strip) {
      const depth_m = of(point);
      if (depth_m !== null) d += `${on ? "L" : "M"}${x(point.frame).toFixed(1)} ${clipped(depth_m)}`;
      on = depth_m !== null;
    }
    root.append(svg("path", { class: `line ${style}`, d }));
  };
  const step = Math.max(1, x(first + 1) - x(first));
  for (const { frame, true_m, bound_two_sd_mm: bound } of strip) {
    if (true_m === null || bound === null || true_m < from || true_m > to) continue;
    const [high, low] = [clipped(true_m + bound / 1e3), clipped(true_m - bound / 1e3)];
    const left = Math.min(x(frame), width - step);
    root.append(svg("rect", { class: "band", x: left, width: step, y: high, height: Math.max(0.5, low - high) }));
  }
  names.forEach((name, k) => line(name, (point) => point.depths_m[k] ?? null));
  line("true", (point) => point.true_m);
  root.setAttribute("aria-label", `Depths of frames ${first} to ${strip.at(-1).frame}, from ${from.toFixed(3)} to ${to.toFixed(3)} m; the band is the Cramer-Rao bound`);
  $("strip").replaceChildren(root);
}

// All depths but the few that are furthest off, and the true ones.
function range(strip) {
  const depths = strip.flatMap(({ depths_m }) => depths_m).filter((depth_m) => depth_m !== null).sort((a, b) => a - b);
  const cut = Math.floor(depths.length / 50);
  const truths = strip.map(({ true_m }) => true_m).filter((true_m) => true_m !== null);
  const all = [...depths.slice(cut, depths.length - cut), ...truths];
  if (!all.length) return [0, 1];
  const [least, most] = all.reduce(([a, b], m) => [Math.min(a, m), Math.max(b, m)], [Infinity, -Infinity]);
  const room = Math.max(0.002, 0.1 * (most - least));
  return [least - room, most + room];
}

function timeline({ frame, progress, held }) {
  const place = $("timeline");
  const phases = frame?.phases ?? ["Clear", "Acquire", "Drain", "Estimate"].map((name) => ({ name, cycles: null }));
  if (!place.children.length) {
    place.replaceChildren(...phases.map(({ name }) => {
      const bar = name === "Acquire" ? [html("progress", { max: 1, value: 0, "aria-label": "Shots of the present frame" })] : [];
      return html("li", name === "Acquire" ? { class: "long" } : {}, html("b", {}, name), html("span"), ...bar);
    }));
  }
  phases.forEach(({ name, cycles }, k) => {
    const item = place.children[k];
    const here = progress.phase === name;
    item.classList.toggle("here", here);
    if (here) item.setAttribute("aria-current", "step"); else item.removeAttribute("aria-current");
    const share = frame && cycles !== null ? (cycles / frame.frame_cycles) * frame.board_us : null;
    const length = cycles === null ? "" : `${cycles.toLocaleString("en")} cycles, ${share.toFixed(share < 10 ? 3 : 1)} µs`;
    const shots = name === "Acquire" && here ? ` · shot ${progress.shots.toLocaleString("en")} of ${progress.of.toLocaleString("en")}` : "";
    say(item.querySelector("span"), length + shots + (here && held && name !== "Acquire" ? " · held" : ""));
  });
  const bar = place.querySelector("progress");
  bar.value = progress.of ? progress.shots / progress.of : 0;
}
