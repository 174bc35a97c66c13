/** The depth map projected onto the colour image at full resolution, with one calibration or an interpolation between two. */

import type { Pose } from "../../pkg/index.js";
import { colourAt, gradient } from "../draw/colours";
import { decimals } from "../draw/numbers";
import { freshId, make } from "../dom";
import { choose, draw, fill, labelled, press } from "./parts";
import { between } from "./poses";
import type { Projection } from "./protocol";
import type { Overlay as ReportOverlay } from "./report";
import type { Rig, Run } from "./rig";

type What = "both" | "points" | "edges";

interface Stop {
  name: string;
  pose: Pose;
}

/** Number of slider steps from one calibration to the next. */
const WAY = 20;
/** A colour that differs from all depth colours and from most objects. */
const EDGE = [255, 60, 190] as const;
/** Ratio of the point size to the mean distance of points, so that sparse regions are covered. */
const OVERLAP = 1.2;
/** Largest width of the report's pictures in pixels, and largest number of frames in the report. */
const [REPORT_WIDTH, REPORT_FRAMES] = [1280, 3];

export class Overlay {
  readonly element = make("section", { class: "rig-card rig-overlay", "aria-label": "Overlay" });
  readonly #rig: Rig;
  readonly #image = make("canvas", { "aria-hidden": "true" });
  readonly #layer = make("canvas", {
    role: "img",
    class: "rig-overlay-layer",
    "aria-label": "Depth map on the colour image, not drawn yet",
  });
  readonly #board = make("div", {
    class: "rig-overlay-board",
    tabindex: "0",
    role: "group",
    "aria-label": "Picture, scrolls when enlarged",
  });
  readonly #picture = make("div", { class: "rig-overlay-picture" });
  readonly #frame: HTMLSelectElement;
  readonly #slider = make("input", { type: "range", min: "0", step: "1", "aria-label": "Calibration shown" });
  readonly #stopRow = make("div", { class: "rig-stops", role: "group", "aria-label": "Calibration shown" });
  readonly #where = make("output", { class: "rig-where" });
  readonly #legend = make("div", { class: "rig-depth-legend" });
  readonly #size: HTMLButtonElement;
  #what: What = "both";
  #run: Run | undefined;
  #stops: Stop[] = [];
  #index = 0;
  #wanted = 0;
  #busy = false;
  #drawn: Projection | undefined;

  constructor(rig: Rig) {
    this.#rig = rig;
    this.#frame = choose([], "0", (value) => void this.#chooseFrame(Number(value)));
    const what = choose(
      [
        { value: "both", label: "points and edges" },
        { value: "points", label: "points" },
        { value: "edges", label: "depth edges" },
      ],
      "both",
      (value) => {
        this.#what = value as What;
        this.#paint();
      },
    );
    const opacity = make("input", { type: "range", min: "0", max: "100", value: "55" });
    const fade = () => (this.#layer.style.opacity = String(Number(opacity.value) / 100));
    opacity.addEventListener("input", fade);
    fade();
    this.#size = press("Full size", () => this.#resize(), { "aria-pressed": "false" });
    this.#slider.addEventListener("input", () => void this.#project());
    this.#picture.append(this.#image, this.#layer);
    this.#board.append(this.#picture);
    const ticks = freshId("ticks");
    this.#slider.setAttribute("list", ticks);
    this.element.append(
      make(
        "div",
        { class: "rig-overlay-head" },
        make("h3", {}, "Depth on colour"),
        labelled("Frame", this.#frame),
        labelled("Shown", what),
        labelled("Opacity", opacity),
        this.#size,
      ),
      make("div", { class: "rig-slide" }, this.#stopRow, this.#slider, this.#where, make("datalist", { id: ticks })),
      this.#board,
      this.#legend,
    );
  }

  show(run: Run): void {
    if (run === this.#run) return;
    this.#run = run;
    const [first, ...others] = Object.entries(run.candidates).map(([name, pose]) => ({ name, pose }));
    const found = { name: "found", pose: run.report.estimate };
    this.#stops = first ? [first, found, ...others] : [found];
    this.#stopRow.parentElement?.style.setProperty("--stops", String(this.#stops.length));
    this.#slider.max = String(WAY * (this.#stops.length - 1));
    this.#slider.value = "0";
    this.#stopRow.replaceChildren(
      ...this.#stops.map(({ name }, i) => press(name, () => this.#goTo(i), { "aria-pressed": "false" })),
    );
    this.element
      .querySelector("datalist")
      ?.replaceChildren(...this.#stops.map((_, i) => make("option", { value: i * WAY })));
    this.#picture.style.aspectRatio = this.#ratioOf(run);
    fill(
      this.#frame,
      run.plans.map(({ name }, i) => ({ value: String(i), label: name })),
      "0",
    );
    void this.#chooseFrame(0);
  }

  /** The size is known before the picture, so that the layout below does not move. */
  #ratioOf({ plans }: Run): string {
    const { width = 4, height = 3 } = this.#rig.item(plans[0]?.colour)?.summary ?? {};
    return `${width} / ${height}`;
  }

  #goTo(stop: number): void {
    this.#slider.value = String(stop * WAY);
    void this.#project();
  }

  #resize(): void {
    const isFull = this.#board.toggleAttribute("data-full");
    this.#size.setAttribute("aria-pressed", String(isFull));
  }

  async #chooseFrame(index: number): Promise<void> {
    const plan = this.#run?.plans[index];
    if (!plan) return;
    this.#index = index;
    const bitmap = await this.#rig.session.call("picture", { file: plan.colour }).catch(() => undefined);
    if (!bitmap || index !== this.#index) return;
    draw(this.#image, bitmap);
    this.#layer.width = bitmap.width;
    this.#layer.height = bitmap.height;
    this.#picture.style.setProperty("--full", `${bitmap.width}px`);
    this.#picture.style.aspectRatio = `${bitmap.width} / ${bitmap.height}`;
    await this.#project();
  }

  /** The pose at the slider's position, and its description. */
  #place(): { pose: Pose; words: string; stop: number } {
    const value = Number(this.#slider.value);
    const i = Math.min(Math.floor(value / WAY), this.#stops.length - 1);
    const [a, b] = [this.#stops[i], this.#stops[i + 1]];
    const share = value / WAY - i;
    if (!a) throw new Error("No frame to show.");
    if (!b || share === 0) return { pose: a.pose, words: a.name, stop: i };
    return {
      pose: between(a.pose, b.pose, share),
      words: `${Math.round(100 * share)} % of the way from ${a.name} to ${b.name}`,
      stop: -1,
    };
  }

  /** Only the newest position is drawn; those passed while the worker was busy are skipped. */
  async #project(): Promise<void> {
    if (this.#stops.length === 0) return;
    const { words, stop } = this.#place();
    this.#where.textContent = words;
    this.#slider.setAttribute("aria-valuetext", words);
    [...this.#stopRow.children].forEach((button, i) => button.setAttribute("aria-pressed", String(i === stop)));
    this.#wanted++;
    if (this.#busy) return;
    this.#busy = true;
    try {
      for (let done = 0; done !== this.#wanted; ) {
        done = this.#wanted;
        this.#drawn = await this.#rig.session.call("overlay", { frame: this.#index, pose: this.#place().pose });
        this.#paint();
      }
    } catch (error) {
      this.#where.textContent = `The overlay can't be drawn: ${error instanceof Error ? error.message : String(error)}`;
    } finally {
      this.#busy = false;
    }
  }

  #paint(): void {
    if (!this.#drawn) return;
    const { min, max } = paint(this.#layer, this.#drawn, this.#what);
    this.#layer.setAttribute(
      "aria-label",
      `Depth map on the colour image of ${this.#run?.plans[this.#index]?.name ?? ""}, calibration: ${this.#where.textContent}`,
    );
    const isWithPoints = this.#what !== "edges" && max > min;
    const bar = make("span", { class: "rig-ramp", style: `background: ${gradient("viridis")}` });
    const key = make("span", { class: "rig-edge-key" });
    this.#legend.replaceChildren(
      ...(isWithPoints
        ? [make("span", {}, `${decimals(min, 2)} m`), bar, make("span", {}, `${decimals(max, 2)} m`)]
        : []),
      ...(this.#what === "points"
        ? []
        : [
            make(
              "span",
              { class: "rig-legend-edge" },
              key,
              "depth edges; they should coincide with the silhouettes in the image",
            ),
          ]),
    );
  }

  /** The most informative frames, with the depth edges of the calibration in question and of the estimate, for the report. */
  async forReport(): Promise<ReportOverlay[]> {
    const run = this.#run;
    if (!run) return [];
    const share = (index: number) => run.report.frames[index]?.share ?? 0;
    const order = [...run.plans.keys()].sort((a, b) => share(b) - share(a)).slice(0, REPORT_FRAMES);
    const edges = async (frame: number, pose: Pose) => (await this.#rig.session.call("overlay", { frame, pose })).edges;
    const list: ReportOverlay[] = [];
    for (const index of order) {
      const plan = run.plans[index];
      if (!plan) continue;
      const bitmap = await this.#rig.session.call("picture", { file: plan.colour });
      const after = await edges(index, run.report.estimate);
      const [given] = run.estimateOnly ? [] : Object.values(run.candidates);
      const before = given && (await edges(index, given));
      const { width, height } = bitmap;
      list.push({ frame: plan.name, width, height, picture: jpegOf(bitmap), before, after });
    }
    return list;
  }
}

/** A picture for the report, scaled down. */
function jpegOf(bitmap: ImageBitmap): string {
  const scale = Math.min(1, REPORT_WIDTH / bitmap.width);
  const canvas = make("canvas", { width: Math.round(scale * bitmap.width), height: Math.round(scale * bitmap.height) });
  canvas.getContext("2d")?.drawImage(bitmap, 0, 0, canvas.width, canvas.height);
  return canvas.toDataURL("image/jpeg", 0.85);
}

/** Draws points as squares that touch if the depth map is coarser than the image, and states the range of depths. */
function paint(layer: HTMLCanvasElement, { points, edges }: Projection, what: What): { min: number; max: number } {
  const { width, height } = layer;
  const context = layer.getContext("2d");
  if (!context || width === 0) return { min: 0, max: 0 };
  const image = new ImageData(width, height);
  const pixels = new Uint32Array(image.data.buffer);
  const { min, max } = rangeOf(points);
  const dot = (column: number, row: number, size: number, colour: number) => {
    const [left, top] = [Math.round(column - (size - 1) / 2), Math.round(row - (size - 1) / 2)];
    for (let y = Math.max(0, top); y < Math.min(height, top + size); y++) {
      for (let x = Math.max(0, left); x < Math.min(width, left + size); x++) pixels[y * width + x] = colour;
    }
  };
  if (what !== "edges") {
    const ramp = Uint32Array.from({ length: 256 }, (_, i) => packed(colourAt("viridis", i / 255)));
    const size = Math.max(
      1,
      Math.min(8, Math.ceil(OVERLAP * Math.sqrt((width * height) / Math.max(1, points.length / 3)))),
    );
    const factor = max > min ? 255 / (max - min) : 0;
    for (let i = 0; i + 2 < points.length; i += 3) {
      const share = Math.max(0, Math.min(255, Math.round(((points[i + 2] ?? 0) - min) * factor)));
      dot(points[i] ?? -9, points[i + 1] ?? -9, size, ramp[share] ?? 0);
    }
  }
  if (what !== "points") {
    const size = Math.max(2, Math.round(width / 480));
    for (let i = 0; i + 1 < edges.length; i += 2) dot(edges[i] ?? -9, edges[i + 1] ?? -9, size, packed(EDGE));
  }
  context.putImageData(image, 0, 0);
  return { min, max };
}

/** The colours have the memory layout of a canvas, red first, and are opaque. */
const packed = ([r, g, b]: readonly [number, number, number]): number =>
  new Uint32Array(new Uint8Array([r, g, b, 255]).buffer)[0] ?? 0;

/** The middle 98 % of the depths: single outliers must not flatten everything else. */
function rangeOf(points: Float32Array): { min: number; max: number } {
  const every = 3 * Math.max(1, Math.floor(points.length / 3 / 4096));
  const depths: number[] = [];
  for (let i = 2; i < points.length; i += every) depths.push(points[i] ?? 0);
  depths.sort((a, b) => a - b);
  const at = (share: number) => depths[Math.round(share * (depths.length - 1))] ?? 0;
  return { min: at(0.01), max: at(0.99) };
}
