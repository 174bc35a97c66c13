/** The HTML that shows a lesson's figure with its present settings in another page. Such a frame has a link to the lesson. */

import { make } from "../dom";

/** Pixels of the frame; a figure that is higher scrolls in it. */
const [WIDTH, HEIGHT] = [800, 720];

export class Embed {
  readonly button = make("button", { type: "button", class: "learn-embed-button", "aria-expanded": "false" }, "Embed");
  readonly element: HTMLElement;
  readonly source: HTMLElement;
  readonly #line = make("input", { type: "text", readonly: true });
  readonly #link = make("a", { target: "_blank", rel: "noopener" });
  readonly #title: string;

  constructor(title: string) {
    this.#title = title;
    const copy = make("button", { type: "button" }, "Copy");
    copy.addEventListener("click", () => void this.#copy(copy));
    this.#link.append(`${title}: text and exercises`);
    this.source = make("p", { class: "learn-source" }, this.#link);
    this.element = make(
      "div",
      { class: "learn-embed", hidden: true },
      make("label", {}, "HTML that shows the figure with its present settings in another page", this.#line),
      copy,
    );
    this.button.addEventListener("click", () => {
      this.element.hidden = !this.element.hidden;
      this.button.setAttribute("aria-expanded", String(!this.element.hidden));
      if (!this.element.hidden) this.#line.select();
    });
  }

  /** The figure's state as an address. */
  show(hash: string): void {
    const url = new URL(location.href);
    url.hash = hash;
    this.#link.href = hash;
    // Written by the browser, so that no content can end an attribute.
    this.#line.value = make("iframe", {
      src: `${url.href}&embed`,
      title: this.#title,
      width: WIDTH,
      height: HEIGHT,
      loading: "lazy",
    }).outerHTML;
  }

  async #copy(button: HTMLButtonElement): Promise<void> {
    try {
      await navigator.clipboard.writeText(this.#line.value);
      button.textContent = "Copied";
    } catch {
      this.#line.select();
      button.textContent = "Press Ctrl+C";
    }
    setTimeout(() => (button.textContent = "Copy"), 2000);
  }
}
