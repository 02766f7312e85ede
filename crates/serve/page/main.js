// Puts the parts of the page together.

import { $, say, seldom } from "./svg.js";
import { follow } from "./server.js";
import * as controls from "./controls.js";
import * as histogram from "./histogram.js";
import * as ila from "./ila.js";
import * as image from "./image.js";
import * as scene from "./scene.js";
import * as shot from "./shot.js";
import * as strip from "./strip.js";

const ofPixel = [controls, histogram, scene, strip, ila, shot];
const ofArray = [controls, scene, image];
let newest = null;

// What is read out: what has changed, not every frame.
const announce = (state) => {
  const run = state.fault ? `fault: ${state.fault}` : state.running ? state.held ?? "running" : "stopped";
  const notes = state.notes.length ? `${state.notes.length} notes` : "no notes";
  const laser = state.control ? `laser ${state.control.laser_en ? "on" : "off"}; ` : "";
  say($("announce"), `${run}; ${laser}${notes}`);
};

const announceSeldom = seldom(1000, announce);

function show(state) {
  newest = state;
  for (const part of state.array ? ofArray : ofPixel) part.show(state);
  announceSeldom(state);
  document.documentElement.dataset.version = state.version;
}

for (const part of new Set([...ofPixel, ...ofArray])) part.setUp?.();
const redraw = seldom(100, () => {
  if (newest) show(newest);
  for (const part of newest?.array ? ofArray : ofPixel) part.redraw?.();
});
addEventListener("resize", redraw);
follow(show);
