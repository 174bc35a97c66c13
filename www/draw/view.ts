/** One canvas with its caption, legend and the value under the pointer. It receives finished bitmaps. */

import { make } from "../dom";
import { VIEWS, type Painted, type Pixel, type Side, type ViewName } from "../engine/protocol";
import { normalColour } from "./colours";
import { decimals, short } from "./numbers";
import type { Painter } from "./painter";
import { Pinned } from "./pinned";
import type { Probe } from "./probe";
import type { Scale } from "./scale";

export type Content = { kind: "picture"; legend: string } | { kind: "normals" } | { kind: "scalar"; scale: Scale };

export interface ViewOptions {
  name: ViewName;
  title: string;
  /** A description of the picture for screen readers. */
  description: string;
  content: Content;
  probe: Probe;
  painter: Painter;
}

export class View {
  readonly element: HTMLElement;
  readonly #options: ViewOptions;
  readonly #side: Side;
  readonly #canvas: HTMLCanvasElement;
  /** Requested before the canvas is on the page: later the browser would first restyle the whole page, in the middle of a frame. */
  readonly #context: CanvasRenderingContext2D | null;
  readonly #readout = make("span", { class: "readout" });
  readonly #dot = make("span", { class: "dot", hidden: true });
  readonly #box: HTMLElement;
  readonly #pinned: Pinned;
  #setUnit: (unit: string) => void = () => {};
  #unit = "";
  #painted: Painted | undefined;

