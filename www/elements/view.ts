/** What `<bimodal-stereo>` shows in its shadow: three pictures, a status line and two buttons. */

import type { StepReport } from "../../pkg/index.js";
import type { Panel } from "../learn/protocol";
import { PICTURES, type PictureName, type Pictures } from "./protocol";
import style from "./stereo.css?inline";

const TITLES: Record<PictureName, string> = { image: "Image", surface: "Normals", light: "Light" };
const ALTS: Record<PictureName, string> = {
  image: "The colour image",
  surface: "Normals of the surface in the image, as colours",
  light: "A ball under the estimated light",
};

interface Hooks {
  toggle(): void;
  step(): void;
  restart(): void;
}

/** Like `make` of the page's dom.ts, which cannot be used here because it needs a document when it is loaded. */
function made<K extends keyof HTMLElementTagNameMap>(tag: K, content = "", attributes: Record<string, string> = {}) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.textContent = content;
  return element;
}

export class StereoView {
  readonly #status = made("p", "", { role: "status", part: "status" });
  readonly #play = made("button", "Pause", { type: "button", part: "button" });
  readonly #step = made("button", "Step", { type: "button", part: "button" });
  readonly #again = made("button", "Restart", { type: "button", part: "button" });
  readonly #canvases = new Map<PictureName, HTMLCanvasElement>();
  readonly #charts = made("div", "", { part: "charts", hidden: "" });
  /** Draws the charts, once their code has loaded. */
  #chartsShown: Promise<(panels: Panel[]) => void> | undefined;

  constructor(root: ShadowRoot, hooks: Hooks) {
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(style);
    root.adoptedStyleSheets = [sheet];
    const pictures = made("div", "", { class: "pictures", part: "pictures" });
    for (const name of PICTURES) {
      const canvas = made("canvas", "", { role: "img", "aria-label": ALTS[name], part: name });
      this.#canvases.set(name, canvas);
      const figure = made("figure");
      figure.append(made("figcaption", TITLES[name]), canvas);
      pictures.append(figure);
    }
    this.#play.addEventListener("click", () => hooks.toggle());
    this.#step.addEventListener("click", () => hooks.step());
    this.#again.addEventListener("click", () => hooks.restart());
    const buttons = made("div", "", { class: "buttons" });
    buttons.append(this.#play, this.#step, this.#again);
    root.append(pictures, this.#charts, this.#status, buttons);
  }

  clear(paused: boolean): void {
    for (const canvas of this.#canvases.values()) canvas.width = canvas.height = 1;
    this.showPaused(paused);
    this.#allow(true);
    this.say("loading");
  }

  showCharts(areShown: boolean): void {
    this.#charts.hidden = !areShown;
  }

  /** A failed load is tried again with the next step; the run itself does not need the charts. */
  drawCharts(panels: Panel[]): void {
    this.#chartsShown ??= import("./charts").then(({ chartsIn }) => chartsIn(this.#charts));
    this.#chartsShown.then(
      (draw) => draw(panels),
      () => (this.#chartsShown = undefined),
    );
  }

  showPaused(paused: boolean): void {
    this.#play.textContent = paused ? "Play" : "Pause";
  }

  say(words: string): void {
    this.#status.textContent = words;
    this.#status.classList.remove("wrong");
  }

  complain(words: string): void {
    this.say(words);
    this.#status.classList.add("wrong");
    this.#allow(false);
  }

  draw(pictures: Pictures): void {
    for (const name of PICTURES) {
      const bitmap = pictures[name];
      const canvas = this.#canvases.get(name);
      if (!bitmap || !canvas) continue;
      [canvas.width, canvas.height] = [bitmap.width, bitmap.height];
      canvas.getContext("bitmaprenderer")?.transferFromImageBitmap(bitmap);
    }
  }

  show({ status, stage, iteration, message, pose: { scale, angles } }: StepReport): void {
    const { alpha, beta, gamma } = angles;
    const at = status === "running" ? `${stage} ${iteration}` : `${iteration} iterations`;
    const [a, b, c] = [alpha, beta, gamma].map((value) => value.toFixed(2));
    this.say(`${status} (${at}): α ${a}°, β ${b}°, γ ${c}°, s ${scale.toFixed(4)}${message ? ` · ${message}` : ""}`);
    this.#allow(status === "running");
  }

  /** A button that can do nothing is off. */
  #allow(isRunning: boolean): void {
    this.#play.disabled = this.#step.disabled = !isRunning;
  }
}
