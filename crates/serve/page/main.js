// Puts the parts of the page together.

import { $, say, seldom } from "./svg.js";
import { follow } from "./server.js";
import * as controls from "./controls.js";
import * as histogram from "./histogram.js";
import * as ila from "./ila.js";
import * as scene from "./scene.js";
import * as shot from "./shot.js";
import * as strip from "./strip.js";

const parts = [controls, histogram, scene, strip, ila, shot];
let newest = null;

// What is read out: what has changed, not every frame.
const announce = (state) => {
  const run = state.fault ? `fault: ${state.fault}` : state.running ? state.held ?? "running" : "stopped";
  const notes = state.notes.length ? `${state.notes.length} notes` : "no notes";
  say($("announce"), `${run}; laser ${state.control.laser_en ? "on" : "off"}; ${notes}`);
};

const announceSeldom = seldom(1000, announce);

function show(state) {
  newest = state;
  for (const part of parts) part.show(state);
  announceSeldom(state);
  document.documentElement.dataset.version = state.version;
}

for (const part of parts) part.setUp?.();
const redraw = seldom(100, () => {
  if (newest) show(newest);
  for (const part of parts) part.redraw?.();
});
addEventListener("resize", redraw);
follow(show);
