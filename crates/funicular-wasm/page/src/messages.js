// The one line of messages, and texts that change in place.

import { $, element } from "./format.js";

const PATIENCE_MS = 300; // what is shorter needs no word

let error = null; // the message that is shown, if it is an error

/** Shows a message, or nothing. A note is not an error: it does not replace one, but follows it. */
export function tell(text, note = false) {
  const place = $("message");
  const shown = note && error !== null ? `${error}\n${text}` : text;
  if (!note) {
    error = text;
  }
  place.hidden = $("message-box").hidden = shown === null;
  $("message-box").classList.toggle("note", error === null);
  place.textContent = shown ?? "";
  showWhole(false);
  $("message-more").hidden = place.scrollHeight <= place.clientHeight;
}

/** Shows a message whole, or its first two lines. */
function showWhole(whole) {
  $("message-box").classList.toggle("whole", whole);
  $("message-more").setAttribute("aria-expanded", String(whole));
  $("message-more").textContent = whole ? "less" : "more";
}

/** Lets a person read a long message, and close it. */
export function listen() {
  $("message-more").addEventListener("click", () => showWhole(!$("message-box").classList.contains("whole")));
  $("message-close").addEventListener("click", () => tell(null));
}

/**
 * Says that something is computed, for how long, and how to cancel it.
 * @returns {Function} to call at the end
 */
export function busy(text, cancel) {
  const begin = performance.now();
  const clock = element("span");
  const row = element("p", {}, `${text} …`, clock, element("button", { onclick: cancel }, "Cancel"));
  const tick = () => {
    if (!row.isConnected) {
      $("busy").append(row);
    }
    put(clock, ` ${((performance.now() - begin) / 1000).toFixed(0)} s `);
  };
  const first = setTimeout(tick, PATIENCE_MS);
  const every = setInterval(tick, 1000);
  return () => {
    clearTimeout(first);
    clearInterval(every);
    row.remove();
  };
}

/** Text of an error; after a mistake in the core it says that the page has started again. */
export function textOf(fault) {
  return fault.broken ? `${fault.message}\nThe page has started again with the last robot.` : fault.message;
}

/** Puts a text in a place, which is not touched if it has it already. */
export function put(place, text) {
  if (place.textContent !== text) {
    place.textContent = text;
  }
}

/** Number of a text with a point or a comma; null if it is none. */
export function numberOf(text) {
  const number = Number(text.trim().replace(",", ".").replace("−", "-"));
  return text.trim() !== "" && Number.isFinite(number) ? number : null;
}

let refusals = 0;

/** Marks a field as wrong and says why beside it. */
export function refuse(field, text) {
  accept(field);
  refusals += 1;
  const id = `refusal-${refusals}`;
  field.setAttribute("aria-invalid", "true");
  field.setAttribute("aria-describedby", id);
  // Not within a label, whose text is the name of the field.
  (field.closest("label, .head, .combo") ?? field).after(
    element("span", { id, class: "field-message", role: "alert" }, text),
  );
}

/** Takes the mark of a field away, with its message. */
export function accept(field) {
  if (field.hasAttribute("aria-invalid")) {
    $(field.getAttribute("aria-describedby"))?.remove();
    field.removeAttribute("aria-invalid");
    field.removeAttribute("aria-describedby");
  }
}

/** Marks a part of the page as that of an earlier state, until it is computed anew. */
export const age = (place, old) => $(place).classList.toggle("stale", old);

/** Rows of a table, made once and then only filled, because a frame has no time to make them. */
export function rowsOf(table, count, make) {
  const body = $(table).tBodies[0];
  while (body.rows.length > count) {
    body.lastChild.remove();
  }
  while (body.rows.length < count) {
    body.append(make(body.rows.length));
  }
  return body.rows;
}
