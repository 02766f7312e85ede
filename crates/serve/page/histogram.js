// The last frame's histogram by cause, with the depths in it, and the table of depths.

import { $, html, plot, say, svg } from "./svg.js";

const LABELS = { signal: "signal", ambient: "ambient light", dark: "dark counts", afterpulse: "afterpulses", cover: "cover window", unknown: "hits" };
const LAST = 50;
let drawn = null;

export function show(state) {
  const { frame } = state;
  const seen = `${frame?.index} ${frame?.depth_raw} ${state.time.board_s} ${$("histogram").clientWidth}`;
  if (seen === drawn) return;
  drawn = seen;
  if (!frame) {
    $("histogram").replaceChildren();
    $("legend").replaceChildren();
    $("depths").tBodies[0].replaceChildren();
    return say($("frame-facts"), "No frame has ended yet.");
  }
  draw(state, frame);
  legend(frame);
  table(state, frame);
  const causes = frame.causes_seen ? "" : " Causes are what is to be expected.";
  const laser = frame.laser_en ? "laser on" : "laser off";
  say($("frame-facts"), `Frame ${frame.index}: ${frame.shots} shots, ${laser}, ${frame.hits} hits with a code of ${frame.tdc_hits}. Depth word ${frame.depth_raw}.${causes}`);
}

function draw({ bins }, frame) {
  const far = bins.first_m + bins.count * bins.bin_m;
  const sums = new Array(bins.count).fill(0);
  for (const { counts } of frame.layers) counts.forEach((count, bin) => { sums[bin] += count; });
  const most = Math.max(10, ...sums) * 1.1;
  const place = $("histogram");
  const { root, x, y, under, top } = plot(place, [bins.first_m, far], [0, most], { xLabel: "m", yLabel: "hits a bin" });
  const below = new Array(bins.count).fill(0);
  for (const { cause, counts } of frame.layers) {
    const edge = (level) => level.map((count, bin) => [x(bins.first_m + bin * bins.bin_m), x(bins.first_m + (bin + 1) * bins.bin_m), y(count).toFixed(1)]);
    const low = edge(below);
    counts.forEach((count, bin) => { below[bin] += count; });
    const up = edge(below).map(([from, to, at]) => `${from.toFixed(1)} ${at}L${to.toFixed(1)} ${at}`).join("L");
    const down = low.reverse().map(([from, to, at]) => `${to.toFixed(1)} ${at}L${from.toFixed(1)} ${at}`).join("L");
    root.append(svg("path", { class: `area ${cause}`, d: `M${up}L${down}Z` }));
  }
  for (const [name, depth_m] of depthsOf(frame)) {
    if (depth_m === null || depth_m < bins.first_m || depth_m > far) continue;
    root.append(svg("line", { class: `line ${name}`, x1: x(depth_m), x2: x(depth_m), y1: top, y2: under }));
  }
  const own = frame.depths.find((depth) => depth.in_socket);
  const truth = frame.true_m === null ? "" : `, true distance ${frame.true_m.toFixed(3)} m`;
  root.setAttribute("aria-label", `Histogram of frame ${frame.index}: ${frame.hits} hits, ${own.estimator} depth ${own.depth_m?.toFixed(4)} m${truth}`);
  place.replaceChildren(root);
}

const depthsOf = (frame) => [["true", frame.true_m], ...frame.depths.map(({ estimator, depth_m }) => [estimator, depth_m])];

function legend(frame) {
  const causes = [...frame.layers].reverse().map(({ cause }) => [`area ${cause}`, LABELS[cause] ?? cause]);
  const lines = depthsOf(frame).map(([name]) => [`line ${name}`, name]);
  const names = [...causes, ...lines].map(([, label]) => label).join();
  if ($("legend").dataset.names === names) return;
  $("legend").dataset.names = names;
  const entry = ([style, label]) => {
    const shape = style.startsWith("area") ? svg("rect", { class: style, width: 22, height: 12 }) : svg("line", { class: style, x1: 0, x2: 22, y1: 6, y2: 6 });
    return html("li", {}, svg("svg", { "aria-hidden": "true", viewBox: "0 0 22 12" }, shape), label);
  };
  $("legend").replaceChildren(...[...causes, ...lines].map(entry));
}

// Twice the standard deviation of the last depths of one scene [mm].
function spread(strip, which) {
  const last = strip.at(-1);
  const alike = [];
  for (let k = strip.length - 1; k >= 0 && alike.length < LAST; k--) {
    const point = strip[k];
    if (point.true_m !== last.true_m || point.bound_two_sd_mm !== last.bound_two_sd_mm) break;
    if (point.depths_m[which] !== null) alike.push(point.depths_m[which]);
  }
  if (alike.length < 10) return null;
  const mean = alike.reduce((sum, depth) => sum + depth, 0) / alike.length;
  return 2e3 * Math.sqrt(alike.reduce((sum, depth) => sum + (depth - mean) ** 2, 0) / (alike.length - 1));
}

function table({ strip }, frame) {
  const row = (name, ...cells) => html("tr", {}, html("th", { scope: "row" }, name), ...cells.map((cell) => (cell instanceof Node ? cell : html("td", {}, cell))));
  const bound = frame.bound_two_sd_mm;
  const rows = [row("true distance", frame.true_m === null ? "none" : frame.true_m.toFixed(4), "", bound === null ? "" : bound.toFixed(2), bound === null ? "" : "bound")];
  frame.depths.forEach(({ estimator, in_socket, depth_m, failure }, which) => {
    const name = in_socket ? html("span", {}, `${estimator} `, html("small", {}, "in the firmware")) : estimator;
    if (depth_m === null) return rows.push(row(name, html("td", { class: "why", colspan: 4 }, failure || "no depth")));
    const error = frame.true_m === null ? "" : (1e3 * (depth_m - frame.true_m)).toFixed(2).replace("-", "−");
    const sd = frame.true_m === null ? null : spread(strip, which);
    rows.push(row(name, depth_m.toFixed(4), error, sd === null ? "" : sd.toFixed(2), sd === null || !bound ? "" : `${(sd / bound).toFixed(2)} ×`));
  });
  $("depths").tBodies[0].replaceChildren(...rows);
}
