/** The number of the slide, as a button that opens a list: there a slide is chosen to be shown now, or to be left out of the show. */

import { make } from "../dom";
import { phrase } from "../words";
import { type Chosen, offered } from "./chosen";
import { lessonNamed, titleOf } from "./lessons";
import type { LessonId } from "./protocol";

export interface OverviewHooks {
  jump(id: LessonId): void;
  choose(chosen: Chosen): void;
}

export class Overview {
  readonly button = make("button", { type: "button", class: "learn-count" });
  readonly element = make("div", { popover: "auto", class: "learn-overview" });
  readonly #hooks: OverviewHooks;
  readonly #list = make("ol");
  #at: LessonId | undefined;

  constructor(hooks: OverviewHooks) {
    this.#hooks = hooks;
    this.button.popoverTargetElement = this.element;
    const copy = make("button", { type: "button" }, phrase("overview.copy", "Copy the link"));
    copy.addEventListener("click", () => void copyAddress(copy));
    const use = phrase("overview.use", "Ticked slides are shown. The link holds the choice.");
    const every = make("button", { type: "button" }, phrase("overview.all", "All"));
    every.addEventListener("click", () => this.#tick(true));
    const none = make("button", { type: "button" }, phrase("overview.none", "None"));
    none.addEventListener("click", () => this.#tick(false));
    this.element.append(this.#list, make("p", { class: "soft" }, use), every, " ", none, " ", copy);
  }

  show(chosen: Chosen, at: LessonId): void {
    const number = `${chosen.indexOf(at) + 1} / ${chosen.length}`;
    const words = make("span", { class: "visually-hidden" }, phrase("overview", ": overview of the slides"));
    this.button.replaceChildren(number, words);
    // A tick keeps the order of the list and the focus; a slide of another show brings another list.
    const ids = offered(chosen);
    const isSame =
      this.#at === at && this.#list.childElementCount === ids.length && this.element.matches(":popover-open");
    this.#at = at;
    if (!isSame) this.#list.replaceChildren(...ids.map((id) => this.#row(id, chosen)));
  }

  #row(id: LessonId, chosen: Chosen): HTMLElement {
    const lesson = lessonNamed(id);
    const title = lesson ? titleOf(lesson) : id;
    const isNow = id === this.#at;
    const isShown = chosen.includes(id);
    const label = phrase("overview.shown", "Show {title}", { title });
    const box = make("input", { type: "checkbox", value: id, "aria-label": label, checked: isShown, disabled: isNow });
    const jump = make("button", { type: "button", disabled: !isShown }, title);
    if (isNow) jump.setAttribute("aria-current", "true");
    box.addEventListener("change", () => {
      jump.disabled = !box.checked;
      this.#hooks.choose(this.#ticked());
    });
    jump.addEventListener("click", () => {
      this.element.hidePopover();
      this.#hooks.jump(id);
    });
    return make("li", {}, box, jump);
  }

  /** Ticks all slides or none but the present one, which is always shown. */
  #tick(isShown: boolean): void {
    for (const box of this.#list.querySelectorAll("input")) {
      box.checked = isShown || box.disabled;
      const jump = box.parentElement?.querySelector("button");
      if (jump) jump.disabled = !box.checked;
    }
    this.#hooks.choose(this.#ticked());
  }

  #ticked(): Chosen {
    return [...this.#list.querySelectorAll("input")]
      .filter(({ checked }) => checked)
      .map(({ value }) => value as LessonId);
  }
}

/** In full screen there is no address bar to copy from. */
async function copyAddress(button: HTMLButtonElement): Promise<void> {
  try {
    await navigator.clipboard.writeText(location.href);
    button.textContent = phrase("copied", "Copied");
  } catch {
    button.textContent = phrase("copy.address", "Copy the address bar");
  }
  setTimeout(() => (button.textContent = phrase("overview.copy", "Copy the link")), 2000);
}
