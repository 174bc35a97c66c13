/**
 * A dialog that restricts the part of a picture that is used: rectangle, brush, growing and shrinking, and with a depth map a range of
 * depths. The Lab draws its masks with it, too.
 */

import "../style/rig-mask.css";
import { make } from "../dom";
import { choose, draw, labelled, numberField, press, show } from "./parts";
import { Paint, type Box } from "./paint";

/** Nearest and farthest depth, metres. */
type Depths = [number, number];

/** The picture for which a mask is drawn. */
export interface Subject {
  title: string;
  advice: string;
  picture(): Promise<ImageBitmap>;
  /** The present mask, at the picture's size; absent as long as the whole picture is used. */
  paint?: Uint8Array | undefined;
  range?: Depths | undefined;
  /** The depth map whose range can be restricted. */
  depth?: ((range: Depths | undefined) => Promise<ImageBitmap>) | undefined;
  /** Finds the object's silhouette from the marks. */
  suggest?: ((marks: Uint8Array) => Promise<Uint8Array>) | undefined;
  done(paint: Paint, range: Depths | undefined): void;
}

type Tool = "rectangle" | "brush";

/** The number of strokes that can be undone, and their memory limit, bytes. */
const MOST_STROKES = 30;
const MOST_BYTES = 128e6;

const FINDING = "Draw a rectangle around the object, or strokes on it and beside it; then its silhouette can be found.";
const FOUND = "Draw over what is wrong, and find it again; Undo stroke takes it back.";

