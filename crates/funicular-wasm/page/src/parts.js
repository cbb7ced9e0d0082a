// Parts of the results that fold, and the view alone for slides: `?view=only` at the end of the address.

import { $ } from "./format.js";
import { chooseMode } from "./modes.js";
import { on, page, shown } from "./store.js";

const PHONE = "(max-width: 760px)"; // as in style.css

/** Shows which mode is in motion over the view, with the way to end it. */
function showStop() {
  const mode = page.frame?.modes[shown.mode];
  $("stop-mode").hidden = !mode;
  $("stop-mode").textContent = mode ? `Stop mode ${shown.mode + 1}` : "";
}

/** Listens to the address and to the width of the window. */
export function listen() {
  if (new URLSearchParams(location.search).get("view") === "only") {
    document.documentElement.dataset.view = "only";
    const whole = $("whole");
    const show = () => {
      whole.href = location.href.replace(/[?&]view=only/, "");
    };
    whole.hidden = false;
    whole.target = "_blank";
    show();
    addEventListener("hashchange", show);
  }
  const phone = matchMedia(PHONE);
  const fold = () => document.querySelectorAll("[data-part]").forEach((part) => (part.open = !phone.matches));
  fold();
  phone.addEventListener("change", fold);
  ["frame", "platform", "empty", "mode"].forEach((event) => on(event, showStop));
  $("stop-mode").addEventListener("click", () => chooseMode(-1));
  // A menu closes when a person presses beside it, or Escape.
  const menu = document.querySelector(".menu");
  addEventListener("pointerdown", ({ target }) => {
    if (!menu.contains(target)) {
      menu.open = false;
    }
  });
  menu.addEventListener("keydown", (event) => {
    if (event.key === "Escape" && menu.open) {
      event.preventDefault();
      menu.open = false;
      menu.querySelector("summary").focus();
    }
  });
}
