/** The HTML that shows a lesson's figure with its present settings in another page. Such a frame has a link to the lesson. */

import { make } from "../dom";
import { phrase } from "../words";

/** Pixels of the frame, in which each lesson fits: tests/page/learn-layout.spec.ts. */
const WIDTH = 800;
const HEIGHT = { withPlot: 1060, withoutPlot: 760 };

export class Embed {
  readonly button = make(
    "button",
    { type: "button", class: "learn-embed-button", "aria-expanded": "false" },
    phrase("embed", "Embed"),
  );
  readonly element: HTMLElement;
  readonly source: HTMLElement;
  readonly #line = make("input", { type: "text", readonly: true });
  readonly #link = make("a", { target: "_blank", rel: "noopener" });
  /** Never a part of the page, which would load it. */
  readonly #frame: HTMLIFrameElement;

  constructor(title: string) {
    this.#frame = make("iframe", { src: "", title, width: WIDTH, height: HEIGHT.withPlot, loading: "lazy" });
    const copy = make("button", { type: "button" }, phrase("copy", "Copy"));
    copy.addEventListener("click", () => void this.#copy(copy));
    this.#link.append(phrase("embed.source", "{title}: text and exercises", { title }));
    this.source = make("p", { class: "learn-source" }, this.#link);
    this.element = make(
      "div",
      { class: "learn-embed", hidden: true },
      make(
        "label",
        {},
        phrase("embed.line", "HTML that shows the figure with its present settings in another page"),
        this.#line,
      ),
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
    this.#frame.src = `${url.href}&embed`;
    this.#write();
  }

  /** A plot is below the pictures. */
  fit(hasPlot: boolean): void {
    this.#frame.height = String(hasPlot ? HEIGHT.withPlot : HEIGHT.withoutPlot);
    this.#write();
  }

  /** Written by the browser, so that no content can end an attribute. */
  #write(): void {
    this.#line.value = this.#frame.outerHTML;
  }

  async #copy(button: HTMLButtonElement): Promise<void> {
    try {
      await navigator.clipboard.writeText(this.#line.value);
      button.textContent = phrase("copied", "Copied");
    } catch {
      this.#line.select();
      button.textContent = phrase("copy.keys", "Press Ctrl+C");
    }
    setTimeout(() => (button.textContent = phrase("copy", "Copy")), 2000);
  }
}