export class MaskTool {
  readonly element = make("dialog", { class: "rig-mask", "aria-labelledby": "rig-mask-title" });
  readonly #title = make("h2", { id: "rig-mask-title" });
  readonly #advice = make("p", { class: "soft" });
  readonly #image = make("canvas");
  readonly #layer = make("canvas", {
    class: "rig-mask-layer",
    role: "img",
    "aria-label": "The used part of the colour image. Draw with the pointer, or enter the numbers of a rectangle.",
  });
  readonly #frameBox = make("div", { class: "rig-mask-band", hidden: true });
  readonly #depth = make("canvas", {
    class: "rig-mask-depth",
    role: "img",
    "aria-label": "Depth map; depths shown in grey are not used.",
  });
  readonly #share = make("p", { role: "status", class: "soft" });
  readonly #depths: HTMLElement;
  readonly #near: { element: HTMLElement; input: HTMLInputElement };
  readonly #far: { element: HTMLElement; input: HTMLInputElement };
  #tool: Tool = "rectangle";
  #use = true;
  #radius = 16;
  #radiusInput: HTMLInputElement | undefined;
  #step = 5;
  #box: Box = { left: 0, top: 0, width: 0, height: 0 };
  #range: Depths = [NaN, NaN];
  #paint = new Paint(1, 1);
  #past: Pick<Paint, "data" | "marks">[] = [];
  readonly #suggest = press("Find the silhouette", () => void this.#find());
  readonly #found = make("p", { class: "soft", role: "status" });
  readonly #finding: HTMLElement;
  readonly #undo = press("Undo stroke", () => this.#back(), { disabled: true });
  #subject: Subject | undefined;
  #late = 0;

  constructor() {
    this.#near = numberField("Nearest depth", "m", (value) => this.#changeRange([value, this.#range[1]]));
    this.#far = numberField("Farthest depth", "m", (value) => this.#changeRange([this.#range[0], value]));
    this.#depths = make(
      "fieldset",
      {},
      make("legend", {}, "Depths"),
      make("div", { class: "rig-row" }, this.#near.element, this.#far.element),
      this.#depth,
    );
    this.#finding = make("fieldset", {}, make("legend", {}, "Silhouette"), this.#suggest, this.#found);
    const board = make(
      "div",
      // A picture that is taller than the window scrolls.
      { class: "rig-mask-board", tabindex: "0", role: "group", "aria-label": "Picture" },
      make("div", { class: "rig-mask-picture" }, this.#image, this.#layer, this.#frameBox),
    );
    this.element.append(
      make("div", { class: "rig-mask-head" }, this.#title, this.#advice),
      board,
      make(
        "div",
        { class: "rig-mask-side" },
        this.#tools(),
        this.#finding,
        this.#typed(),
        this.#growing(),
        this.#depths,
      ),
      make(
        "div",
        { class: "rig-row rig-mask-foot" },
        this.#share,
        this.#undo,
        press("Use everything", () => this.#reset()),
        press("Cancel", () => this.element.close()),
        press("Done", () => this.#done(), { class: "primary" }),
      ),
    );
    this.#listen();
    document.body.append(this.element);
  }

  async open(subject: Subject): Promise<void> {
    const picture = await subject.picture();
    this.#subject = subject;
    this.#paint = new Paint(picture.width, picture.height, subject.paint);
    this.#past = [];
    this.#undo.disabled = true;
    this.#finding.hidden = subject.suggest === undefined;
    this.#found.textContent = FINDING;
    this.#suggest.disabled = false;
    this.#range = subject.range ? [...subject.range] : [NaN, NaN];
    this.#title.textContent = subject.title;
    this.#advice.textContent = subject.advice;
    draw(this.#image, picture);
    this.#layer.width = picture.width;
    this.#layer.height = picture.height;
    this.#radius = Math.max(2, Math.round(picture.width / 40));
    if (this.#radiusInput) this.#radiusInput.value = String(this.#radius);
    this.#depths.hidden = subject.depth === undefined;
    show(this.#near.input, this.#range[0]);
    show(this.#far.input, this.#range[1]);
    this.#showAll();
    this.#showDepth();
    this.element.showModal();
  }

  #tools(): HTMLElement {
    const tool = choose(
      [
        { value: "rectangle", label: "rectangle" },
        { value: "brush", label: "brush" },
      ],
      this.#tool,
      (value) => (this.#tool = value as Tool),
    );
    tool.autofocus = true;
    const use = choose(
      [
        { value: "use", label: "use what I draw" },
        { value: "leave", label: "leave it out" },
      ],
      "use",
      (value) => (this.#use = value === "use"),
    );
    const radius = numberField("Brush radius", "px", (value) => (this.#radius = value > 0 ? value : this.#radius));
    this.#radiusInput = radius.input;
    return make(
      "fieldset",
      {},
      make("legend", {}, "Draw"),
      labelled("Tool", tool),
      labelled("Effect", use),
      radius.element,
    );
  }

  #typed(): HTMLElement {
    const sides = (["left", "top", "width", "height"] as const).map(
      (side) =>
        numberField(side, "px", (value) => (this.#box = { ...this.#box, [side]: Number.isFinite(value) ? value : 0 }))
          .element,
    );
    const apply = press("Apply", () => {
      this.#keep();
      this.#paint.rectangle(this.#box, this.#use);
      this.#showAll();
    });
    return make(
      "details",
      {},
      make("summary", {}, "Rectangle by numbers"),
      make("div", { class: "rig-four" }, ...sides),
      apply,
    );
  }

  #growing(): HTMLElement {
    const step = numberField(
      "By",
      "px",
      (value) => (this.#step = value > 0 ? Math.min(200, Math.round(value)) : this.#step),
    );
    step.input.value = String(this.#step);
    const by = (sign: number) => () => {
      this.#keep();
      this.#paint.grow(sign * this.#step);
      this.#showAll();
    };
    return make(
      "fieldset",
      {},
      make("legend", {}, "Grow what is used"),
      make("div", { class: "rig-row rig-bottom" }, step.element, press("Grow", by(1)), press("Shrink", by(-1))),
    );
  }

  #listen(): void {
    let from: { x: number; y: number } | undefined;
    const place = (event: PointerEvent) => {
      const { left, top, width, height } = this.#layer.getBoundingClientRect();
      return {
        x: ((event.clientX - left) / width) * this.#paint.width,
        y: ((event.clientY - top) / height) * this.#paint.height,
      };
    };
    this.#layer.addEventListener("pointerdown", (event) => {
      this.#layer.setPointerCapture(event.pointerId);
      from = place(event);
      this.#keep();
      if (this.#tool === "brush") this.#dab(from);
      event.preventDefault();
    });
    this.#layer.addEventListener("pointermove", (event) => {
      if (!from) return;
      const to = place(event);
      if (this.#tool === "brush") {
        const steps = Math.max(1, Math.ceil(Math.hypot(to.x - from.x, to.y - from.y) / Math.max(1, this.#radius / 2)));
        for (let i = 1; i <= steps; i++)
          this.#dab({ x: from.x + ((to.x - from.x) * i) / steps, y: from.y + ((to.y - from.y) * i) / steps });
        from = to;
      } else {
        this.#showBand(boxOf(from, to));
      }
    });
    const end = (event: PointerEvent) => {
      if (!from) return;
      const box = boxOf(from, place(event));
      from = undefined;
      this.#frameBox.hidden = true;
      if (this.#tool === "rectangle" && box.width > 1 && box.height > 1 && event.type === "pointerup")
        this.#showPart(this.#paint.rectangle(box, this.#use), true);
      this.#showShare();
    };
    this.#layer.addEventListener("pointerup", end);
    this.#layer.addEventListener("pointercancel", end);
  }

  /** Replaces the mask by the silhouette that the marks suggest, as one more step that can be undone. */
  async #find(): Promise<void> {
    const [subject, paint] = [this.#subject, this.#paint];
    if (!subject?.suggest) return;
    if (!paint.marks) return void (this.#found.textContent = FINDING);
    this.#suggest.disabled = true;
    this.#found.textContent = "Looking for the silhouette";
    const found = await subject
      .suggest(paint.marks)
      .catch((error: unknown) => String(error instanceof Error ? error.message : error));
    // The dialog may have been closed, or opened for another picture.
    if (paint !== this.#paint || !this.element.open) return;
    this.#suggest.disabled = false;
    this.#found.textContent = typeof found === "string" ? found : FOUND;
    if (typeof found === "string") return;
    this.#keep();
    paint.data = found;
    this.#showAll();
  }

  /** Before each stroke. */
  #keep(): void {
    const { data, marks, width, height } = this.#paint;
    this.#past.push({ data: data?.slice(), marks: marks?.slice() });
    const most = Math.min(MOST_STROKES, Math.max(1, MOST_BYTES / (2 * width * height)));
    while (this.#past.length > most) this.#past.shift();
    this.#undo.disabled = false;
  }

  #back(): void {
    if (this.#past.length === 0) return;
    Object.assign(this.#paint, this.#past.pop());
    this.#undo.disabled = this.#past.length === 0;
    this.#showAll();
  }

  #dab({ x, y }: { x: number; y: number }): void {
    const isFirst = this.#paint.data === undefined;
    const box = this.#paint.disc(x, y, this.#radius, this.#use);
    this.#showPart(box, isFirst);
  }

  #showBand({ left, top, width, height }: Box): void {
    const percent = (value: number, of: number) => `${(100 * value) / of}%`;
    this.#frameBox.hidden = false;
    Object.assign(this.#frameBox.style, {
      left: percent(left, this.#paint.width),
      top: percent(top, this.#paint.height),
      width: percent(width, this.#paint.width),
      height: percent(height, this.#paint.height),
    });
  }

  #showAll(): void {
    this.#showPart({ left: 0, top: 0, width: this.#paint.width, height: this.#paint.height });
    this.#showShare();
  }

  /** Unused parts are darkened. */
  #showPart(part: Box, all = false): void {
    const { width, height, data } = this.#paint;
    const box = all ? { left: 0, top: 0, width, height } : part;
    const context = this.#layer.getContext("2d");
    if (!context || box.width < 1 || box.height < 1) return;
    const image = new ImageData(box.width, box.height);
    if (data) {
      for (let row = 0; row < box.height; row++) {
        for (let column = 0; column < box.width; column++) {
          if (!data[(box.top + row) * width + box.left + column]) image.data[4 * (row * box.width + column) + 3] = 190;
        }
      }
    }
    context.putImageData(image, box.left, box.top);
  }

  #showShare(): void {
    this.#share.textContent = `${(100 * this.#paint.share).toFixed(0)} % of the image is used.`;
  }

  #changeRange(range: Depths): void {
    this.#range = range;
    clearTimeout(this.#late);
    this.#late = window.setTimeout(() => this.#showDepth(), 150);
  }

  get #wholeRange(): Depths | undefined {
    const [near, far] = this.#range;
    return Number.isFinite(near) || Number.isFinite(far)
      ? [Number.isFinite(near) ? near : 0, Number.isFinite(far) ? far : 1000]
      : undefined;
  }

  #showDepth(): void {
    void this.#subject?.depth?.(this.#wholeRange).then(
      (bitmap) => draw(this.#depth, bitmap),
      () => {},
    );
  }

  #reset(): void {
    this.#keep();
    this.#paint.data = undefined;
    this.#paint.marks = undefined;
    this.#range = [NaN, NaN];
    this.#near.input.value = "";
    this.#far.input.value = "";
    this.#showAll();
    this.#showDepth();
  }

  #done(): void {
    this.#subject?.done(this.#paint, this.#wholeRange);
    this.element.close();
  }
}

const boxOf = (a: { x: number; y: number }, b: { x: number; y: number }): Box => ({
  left: Math.min(a.x, b.x),
  top: Math.min(a.y, b.y),
  width: Math.abs(a.x - b.x),
  height: Math.abs(a.y - b.y),
});
