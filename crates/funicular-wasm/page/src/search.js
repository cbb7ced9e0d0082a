// Search for a value of the robot file by words, as a list under a field.

import { $, element } from "./format.js";
import { accept, refuse } from "./messages.js";
import { page } from "./store.js";
import { found, labelOf } from "./units.js";

const MOST = 12; // entries of the list: more need another word

/** Makes the field for values of the robot file. `choose(path)` is told the choice. */
export function makeSearch(choose) {
  const [field, list] = [$("path"), $("paths")];
  let chosen = 0;

  const options = () => [...list.children];
  const close = () => {
    list.hidden = true;
    field.setAttribute("aria-expanded", "false");
    field.removeAttribute("aria-activedescendant");
  };
  const mark = (index) => {
    chosen = Math.max(0, Math.min(options().length - 1, index));
    options().forEach((option, i) => option.setAttribute("aria-selected", String(i === chosen)));
    const own = options()[chosen];
    field.removeAttribute("aria-activedescendant");
    if (own) {
      field.setAttribute("aria-activedescendant", own.id);
      own.scrollIntoView({ block: "nearest" });
    }
  };
  const take = (path) => {
    close();
    field.value = "";
    accept(field);
    choose(path);
  };
  const open = () => {
    const all = found(page.parameters, field.value, MOST);
    list.replaceChildren(
      ...all.map((parameter, i) =>
        element(
          "li",
          { id: `path-${i}`, role: "option", "data-path": parameter.path, title: parameter.path },
          labelOf(parameter),
        ),
      ),
    );
    list.hidden = all.length === 0;
    field.setAttribute("aria-expanded", String(!list.hidden));
    mark(0);
  };
  const enter = () => {
    const path = options()[chosen]?.dataset.path;
    if (!list.hidden && path) {
      take(path);
    } else if (field.value.trim() !== "") {
      refuse(
        field,
        `No value of this robot has “${field.value.trim()}” in its name: try “mass”, “anchor” or “length”.`,
      );
    }
  };

  field.addEventListener("input", () => {
    accept(field);
    open();
  });
  field.addEventListener("focus", open);
  field.addEventListener("blur", close);
  field.addEventListener("keydown", (event) => {
    const move = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (move) {
      event.preventDefault();
      if (list.hidden) {
        open();
      } else {
        mark(chosen + move);
      }
    } else if (event.key === "Enter") {
      event.preventDefault();
      enter();
    } else if (event.key === "Escape" && !list.hidden) {
      event.preventDefault();
      close();
    }
  });
  // The field keeps the focus while an entry is pressed.
  list.addEventListener("pointerdown", (event) => event.preventDefault());
  list.addEventListener("click", ({ target }) => {
    const path = target.closest("[data-path]")?.dataset.path;
    if (path) {
      take(path);
    }
  });
}
