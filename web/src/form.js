// Form fields. Each shows the value of a key of the case, and sets it.

import { parsed, shown } from "./case.js";

/** Returns a labelled field of a key. With `choices`, a list of [word, title], it is a menu. */
export function field(key, label, { choices, placeholder = "" } = {}) {
  const input = choices
    ? element("select", { "data-key": key }, ...choices.map(([word, title]) => element("option", { value: word }, title)))
    : element("input", { type: "text", "data-key": key, placeholder, autocomplete: "off", spellcheck: "false" });
  return element("label", {}, label, input);
}

/** Connects all fields with the case. */
export function bind(kase) {
  document.addEventListener("change", ({ target }) => {
    if (target.dataset.key) kase.set(target.dataset.key, parsed(target.value));
  });
  kase.addEventListener("change", () => {
    unmark();
    refill(kase, document);
  });
}

/** Shows the values of the case in the fields of an element. */
export function refill(kase, place) {
  for (const input of place.querySelectorAll("[data-key]")) {
    const text = shown(kase.get(input.dataset.key));
    if (input.value !== text) input.value = text;
    // The case file may have a word that the menu lacks.
    if (input.value !== text && input.matches("select")) {
      input.append(element("option", { value: text }, text));
      input.value = text;
    }
  }
}

/** Returns the field of the key that a failure names, if there is one. */
function fieldOf({ key }) {
  return key ? document.querySelector(`[data-key="${CSS.escape(key)}"]`) : null;
}

/** Marks the field of the key that a failure names. */
export function mark(failure) {
  fieldOf(failure)?.setAttribute("aria-invalid", "true");
}

function unmark() {
  document.querySelectorAll("[aria-invalid]").forEach((input) => input.removeAttribute("aria-invalid"));
}

/** Shows sentences and failures in a place. Without any, the place becomes empty. */
export function say(place, sentences = [], actions = []) {
  const lines = sentences.map((each) => (typeof each === "string" ? each : told(each)));
  const buttons = actions.map(([title, act]) => element("button", { type: "button", onclick: act }, title));
  place.replaceChildren(...lines.map((line) => element("p", {}, ...coded(line))), ...(buttons.length ? [element("div", { class: "controls" }, ...buttons)] : []));
}

/** Returns the text of a failure, with its line if no field of the page shows the place. */
function told(failure) {
  const { message, hint, line } = failure;
  const place = line && !fieldOf(failure) ? ` (line ${line} of the case file)` : "";
  return [message + place, hint].filter(Boolean).map(sentenced).join(" ");
}

function sentenced(text) {
  const whole = text.charAt(0).toUpperCase() + text.slice(1);
  return /[.!?:)]$/.test(whole) ? whole : `${whole}.`;
}

/** Returns the parts of a text; parts between backticks are elements of code. */
export function coded(text) {
  const parts = text.split("`");
  return parts.length % 2 === 0 ? [text] : parts.map((part, n) => (n % 2 ? element("code", {}, part) : part));
}
