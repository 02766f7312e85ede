// The logic analyser: set-up, trigger, and the window that it has captured.

import { $, digits, html, say } from "./svg.js";
import { ask, text } from "./server.js";
import { readCsv, view } from "./waves.js";

// Samples about the trigger that are shown at first.
const SHOWN = 100;
let [drawn, picture] = [0, null];

export function setUp() {
  for (let depth = 1024; depth <= 131072; depth *= 2) $("ila-depth").append(html("option", { value: depth }, depth.toLocaleString("en")));
  $("ila-form").onsubmit = (event) => {
    event.preventDefault();
    const request = { arm: true };
    const own = $("ila-text").value.trim();
    if (own) request.text = own; else request.set_up = $("ila-set-up").value;
    for (const name of ["trigger", "clock"]) if ($(`ila-${name}`).value.trim()) request[name] = $(`ila-${name}`).value.trim();
    for (const name of ["depth", "windows", "position"]) if ($(`ila-${name}`).value) request[name] = Number($(`ila-${name}`).value);
    ask("ila", request);
  };
  $("ila-disarm").onclick = () => ask("ila", { arm: false });
}

export function show(state) {
  const { status, armed, capture } = state.ila;
  if (!$("ila-set-up").options.length) $("ila-set-up").replaceChildren(...state.set_ups.map(({ name }) => html("option", {}, name)));
  const chosen = state.set_ups.find(({ name }) => name === $("ila-set-up").value);
  if (chosen) {
    $("ila-set-up").title = chosen.description;
    $("ila-trigger").placeholder = chosen.trigger ?? "any sample";
    $("ila-clock").placeholder = chosen.clock;
    say($("ila-depth").options[0], chosen.depth.toLocaleString("en"));
  }
  $("ila-disarm").disabled = status !== "armed";
  if (status === "armed") {
    const waits = armed.trigger ? `waits for ${armed.trigger}` : "takes any sample";
    const still = state.running ? "" : "; the run is stopped";
    say($("ila-status"), `${armed.name} is armed and ${waits}: ${armed.triggers} of ${armed.windows} windows${still}`);
  } else if (capture) {
    const times = capture.trigger_times_us.slice(0, 4).join(", ");
    say($("ila-status"), `${capture.name} has triggered at ${times} µs`);
  } else {
    say($("ila-status"), "Not armed.");
  }
  if (capture && capture.number !== drawn) {
    drawn = capture.number;
    load(capture);
  }
}

async function load(capture) {
  const found = await text("ila.csv");
  if (found === null) return;
  const { signals, end } = readCsv(found, capture.probes, capture.windows[0], capture.depth);
  const label = `Capture ${capture.name}: ${capture.probes.length} probes, ${end} samples of ${capture.clock}, trigger at sample ${capture.position}`;
  picture = view($("ila-waves"), {
    signals, from: 0, to: end, zero: capture.position, mark: capture.position, label, unit: "sample",
    axis: (sample, step) => digits(sample - capture.position, Math.max(step, 1)),
  });
  picture.move(capture.position - SHOWN / 2, SHOWN);
  $("ila-files").hidden = false;
  $("ila-command").hidden = false;
  const same = capture.exact ? "makes the same files of the run as a scenario" : "would make the same files of a run whose scene had not changed since power-up";
  say($("ila-command"), `# ${same}\n${capture.command}`);
}

export const redraw = () => picture?.draw();
