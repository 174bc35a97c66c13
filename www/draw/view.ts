/** One canvas with its caption, legend and the value under the pointer. */

import { make } from "../dom";
import type { Picture, Raster } from "../engine/protocol";
import { normalColour, paintNormals, paintPicture, paintScalar } from "./colours";
import { decimals, short } from "./numbers";
import type { Painter } from "./painter";
import type { Pixel, Probe } from "./probe";
import type { Scale } from "./scale";

export type Content =
  | { kind: "picture"; legend: string }
  | { kind: "normals" }
  /** The view that leads sets the automatic range of a scale that several share. */
  | { kind: "scalar"; scale: Scale; leads: boolean };

export interface ViewOptions {
  title: string;
  /** What the picture shows, for those who cannot see it. */
  description: string;
  content: Content;
  probe: Probe;
  painter: Painter;
}

export class View {
  readonly element: HTMLElement;
  readonly #options: ViewOptions;
  readonly #canvas: HTMLCanvasElement;
  readonly #readout: HTMLOutputElement;
  readonly #dot: HTMLElement;
  readonly #box: HTMLElement;
  #setUnit: (unit: string) => void = () => {};
  #unit = "";
  #raster: Raster | Picture | undefined;

  constructor(options: ViewOptions) {
    this.#options = options;
    const { title, description, content, probe } = options;
    this.#canvas = make("canvas", { width: 64, height: 64, tabindex: 0, role: "img", "aria-label": `${title}: ${description}. Arrow keys move the probe.` });
    this.#readout = make("output", { class: "readout" });
    this.#dot = make("span", { class: "dot", hidden: true });
    const caption = make("figcaption", {}, make("span", { class: "view-title" }, title));
    this.#box = make("div", { class: "canvas" }, this.#canvas, this.#dot, this.#readout);
    this.element = make("figure", { class: "view" }, caption, this.#box, this.#legend());

    probe.listen(() => this.#showProbe());
    if (content.kind === "scalar") content.scale.listen(() => this.#repaint());
    this.#canvas.addEventListener("pointermove", (event) => probe.point(this.#pixelAt(event)));
    this.#canvas.addEventListener("pointerdown", (event) => probe.point(this.#pixelAt(event)));
    this.#canvas.addEventListener("pointerleave", () => probe.point(null));
    this.#canvas.addEventListener("blur", () => probe.point(null));
    this.#canvas.addEventListener("keydown", (event) => this.#move(event));
  }

  show(raster: Raster | Picture, unit = ""): void {
    this.#raster = raster;
    this.#unit = unit;
    this.#setUnit(unit);
    this.#box.style.setProperty("--ratio", String(raster.width / raster.height));
    const { content } = this.#options;
    if (content.kind === "scalar" && content.leads) content.scale.follow(raster);
    this.#repaint();
    this.#showProbe();
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

  #repaint(): void {
    const raster = this.#raster;
    if (!raster) return;
    this.#options.painter.request(this, () => {
      this.#canvas.width = raster.width;
      this.#canvas.height = raster.height;
      this.#canvas.getContext("2d")?.putImageData(this.#paint(raster), 0, 0);
    });
  }

  #paint(raster: Raster | Picture): ImageData {
    const { content } = this.#options;
    if (content.kind === "normals") return paintNormals(raster);
    if (content.kind === "scalar") return paintScalar(raster, content.scale.range, content.scale.map);
    return "white" in raster ? paintPicture(raster) : new ImageData(raster.width, raster.height);
  }

  #pixelAt(event: PointerEvent): Pixel | null {
    const raster = this.#raster;
    if (!raster) return null;
    const box = this.#canvas.getBoundingClientRect();
    const column = Math.floor(((event.clientX - box.left) / box.width) * raster.width);
    const row = Math.floor(((event.clientY - box.top) / box.height) * raster.height);
    if (column < 0 || row < 0 || column >= raster.width || row >= raster.height) return null;
    return { column: raster.left + column * raster.stride, row: raster.top + row * raster.stride };
  }

  #move(event: KeyboardEvent): void {
    const raster = this.#raster;
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (!raster || !step || event.altKey || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    const { left, top, stride, width, height } = raster;
    const middle = { column: left + stride * Math.floor(width / 2), row: top + stride * Math.floor(height / 2) };
    const from = this.#options.probe.pixel ?? middle;
    const within = (value: number, first: number, count: number) => Math.max(first, Math.min(first + (count - 1) * stride, value));
    this.#options.probe.point({
      column: within(from.column + stride * (step[0] ?? 0), left, width),
      row: within(from.row + stride * (step[1] ?? 0), top, height),
    });
  }

  #showProbe(): void {
    const raster = this.#raster;
    const pixel = this.#options.probe.pixel;
    this.#dot.hidden = !raster || !pixel;
    this.#readout.textContent = raster && pixel ? this.#describe(raster, pixel) : "";
    if (!raster || !pixel) return;
    const { column, row } = drawn(raster, pixel);
    this.#dot.style.left = `${(100 * (column + 0.5)) / raster.width}%`;
    this.#dot.style.top = `${(100 * (row + 0.5)) / raster.height}%`;
  }

  #describe(raster: Raster, pixel: Pixel): string {
    const { column, row } = drawn(raster, pixel);
    const index = row * raster.width + column;
    const values = raster.data.subarray(index * raster.channels, (index + 1) * raster.channels);
    const where = `${pixel.column}, ${pixel.row}`;
    if (values.length === 0 || Number.isNaN(values[0])) return `${where}: none`;
    if (this.#options.content.kind === "normals") return `${where}: ${[...values].map((value) => decimals(value, 2)).join(" ")}`;
    return `${where}: ${[...values].map(short).join(" ")}${this.#unit ? ` ${this.#unit}` : ""}`;
  }
}

/** Where a pixel of the full grid lies among the drawn ones. */
function drawn({ left, top, stride }: Raster, { column, row }: Pixel): Pixel {
  return { column: Math.floor((column - left) / stride), row: Math.floor((row - top) / stride) };
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
