// The acquisition computer's signals, start and stop, and the keys for them.

import { $, html, say } from "./svg.js";
import { ask } from "./server.js";
import { choose } from "./image.js";

const SWITCHES = ["laser_en", "dsp_en", "dsp_rst"];
let state = null;

const flip = (name) => ask("control", { [name]: !state.control[name] });
const start = () => ask("run", { running: !state.running });
const oneFrame = () => ask("run", { frames: 1 });
const pulse = () => ask("control", { pulse_dsp_rst: true });

export function setUp() {
  for (const name of SWITCHES) $(name).onclick = () => state && flip(name);
  $("laser_freq").onchange = () => ask("control", { laser_freq: Number($("laser_freq").value) });
  $("mode").onchange = () => ask("control", { mode: Number($("mode").value) });
  $("start").onclick = () => state && start();
  $("one-frame").onclick = oneFrame;
  $("pulse").onclick = pulse;
  $("power-up").onclick = () => ask("run", { power_up: true });
  $("help-button").onclick = () => $("help").showModal();
  document.addEventListener("keydown", key);
}

function key(event) {
  const field = event.target.closest("input:not([type=range]), textarea, dialog, [data-keys]");
  if (!state || field || event.ctrlKey || event.metaKey || event.altKey) return;
  const is = event.key.toLowerCase();
  // A list takes digits itself.
  if (/[0-9]/.test(is) && event.target.closest("select")) return;
  // A pressed button takes the space bar itself.
  if (is === " " && event.target.closest("button, a, summary")) return;
  const rate = Number(is) - 1;
  const ofBoth = { " ": start, n: oneFrame, "?": () => $("help").showModal() };
  const ofArray = { d: () => choose("depth"), s: () => choose("sigma"), h: () => choose("hits") };
  const ofPixel = {
    r: pulse,
    l: () => flip("laser_en"), e: () => flip("dsp_en"),
    m: () => ask("control", { mode: 1 - state.control.mode }),
    a: () => $("ila-form").requestSubmit(), w: () => $("shot-draw").click(),
  };
  const ofRate = is !== "0" && is !== " " && state.rates?.[rate] ? () => ask("control", { laser_freq: rate }) : null;
  const act = ofBoth[is] ?? (state.array ? ofArray[is] : ofPixel[is] ?? ofRate);
  if (!act) return;
  event.preventDefault();
  act();
}

export function show(next) {
  const first = !state;
  state = next;
  say($("start"), state.running ? "Stop" : "Start");
  $("run-state").classList.toggle("on", state.running && !state.held);
  say($("run-state"), state.fault ? "fault" : !state.running ? "stopped" : state.held ? "held" : "running");
  say($("held"), state.fault ?? state.held ?? state.laser_fixed ?? "");
  const size = state.array ? `, ${state.array.rows} × ${state.array.columns} pixels, ${state.estimator}` : "";
  const origin = state.board ? `board at ${state.board}` : `seed ${state.seed}, fidelity ${state.fidelity}${size}`;
  say($("about"), `scenario ${state.scenario}, ${origin}`);
  document.body.classList.toggle("of-board", Boolean(state.board));
  document.body.classList.toggle("of-array", Boolean(state.array));
  if (!state.array) showSignals(first);
}

function showSignals(first) {
  const { control, rates, time, progress } = state;
  if (first || $("laser_freq").options.length !== rates.length) {
    const option = ({ mhz, cycles }, code) => html("option", { value: code }, `${code}: ${mhz.toFixed(3)} MHz, ${cycles} cycles`);
    $("laser_freq").replaceChildren(...rates.map(option));
  }
  for (const name of SWITCHES) $(name).setAttribute("aria-checked", control[name]);
  $("laser_en").disabled = Boolean(state.laser_fixed);
  if (document.activeElement !== $("laser_freq")) $("laser_freq").value = control.laser_freq;
  if (document.activeElement !== $("mode")) $("mode").value = control.mode;
  say($("time-here-name"), state.board ? "taken in" : "simulated in");
  say($("time-board"), seconds(time.board_s));
  say($("time-here"), seconds(time.here_s));
  say($("time-slower"), time.board_s > 0 ? (time.here_s / time.board_s).toFixed(1) : "–");
  say($("time-rate"), time.frames_per_s ? time.frames_per_s.toFixed(1) : "–");
  say($("time-board-rate"), time.board_frames_per_s.toFixed(1));
  say($("time-frames"), String(time.frames));
  say($("time-abandoned"), String(progress.abandoned));
}

function seconds(value) {
  return value < 1 ? `${(1e3 * value).toFixed(2)} ms` : value < 100 ? `${value.toFixed(3)} s` : `${value.toFixed(1)} s`;
}
