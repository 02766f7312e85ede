// What the server tells, and what it is asked for. All addresses are below the page's own, which has the token.

import { $ } from "./svg.js";

// Shows what is wrong, until something goes right.
export function complain(text) {
  $("alert").hidden = !text;
  if (text) $("alert").textContent = text;
}

export async function ask(what, request) {
  try {
    const answer = await fetch(what, { method: "POST", body: JSON.stringify(request), headers: { "content-type": "application/json" } });
    const found = await answer.json().catch(() => ({ error: `the server answers ${answer.status}` }));
    complain(answer.ok ? "" : found.error);
    return answer.ok ? found : null;
  } catch {
    complain("The server does not answer.");
    return null;
  }
}

// A file as text; null, with a complaint or without, if there is none.
export async function text(path, { quiet = false } = {}) {
  const answer = await fetch(path).catch(() => null);
  if (answer?.ok) return answer.text();
  if (!quiet) complain(answer ? (await answer.json().catch(() => ({}))).error ?? `the server answers ${answer.status}` : "The server does not answer.");
  return null;
}

// Calls with each state, the newest only.
export function follow(show) {
  let [waiting, newest] = [false, 0];
  const events = new EventSource("events");
  events.onmessage = ({ data }) => {
    const state = JSON.parse(data);
    if (state.version < newest) return;
    newest = state.version;
    if (waiting) return void (waiting = state);
    waiting = state;
    requestAnimationFrame(() => {
      const latest = waiting;
      waiting = false;
      show(latest);
    });
  };
  events.onopen = () => { newest = 0; complain(""); };
  events.onerror = () => complain("The connection to tofsim serve is lost.");
}
