/** Points of both surfaces, seen from an angle set by a slider. */

import { freshId, ink, make } from "../dom";
import { phrase } from "../words";
import { placed } from "./frames";
import type { CloudPanel, Panel } from "./protocol";

const SIDE = 320;
/** Side of a point on the canvas, which is shown at half its size; smaller points are hardly visible on a dark background. */
const POINT = 3.5;
/** The initial viewpoint: half way between front and side, so that depth is visible. */
const FIRST_TURN = 50;

export class Cloud {
  readonly element: HTMLElement;
  readonly #title = make("figcaption", {});
  readonly #canvas = make("canvas", { width: SIDE, height: SIDE, role: "img" });
  readonly #turn: HTMLInputElement;
  readonly #legend = make("p", { class: "learn-legend learn-keys" });
  #panel: CloudPanel | undefined;

  constructor() {
    const id = freshId("learn-turn");
    this.#turn = make("input", { id, type: "range", min: -90, max: 90, step: 1, value: FIRST_TURN });
    this.#turn.addEventListener("input", () => this.#draw());
    this.#byHand();
    const turn = make(
      "div",
      { class: "learn-turn" },
      make("label", { for: id }, phrase("rotate", "Rotate the view")),
      this.#turn,
    );
    this.element = make(
      "figure",
      { class: "learn-panel" },
      this.#title,
      placed(make("div", { class: "learn-canvas plain learn-turned" }, this.#canvas)),
      make("div", { class: "learn-notes" }, turn, this.#legend),
    );
  }

  show(panel: Panel): void {
    if (panel.kind !== "cloud") return;
    this.element.dataset.panel = panel.key;
    this.#panel = panel;
    this.#title.textContent = panel.title;
    this.#canvas.setAttribute("aria-label", panel.alt);
    this.#legend.replaceChildren(
      ...panel.sets.map(({ name, ink }) => make("span", { class: `learn-key learn-ink-${ink}` }, name)),
    );
    this.#draw();
  }

  /** A drag across the whole picture is the whole range of the slider. */
  #byHand(): void {
    this.#canvas.addEventListener("pointerdown", (event) => {
      if (event.button === 0) this.#canvas.setPointerCapture(event.pointerId);
    });
    this.#canvas.addEventListener("pointermove", ({ pointerId, movementX }) => {
      if (!this.#canvas.hasPointerCapture(pointerId)) return;
      this.#turn.valueAsNumber += (180 * movementX) / this.#canvas.clientWidth;
      this.#draw();
    });
  }

  #draw(): void {
    const context = this.#canvas.getContext("2d");
    const panel = this.#panel;
    if (!context || !panel) return;
    context.clearRect(0, 0, SIDE, SIDE);
    const { middle, reach } = extent(panel.sets.map(({ points }) => points));
    const angle = (this.#turn.valueAsNumber * Math.PI) / 180;
    const [c, s] = [Math.cos(angle), Math.sin(angle)];
    const scale = (0.46 * SIDE) / reach;
    for (const { ink: name, points } of panel.sets) {
      context.fillStyle = ink(`learn-${name}`);
      context.globalAlpha = 0.75;
      for (let at = 0; at < points.length; at += 3) {
        const [x, y, z] = [0, 1, 2].map((axis) => (points[at + axis] ?? NaN) - (middle[axis] ?? 0)) as [
          number,
          number,
          number,
        ];
        const [u, v] = [c * x + s * z, y];
        if (Number.isFinite(u + v))
          context.fillRect((SIDE - POINT) / 2 + scale * u, (SIDE - POINT) / 2 + scale * v, POINT, POINT);
      }
    }
    context.globalAlpha = 1;
  }
}

/** Middle of the clouds' common box, and how far they reach from it in a view from any side. */
function extent(clouds: Float32Array[]): { middle: number[]; reach: number } {
  const middle = [0, 1, 2].map((axis) => {
    let [least, most] = [Infinity, -Infinity];
    for (const points of clouds)
      for (let at = axis; at < points.length; at += 3) {
        const value = points[at] ?? NaN;
        if (value < least) least = value;
        if (value > most) most = value;
      }
    return most >= least ? (least + most) / 2 : 0;
  });
  const [x = 0, y = 0, z = 0] = middle;
  let reach = 1e-6;
  for (const points of clouds)
    for (let at = 0; at < points.length; at += 3) {
      const aside = Math.hypot((points[at] ?? NaN) - x, (points[at + 2] ?? NaN) - z);
      const down = Math.abs((points[at + 1] ?? NaN) - y);
      if (aside > reach) reach = aside;
      if (down > reach) reach = down;
    }
  return { middle, reach };
}
