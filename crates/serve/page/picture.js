// A picture of the page as a file of its own, which needs no style sheet.

import { html, svg } from "./svg.js";

const LOOKS = ["fill", "stroke", "stroke-width", "font-family", "font-size", "text-anchor"];

// An SVG as it is shown, with its colours and its background.
function standalone(shown) {
  const copy = shown.cloneNode(true);
  const copies = copy.querySelectorAll("*");
  shown.querySelectorAll("*").forEach((element, k) => {
    const look = getComputedStyle(element);
    for (const name of LOOKS) copies[k].setAttribute(name, look.getPropertyValue(name));
    copies[k].removeAttribute("class");
  });
  const { width, height } = shown.viewBox.baseVal;
  copy.setAttribute("width", width);
  copy.setAttribute("height", height);
  copy.prepend(svg("rect", { width, height, fill: getComputedStyle(document.body).backgroundColor }));
  return new XMLSerializer().serializeToString(copy);
}

// Saves an SVG of the page under that name.
export function save(shown, name) {
  const address = URL.createObjectURL(new Blob([standalone(shown)], { type: "image/svg+xml" }));
  html("a", { href: address, download: name }).click();
  // The browser has taken it up by then.
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}
