// The one line of messages, and texts that change in place.

import { $ } from "./format.js";

/** Shows a message, or nothing. A note is not an error. */
export function tell(text, note = false) {
  const place = $("message");
  place.hidden = text === null;
  place.classList.toggle("note", note);
  place.textContent = text ?? "";
}

/** Text of an error; after a mistake in the core it says that the page has started again. */
export function textOf(error) {
  return error.broken ? `${error.message}\nThe page has started again with the last robot.` : error.message;
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

/** Marks a field as wrong and says why. */
export function refuse(field, text) {
  field.setAttribute("aria-invalid", "true");
  tell(text);
}

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