  constructor(options: ViewOptions) {
    this.#options = options;
    const { name, title, description, probe } = options;
    this.#side = VIEWS[name];
    this.#canvas = make("canvas", {
      width: 64,
      height: 64,
      tabindex: 0,
      role: "img",
      "aria-label": `${title}: ${description}. Arrow keys move the probe.`,
    });
    this.#context = this.#canvas.getContext("2d");
    this.#box = make("div", { class: "canvas" }, this.#canvas, this.#dot, this.#readout);
    this.#pinned = new Pinned(this.#canvas);
    this.element = make(
      "figure",
      { class: "view" },
      make("figcaption", {}, make("span", { class: "view-title" }, title)),
      this.#box,
      this.#legend(),
    );

    probe.listen(() => this.#showProbe());
    const point = (event: PointerEvent) => this.#point(this.#pixelAt(event));
    this.#canvas.addEventListener("pointermove", point);
    this.#canvas.addEventListener("pointerdown", point);
    this.#canvas.addEventListener("pointerleave", ({ pointerType }) => {
      // A touch keeps the selection, because a finger hides the value under it until it is lifted.
      if (pointerType !== "touch") this.#point(null);
    });
    // A value is announced only if keys moved the probe; with a pointer the announcements would never end.
    this.#canvas.addEventListener("focus", () => this.#readout.setAttribute("role", "status"));
    this.#canvas.addEventListener("blur", () => {
      this.#readout.removeAttribute("role");
      this.#point(null);
    });
    this.#canvas.addEventListener("keydown", (event) => this.#move(event));
  }

  show(painted: Painted, unit?: string): void {
    // A frame that was superseded before it could be drawn.
    this.#painted?.bitmap.close();
    this.#painted = painted;
    if (unit !== undefined) {
      this.#unit = unit;
      this.#setUnit(unit);
    }
    const { width, height, bitmap } = painted;
    this.#box.style.setProperty("--ratio", String(width / height));
    this.#options.painter.request(
      this,
      () => {
        this.#canvas.width = width;
        this.#canvas.height = height;
        this.#context?.drawImage(bitmap, 0, 0);
        bitmap.close();
        this.#pinned.place(painted);
      },
      width * height,
    );
    this.#showProbe();
  }

  /** Keeps the present picture, to be shown left of the wipe. */
  pin(): void {
    if (this.#painted) this.#pinned.keep(this.#painted);
  }

  unpin(): void {
    this.#pinned.drop();
  }

  #legend(): HTMLElement {
    const { content, title } = this.#options;
    if (content.kind === "scalar") {
      const { element, setUnit } = content.scale.legend(title);
      this.#setUnit = setUnit;
      return element;
    }
    if (content.kind === "normals") {
      return make("div", { class: "legend" }, sphere(), make("span", {}, "right red, up green, near blue"));
    }
    return make("div", { class: "legend" }, make("span", {}, content.legend));
  }

  #point(pixel: Pixel | null): void {
    this.#options.probe.point(pixel && { side: this.#side, pixel });
  }

  #pixelAt(event: PointerEvent): Pixel | null {
    const painted = this.#painted;
    if (!painted) return null;
    const { left, top, width, height, stride } = painted;
    const box = this.#canvas.getBoundingClientRect();
    const column = Math.floor(((event.clientX - box.left) / box.width) * width);
    const row = Math.floor(((event.clientY - box.top) / box.height) * height);
    if (column < 0 || row < 0 || column >= width || row >= height) return null;
    return { column: left + column * stride, row: top + row * stride };
  }

  #move(event: KeyboardEvent): void {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (!this.#painted || !step || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    const { left, top, stride, width, height } = this.#painted;
    const middle = { column: left + stride * Math.floor(width / 2), row: top + stride * Math.floor(height / 2) };
    const from = this.#options.probe.at(this.#side) ?? middle;
    const within = (value: number, first: number, count: number) =>
      Math.max(first, Math.min(first + (count - 1) * stride, value));
    this.#point({
      column: within(from.column + stride * (step[0] ?? 0), left, width),
      row: within(from.row + stride * (step[1] ?? 0), top, height),
    });
  }

  #showProbe(): void {
    const pixel = this.#options.probe.at(this.#side);
    const { hidden, column, row } = this.#placeOf(pixel);
    this.#dot.hidden = hidden;
    if (!pixel) this.#readout.textContent = "";
    else if (this.#isAnswered(pixel)) this.#readout.textContent = this.#describe(pixel);
    this.#dot.style.left = `${column}%`;
    this.#dot.style.top = `${row}%`;
  }

  /** The position of a pixel in the box, percent; the other view's counterpart may lie outside the drawn part. */
  #placeOf(pixel: Pixel | null): { hidden: boolean; column: number; row: number } {
    const painted = this.#painted;
    if (!painted || !pixel) return { hidden: true, column: 0, row: 0 };
    const { left, top, width, height, stride } = painted;
    const [column, row] = [Math.floor((pixel.column - left) / stride), Math.floor((pixel.row - top) / stride)];
    const hidden = column < 0 || row < 0 || column >= width || row >= height;
    return { hidden, column: (100 * (column + 0.5)) / width, row: (100 * (row + 0.5)) / height };
  }

  /** Numbers of another pixel must not be shown beside this one. */
  #isAnswered({ column, row }: Pixel): boolean {
    const answered = this.#options.probe.answer?.pixels[this.#side];
    return answered?.column === column && answered.row === row;
  }

  #describe({ column, row }: Pixel): string {
    const { name, content, probe } = this.#options;
    const values = probe.answer?.values[name];
    const where = `${column}, ${row}`;
    if (!values || values.length === 0) return `${where}: none`;
    if (content.kind === "normals") return `${where}: ${values.map((value) => decimals(value, 2)).join(" ")}`;
    return `${where}: ${values.map(short).join(" ")}${this.#unit ? ` ${this.#unit}` : ""}`;
  }
}

/** A ball seen from the front: every colour a normal can have. */
function sphere(): HTMLCanvasElement {
  const size = 32;
  const canvas = make("canvas", { width: size, height: size, class: "sphere", "aria-hidden": "true" });
  const image = new ImageData(size, size);
  for (let i = 0; i < size * size; i++) {
    const x = ((i % size) + 0.5) / (size / 2) - 1;
    const y = (Math.floor(i / size) + 0.5) / (size / 2) - 1;
    const rest = 1 - x * x - y * y;
    if (rest > 0) image.data.set([...normalColour(x, y, -Math.sqrt(rest)), 255], 4 * i);
  }
  canvas.getContext("2d")?.putImageData(image, 0, 0);
  return canvas;
}
