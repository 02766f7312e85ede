// The scene as sliders, and the notes.

import { $, html, say, seldom } from "./svg.js";
import { ask } from "./server.js";

// Positions of a slider whose scale is one of decades; the last is beyond all of them.
const DECADES = 100;
const held = new Map();

const send = seldom(100, () => {
  const asked = Object.fromEntries([...held].filter(([, { sent }]) => !sent).map(([key, { value }]) => [key, value]));
  for (const entry of held.values()) entry.sent = true;
  if (Object.keys(asked).length) ask("scene", asked);
});

const toPosition = (slider, value) => {
  if (!slider.zero_is_far) return value;
  return value === 0 ? DECADES : ((DECADES - 1) * Math.log(value / slider.least)) / Math.log(slider.most / slider.least);
};

const toValue = (slider, position) => {
  if (!slider.zero_is_far) return position;
  if (position >= DECADES) return 0;
  return Number((slider.least * (slider.most / slider.least) ** (position / (DECADES - 1))).toPrecision(3));
};

const words = ({ zero_is_far, unit, step }, value) => {
  if (zero_is_far && value === 0) return "clear";
  const text = zero_is_far ? String(Number(value.toPrecision(3))) : String(Number(value.toFixed(Math.max(0, Math.ceil(-Math.log10(step))))));
  return unit ? `${text} ${unit}` : text;
};

function make(slider) {
  const id = `slider-${slider.key}`;
  const [min, max, step] = slider.zero_is_far ? [0, DECADES, 1] : [slider.least, slider.most, slider.step];
  const input = html("input", { type: "range", id, min, max, step, "data-key": slider.key });
  const output = html("output", { for: id });
  input.oninput = () => {
    const value = toValue(slider, Number(input.value));
    held.set(slider.key, { value, sent: false });
    put(slider, input, output, value);
    send();
  };
  const label = html("label", { for: id }, html("span", {}, slider.label), output);
  return html("div", { class: "slider" }, label, input);
}

function put(slider, input, output, value) {
  say(output, words(slider, value));
  input.setAttribute("aria-valuetext", words(slider, value));
}

export function show(state) {
  const place = $("sliders");
  if (place.children.length !== state.scene.length) place.replaceChildren(...state.scene.map(make));
  state.scene.forEach((slider, k) => {
    const [input, output] = [place.children[k].querySelector("input"), place.children[k].querySelector("output")];
    input.disabled = Boolean(state.scene_fixed);
    const asked = held.get(slider.key);
    // What is dragged stays where it is until the server has it.
    if (asked && document.activeElement === input && asked.value !== slider.value) return;
    held.delete(slider.key);
    input.value = toPosition(slider, slider.value);
    put(slider, input, output, slider.value);
  });
  say($("scene-hint"), state.scene_fixed ? `The scene is fixed: ${state.scene_fixed}.` : state.scene_coming ? `The next ${state.array ? "image" : "frame"} is of the new scene.` : "");
  const notes = [Boolean(state.image), ...state.notes].join("\n");
  if ($("notes").dataset.notes === notes) return;
  $("notes").dataset.notes = notes;
  const none = html("li", { class: "none" }, state.array && !state.image ? "They come with the first image." : "None: the answers hold.");
  $("notes").replaceChildren(...(state.notes.length ? state.notes.map((note) => html("li", {}, note.replace(/^note: /, ""))) : [none]));
}
