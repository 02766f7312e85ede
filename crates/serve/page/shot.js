// The waveform of the last frame's last shot.

import { $, digits, seldom } from "./svg.js";
import { text } from "./server.js";
import { save } from "./picture.js";
import { readVcd, view } from "./waves.js";

// In the order in which a shot goes through them.
const ORDER = ["clk_sys", "pre_start", "spad_rst", "laser_on", "start", "tdc_stop", "tdc.coarse_counter.window", "tdc.coarse_counter.coarse",
  "tdc.tdc_latch.hit", "tdc.tdc_latch.hit_coarse", "tdc.tdc_decoder.n_valid", "tdc.tdc_decoder.n", "tdc_valid", "tdc_code"];
// Shown at first, from the laser edge on [ps].
const SHOWN = 150e3;
let [drawn, busy, picture] = [null, false, null];

async function draw({ quiet = false } = {}) {
  if (busy) return;
  busy = true;
  const found = await text("shot.vcd?signals=view", { quiet });
  busy = false;
  if (found === null) return;
  const { signals, end } = readVcd(found);
  const place = ({ name }) => (ORDER.includes(name) ? ORDER.indexOf(name) : ORDER.length);
  signals.sort((one, other) => place(one) - place(other));
  const named = (name) => signals.find((signal) => signal.name === name);
  const known = signals.flatMap(({ changes }) => changes.map(([time]) => time)).filter((time) => time > 0);
  const from = known.reduce((least, time) => Math.min(least, time), Infinity);
  const laser = named("laser_on")?.changes.find(([time, value]) => time > 0 && value === 1n)?.[0] ?? null;
  const zero = laser ?? from;
  const hit = named("tdc_valid")?.changes.some(([time, value]) => time > from && value === 1n);
  picture = view($("shot-waves"), {
    signals, from, to: end, zero, mark: laser, unit: "ns",
    label: `Waveform of the last shot, ${((end - from) / 1e3).toFixed(0)} ns; ${hit ? "with" : "without"} a code`,
    axis: (time, step) => digits((time - zero) / 1e3, step / 1e3),
  });
  $("shot-svg").disabled = false;
  if (end - from > 2 * SHOWN) picture.move(from, SHOWN);
}

export function setUp() {
  $("shot-draw").onclick = () => draw();
  $("shot-svg").onclick = () => save($("shot-waves").querySelector("svg"), "shot.svg");
}

const follow = seldom(2000, () => draw({ quiet: true }));

export function show(state) {
  const frame = state.frame ? `${state.frame.index} ${state.time.frames < 1}` : null;
  if (frame === null || frame === drawn || !$("shot-follow").checked || document.hidden) return;
  // Who looks into it closely is not disturbed.
  if ($("shot-waves").contains(document.activeElement)) return;
  drawn = frame;
  follow();
}

export const redraw = () => picture?.draw();
