/** The live figure of a lesson: its panels, each made once and drawn again whenever the worker answers. */

import { make } from "../dom";
import { Cloud } from "./cloud";
import { blank, placed } from "./frames";
import type { Drawing, ImagePanel, Mark, Panel } from "./protocol";
import { Plot } from "./plot";
import { svg } from "./svg";

interface Widget {
  element: HTMLElement;
  show(panel: Panel): void;
}

/** A drag on a panel, as shares of its sides. */
export type OnDrag = (key: string, x: number, y: number) => void;

export class Figure {
  readonly element = make("div", { class: "learn-panels" });
  readonly #widgets = new Map<string, Widget>();
  readonly #drags: ReadonlySet<string>;
  readonly #followed: ReadonlySet<string>;
  readonly #onDrag: OnDrag;

  /** `drags` are the panels on which the visitor can drag. Panels in `followed` also report a mouse that only hovers. */
  constructor(drags: ReadonlySet<string>, followed: ReadonlySet<string>, onDrag: OnDrag) {
    this.#drags = drags;
    this.#followed = followed;
    this.#onDrag = onDrag;
  }

  /** Marks the panels as those of an earlier state, until the next drawing. */
  wait(): void {
    this.element.setAttribute("aria-busy", "true");
  }

  /** Shows empty panels until the first drawing arrives, or none if it will not arrive. */
  outline(kinds: readonly Panel["kind"][]): void {
    if (this.#widgets.size > 0) return;
    this.element.replaceChildren(...kinds.map(blank));
  }

  show({ panels }: Drawing): void {
    this.element.setAttribute("aria-busy", "false");
    if (this.#widgets.size === 0) this.element.replaceChildren();
    const keys = new Set(panels.map(({ key }) => key));
    for (const [key, { element }] of this.#widgets) {
      if (keys.has(key)) continue;
      element.remove();
      this.#widgets.delete(key);
    }
    for (const panel of panels) {
      let widget = this.#widgets.get(panel.key);
      if (!widget) {
        widget = this.#make(panel);
        this.#widgets.set(panel.key, widget);
        this.element.append(widget.element);
      }
      widget.show(panel);
    }
  }

  /** Shows a state that is earlier than the present one, but new enough for the delay before it fades to begin again. */
  follow(drawing: Drawing): void {
    this.show(drawing);
    // A transition begins only where the browser has computed the styles in between.
    this.element.getBoundingClientRect();
    this.wait();
  }

  #make(panel: Panel): Widget {
    switch (panel.kind) {
      case "image":
        return new Picture(
          panel.key,
          this.#drags.has(panel.key) ? this.#onDrag : undefined,
          this.#followed.has(panel.key),
        );
      case "plot":
        return new Plot();
      case "cloud":
        return new Cloud();
    }
  }
}

/** Pixels with marks over them. */
class Picture implements Widget {
  readonly element: HTMLElement;
  readonly #canvas = make("canvas", { width: 1, height: 1, role: "img" });
  readonly #marks = svg("svg", { viewBox: "0 0 100 100", preserveAspectRatio: "none", "aria-hidden": "true" });
  readonly #title = make("figcaption", {});
  readonly #legend = make("p", { class: "soft learn-legend" });

  constructor(key: string, onDrag: OnDrag | undefined, follows: boolean) {
    const box = make("div", { class: "learn-canvas" }, this.#canvas, this.#marks);
    if (onDrag) draggable(box, (x, y) => onDrag(key, x, y), follows);
    this.element = make("figure", { class: "learn-panel", "data-panel": key }, this.#title, placed(box), this.#legend);
  }

  show(panel: Panel): void {
    if (panel.kind !== "image") return;
    this.#title.textContent = panel.title;
    this.#legend.textContent = panel.legend ?? "";
    this.#canvas.setAttribute("aria-label", panel.alt);
    this.#paint(panel);
    this.#marks.replaceChildren(...(panel.marks ?? []).flatMap(drawn));
  }

  #paint({ width, height, pixels }: ImagePanel): void {
    if (this.#canvas.width !== width) this.#canvas.width = width;
    if (this.#canvas.height !== height) this.#canvas.height = height;
    const image = new ImageData(width, height);
    image.data.set(pixels);
    this.#canvas.getContext("2d")?.putImageData(image, 0, 0);
  }
}

/** A line through points, with gaps where they are not known. */
function pathOf(points: readonly number[]): string {
  let isDown = false;
  let path = "";
  for (let i = 0; i + 1 < points.length; i += 2) {
    const [x, y] = [100 * (points[i] ?? NaN), 100 * (points[i + 1] ?? NaN)];
    const isKnown = Number.isFinite(x + y);
    if (isKnown) path += `${isDown ? "L" : "M"}${x.toFixed(2)} ${y.toFixed(2)}`;
    isDown = isKnown;
  }
  return path;
}

function drawn({ ink, shape, points, size = 2, isFine = false }: Mark): SVGElement[] {
  const at = (i: number): [number, number] => [100 * (points[2 * i] ?? NaN), 100 * (points[2 * i + 1] ?? NaN)];
  const all = Array.from({ length: points.length / 2 }, (_, i) => at(i)).filter(
    ([x, y]) => Number.isFinite(x) && Number.isFinite(y),
  );
  const name = `learn-mark learn-ink-${ink}`;
  if (shape === "line") {
    const d = pathOf(points);
    if (isFine) return [svg("path", { class: `${name} fine-halo`, d }), svg("path", { class: `${name} fine`, d })];
    return [svg("path", { class: `${name} halo`, d }), svg("path", { class: name, d })];
  }
  return all.flatMap(([x, y]) => {
    if (shape === "dot") return [svg("circle", { class: `${name} filled`, cx: x, cy: y, r: size })];
    const form = (kind: string) =>
      shape === "ring"
        ? svg("circle", { class: kind, cx: x, cy: y, r: size })
        : svg("path", {
            class: kind,
            d: `M${x - size} ${y - size}l${2 * size} ${2 * size}m0 ${-2 * size}l${-2 * size} ${2 * size}`,
          });
    return [form(`${name} halo`), form(name)];
  });
}

/** Reports the pointer's position in an element while it is held down. Keyboards can use the sliders. */
function draggable(box: HTMLElement, onMove: (x: number, y: number) => void, follows: boolean): void {
  box.classList.add("learn-draggable");
  const tell = (event: PointerEvent) => {
    const { left, top, width, height } = box.getBoundingClientRect();
    const within = (value: number) => Math.min(1, Math.max(0, value));
    onMove(within((event.clientX - left) / width), within((event.clientY - top) / height));
  };
  box.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    event.preventDefault();
    box.setPointerCapture(event.pointerId);
    tell(event);
  });
  box.addEventListener("pointermove", (event) => {
    const hovers = follows && event.pointerType === "mouse" && event.buttons === 0;
    if (hovers || box.hasPointerCapture(event.pointerId)) tell(event);
  });
}

/** On a phone the figure may be out of view when a button below it is pressed. */
export function showFigure(box: HTMLElement): void {
  const { top, height } = box.getBoundingClientRect();
  if (top < 0 || top + Math.min(height, innerHeight / 2) > innerHeight) box.scrollIntoView({ block: "start" });
}
