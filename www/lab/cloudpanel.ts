/** The panel of both surfaces. The code that draws them is loaded when they are first visible; if it cannot draw, the panel says why. */

import type { Pose } from "../../pkg/index.js";
import type { Clouds } from "../draw/clouds";
import type { Painter } from "../draw/painter";
import type { Probe } from "../draw/probe";
import { byId, make } from "../dom";
import type { Drawings, Texture } from "../engine/protocol";

const NONE = "This browser has no WebGL, so the surfaces cannot be rotated here.";
const LOST = "The browser has suspended WebGL. The surfaces stand still until it returns; everything else continues.";
const GONE =
  "The browser ended the drawing thread twice. Reload the page to see the surfaces again; everything else continues.";

/** The meaning of the colours if they are not those of the two views. */
const COLOURS: Partial<Record<Texture, string>> = {
  picture: "colours of the picture; grey: depth map",
  normals: "right red, up green, near blue",
  residual: "colour residual, image only:",
};

export class CloudPanel {
  readonly #box = byId("clouds-box", HTMLElement);
  readonly #note = byId("clouds-note", HTMLElement);
  readonly #style = byId("clouds-style", HTMLSelectElement);
  readonly #painter: Painter;
  readonly #probe: Probe;
  #clouds: Clouds | undefined;
  #drawings: Drawings | undefined;
  /** The surfaces of a pinned run, and its share of the width. */
  #pinned: Drawings | undefined;
  #wipe = 0;
  /** Whether the view is to be reset for the next surfaces. */
  #fresh = true;
  #opened = 0;

  constructor(painter: Painter, probe: Probe) {
    this.#painter = painter;
    this.#probe = probe;
    probe.listen(() => this.#mark());
    this.#style.addEventListener("change", () => this.#applyStyle());
    byId("clouds-home", HTMLButtonElement).addEventListener("click", () => this.#clouds?.home());
    const seen = new IntersectionObserver(
      (entries) => {
        if (!entries.some((entry) => entry.isIntersecting)) return;
        seen.disconnect();
        void this.#open(byId("clouds-canvas", HTMLCanvasElement));
      },
      { rootMargin: "200px" },
    );
    seen.observe(this.#box);
  }

  /** Announces that the next surfaces are those of another object. */
  lookAnew(): void {
    this.#fresh = true;
  }

  show(drawings: Drawings): void {
    this.#drawings = drawings;
    this.#name();
    this.#showAll();
  }

  /** Keeps the present surfaces, to be shown left of the wipe. */
  pin(): void {
    this.#pinned = this.#drawings;
    this.#box.toggleAttribute("data-pinned", true);
    this.#applyPin();
  }

  unpin(): void {
    this.#pinned = undefined;
    this.#name();
    this.#box.removeAttribute("data-pinned");
    this.#clouds?.unpin();
  }

  wipe(share: number): void {
    this.#wipe = share;
    this.#clouds?.wipe(share);
  }

  /** Shows the depth map's surface in another pose, or in the estimated one again. */
  pretend(pose: Pose | undefined): void {
    this.#clouds?.pretend(pose);
  }

  recolour(): void {
    this.#clouds?.recolour();
  }

  /** The legend of these colours; `range` is that of the residual. */
  colourBy(texture: Texture, range: HTMLElement): void {
    const words = COLOURS[texture];
    const legend = byId("clouds-legend", HTMLElement);
    for (const key of legend.querySelectorAll<HTMLElement>(".key")) key.hidden = words !== undefined;
    const own = byId("clouds-words", HTMLElement);
    own.hidden = words === undefined;
    own.textContent = words ?? "";
    if (texture === "residual") legend.append(range);
    else range.remove();
  }

  /** The legend names what is drawn: before the first iteration there is no shape from the image. */
  #name(): void {
    const isDrawn = [this.#drawings, this.#pinned].some((drawings) =>
      drawings?.surfaces.image.points.some(Number.isFinite),
    );
    byId("clouds-image", HTMLElement).toggleAttribute("data-none", !isDrawn);
  }

  #showAll(): void {
    const [drawings, clouds] = [this.#drawings, this.#clouds];
    if (!drawings || !clouds) return;
    const fresh = this.#fresh;
    this.#painter.request(clouds, () =>
      clouds.show(drawings.surfaces, drawings.poses.points, drawings.poses.seen, fresh),
    );
    this.#fresh = false;
  }

  #mark(): void {
    this.#clouds?.mark(this.#probe.answer?.points ?? { image: null, depth: null });
  }

  #applyStyle(): void {
    this.#clouds?.setStyle(this.#style.value === "points" ? "points" : "surfaces");
  }

  #applyPin(): void {
    if (this.#pinned) this.#clouds?.pin(this.#pinned.surfaces, this.#pinned.poses.points, this.#pinned.poses.seen);
    this.#clouds?.wipe(this.#wipe);
  }

  #say(words: string): void {
    this.#note.textContent = words;
    this.#note.hidden = words === "";
  }

  async #open(canvas: HTMLCanvasElement): Promise<void> {
    this.#opened++;
    try {
      const { Clouds } = await import("../draw/clouds");
      const hooks = { onLost: (lost: boolean) => this.#say(lost ? LOST : ""), onGone: () => this.#reopen() };
      const clouds = await Clouds.open(canvas, this.#box, hooks);
      this.#clouds = clouds;
      this.#say("");
      this.#listen(canvas, clouds);
      this.#applyStyle();
      this.#applyPin();
      this.#showAll();
    } catch {
      this.#say(NONE);
    }
  }

  #listen(canvas: HTMLCanvasElement, clouds: Clouds): void {
    canvas.addEventListener("pointermove", ({ offsetX, offsetY, buttons }) =>
      this.#probe.point(buttons === 0 ? clouds.pick(offsetX, offsetY) : null),
    );
    canvas.addEventListener("pointerleave", () => this.#probe.point(null));
    canvas.addEventListener("keydown", (event) => {
      const turn = { ArrowLeft: [-10, 0], ArrowRight: [10, 0], ArrowUp: [0, -10], ArrowDown: [0, 10] }[event.key];
      if (!turn) return;
      event.preventDefault();
      clouds.turn(turn[0] ?? 0, turn[1] ?? 0);
    });
  }

  /** A canvas cannot be taken back from the thread that has drawn on it, so a new canvas replaces it, once. */
  #reopen(): void {
    const clouds = this.#clouds;
    if (!clouds) return;
    clouds.end();
    this.#clouds = undefined;
    if (this.#opened > 1) return this.#say(GONE);
    const old = byId("clouds-canvas", HTMLCanvasElement);
    const { id, tabIndex } = old;
    const canvas = make("canvas", {
      id,
      tabindex: tabIndex,
      role: "img",
      "aria-label": old.getAttribute("aria-label") ?? "",
    });
    old.replaceWith(canvas);
    this.#fresh = true;
    void this.#open(canvas);
  }
}
