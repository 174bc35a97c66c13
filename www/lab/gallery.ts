/** All pictures of the Lab: its canvases, the surfaces, and the charts. */

import type { Pose, StepReport } from "../../pkg/index.js";
import { Card } from "../draw/card";
import type { Chart } from "../draw/charts";
import { Painter } from "../draw/painter";
import { Probe, type Asked } from "../draw/probe";
import { Scale } from "../draw/scale";
import { View, type Content } from "../draw/view";
import { byId, make, nextFrame, nextTask } from "../dom";
import { CloudPanel } from "./cloudpanel";
import {
  SCALES,
  TEXTURES,
  type Frame,
  type Look,
  type Opened,
  type Painted,
  type Probed,
  type ScaleName,
  type Drawings,
  type Texture,
  type ViewName,
} from "../engine/protocol";

/** Requests that pictures send to the worker; a hidden picture sends none. */
export interface GalleryHooks {
  look(look: Look): Promise<Drawings | undefined>;
  probe(asked: Asked): Promise<Probed | undefined>;
}

export class Gallery {
  #hooks: GalleryHooks = { look: () => Promise.resolve(undefined), probe: () => Promise.resolve(undefined) };
  readonly #painter = new Painter();
  readonly #box = byId("lab", HTMLElement);
  /** The pinned run's share of the width; the style sheet has the same initial value. */
  #wipe = 0.5;
  readonly #figures: HTMLElement[] = [];
  readonly #probe = new Probe((asked) => this.#hooks.probe(asked));
  readonly #card = new Card(this.#probe);
  readonly #scales: Readonly<Record<ScaleName, Scale>>;
  readonly #views: Readonly<Record<ViewName, View>>;
  #texture: Texture = "view";
  #units: Opened["units"] = { image: "px", depth: "px" };
  readonly #clouds: CloudPanel;
  #charts: readonly Chart[] = [];
  #history: readonly StepReport[] = [];
  #pinned: readonly StepReport[] = [];
  /** The scroll position of the page before one view was enlarged. */
  #top = 0;
  #isLooking = false;
  #looksAgain = false;

  constructor() {
    const isError = (scale: ScaleName): boolean => scale === "residual" || scale.endsWith("Error");
    this.#scales = Object.fromEntries(
      SCALES.map((name) => [name, new Scale(isError(name) ? "magma" : "viridis", () => void this.#look())]),
    ) as Record<ScaleName, Scale>;
    const view = (parent: string, name: ViewName, title: string, description: string, content: Content): View => {
      const built = new View({ name, title, description, content, probe: this.#probe, painter: this.#painter });
      this.#place(built.element, parent, title);
      return built;
    };
    const scalar = (scale: ScaleName): Content => ({ kind: "scalar", scale: this.#scales[scale] });
    const picture = view("inputs-views", "picture", "Colour", "the colour image as supplied", {
      kind: "picture",
      legend: "as supplied",
    });
    const imageNormals = view(
      "image-views",
      "imageNormals",
      "Normals",
      "normals estimated from the shading of the colour image",
      { kind: "normals" },
    );
    const imageDepth = view(
      "image-views",
      "imageDepth",
      "Depth",
      "depth of the colour image, integrated from its normals",
      scalar("imageDepth"),
    );
    const albedo = view(
      "image-views",
      "albedo",
      "Albedo",
      "albedo of the object: its colours without light and shadow",
      { kind: "picture", legend: "uniform grey if the object has one colour" },
    );
    const shading = view(
      "image-views",
      "shading",
      "Shading",
      "the effect of the light on the shape: the colours without albedo",
      { kind: "picture", legend: "lighting only" },
    );
    const given = view("inputs-views", "given", "Given depth", "the depth map as supplied", scalar("refinedDepth"));
    const refinedDepth = view(
      "depth-views",
      "refinedDepth",
      "Refined depth",
      "the depth map after refinement",
      scalar("refinedDepth"),
    );
    const depthNormals = view(
      "depth-views",
      "depthNormals",
      "Refined normals",
      "normals of the depth map after refinement",
      { kind: "normals" },
    );
    this.#place(byId("clouds", HTMLElement), undefined, "Both surfaces");
    const residual = view(
      "image-views",
      "residual",
      "Colour residual",
      "difference between the predicted colours and the image",
      scalar("residual"),
    );
    const normalError = view(
      "error-views",
      "normalError",
      "Error of normals",
      "angle between the colour view's normals and the true ones",
      scalar("normalError"),
    );
    const depthError = view(
      "error-views",
      "depthError",
      "Error of depth",
      "difference between the colour view's depth and the true one, each relative to its mean",
      scalar("depthError"),
    );
    const refinementError = view(
      "error-views",
      "refinementError",
      "Refinement error",
      "difference between the refined depth and the true one",
      scalar("refinementError"),
    );
    this.#views = {
      picture,
      imageNormals,
      imageDepth,
      albedo,
      shading,
      residual,
      given,
      refinedDepth,
      depthNormals,
      normalError,
      depthError,
      refinementError,
    };
    this.#clouds = new CloudPanel(this.#painter, this.#probe);
    const texture = byId("clouds-texture", HTMLSelectElement);
    const range = this.#scales.residual.legend("the surfaces' residual").element;
    texture.addEventListener("change", () => {
      this.#texture = TEXTURES.find((each) => each === texture.value) ?? "view";
      this.#clouds.colourBy(this.#texture, range);
      void this.#look();
    });
  }

  /** Registers the handler of its requests. */
  serve(hooks: GalleryHooks): void {
    this.#hooks = hooks;
    void this.#loadCharts();
  }

  /** The next surfaces are seen from the front. */
  lookAnew(): void {
    this.#clouds.lookAnew();
  }

  /** The visitor's choices for drawing the surfaces. */
  get look(): Look {
    const fixed = SCALES.flatMap((name) => (this.#scales[name].fixed ? [[name, this.#scales[name].fixed]] : []));
    return { ranges: Object.fromEntries(fixed) as Look["ranges"], texture: this.#texture };
  }

  /** Requests a redraw of everything; if several requests arrive in the meantime, the last one counts. */
  async #look(): Promise<void> {
    this.#looksAgain = true;
    if (this.#isLooking) return;
    this.#isLooking = true;
    while (this.#looksAgain) {
      this.#looksAgain = false;
      const drawings = await this.#hooks.look(this.look);
      if (drawings) this.#see(drawings);
    }
    this.#isLooking = false;
  }

  /** Resolves when the new input is on the screen; `fresh` looks at its surfaces from the front. */
  open({ units, measured, frame }: Opened, fresh: boolean): Promise<void> {
    this.#units = this.#card.units = units;
    if (fresh) this.#clouds.lookAnew();
    // The pixels of another input are different, so the probe is reset.
    if (fresh) this.#probe.point(null);
    byId("errors", HTMLElement).hidden = !measured;
    return this.show(frame, []);
  }

  /** Announces another picture, for which nothing has been computed yet. */
  preview(picture: Painted): void {
    this.#views.picture.show(picture);
  }

  /** Shows the depth map's surface under another pose, or again under its own. */
  pretend(pose: Pose | undefined): void {
    this.#clouds.pretend(pose);
  }

  /** Resolves when the frame is on the screen; only then the next one may be requested. */
  show(frame: Frame, history: readonly StepReport[]): Promise<void> {
    this.#history = history;
    this.#see(frame);
    this.#showCharts();
    this.#probe.refresh();
    return this.#painter.drawn();
  }

  #see(drawings: Drawings): void {
    const { image, depth } = this.#units;
    const units: Partial<Record<ViewName, string>> = {
      imageDepth: image,
      residual: "log",
      given: depth,
      refinedDepth: depth,
      normalError: "°",
      depthError: image,
      refinementError: depth,
    };
    for (const name of SCALES) this.#scales[name].follow(drawings.ranges[name]);
    for (const [name, painted] of Object.entries(drawings.views) as [ViewName, Painted][])
      this.#views[name].show(painted, units[name]);
    this.#clouds.show(drawings);
  }

  /** Keeps this run's pictures and curves for comparison with later runs. */
  pin(history: readonly StepReport[]): void {
    for (const view of Object.values(this.#views)) view.pin();
    this.#clouds.pin();
    this.#pinned = [...history];
    this.#showCharts();
  }

  unpin(): void {
    for (const view of Object.values(this.#views)) view.unpin();
    this.#clouds.unpin();
    this.#pinned = [];
    this.#showCharts();
  }

  /** Share of each picture's width that shows the pinned run. */
  wipe(share: number): void {
    // The same value is not set again, because that would recompute the styles of the whole page.
    if (share !== this.#wipe) this.#box.style.setProperty("--wipe", `${100 * share}%`);
    this.#wipe = share;
    this.#clouds.wipe(share);
  }

  /** The charts change their colours after the page, because both at once would be a long task. */
  async recolour(): Promise<void> {
    this.#clouds.recolour();
    await nextFrame();
    for (const chart of this.#charts) this.#painter.request(chart, () => chart.recolour());
  }

  /** Shows one view alone and large, or all views again. Views count from 1. */
  enlarge(number: number | null): void {
    const chosen = number === null ? undefined : this.#figures[number - 1];
    const wasOpen = chosen?.hasAttribute("data-large") ?? true;
    const wasSingle = this.#box.hasAttribute("data-single");
    if (!wasSingle) this.#top = scrollY;
    for (const figure of this.#figures) figure.toggleAttribute("data-large", figure === chosen && !wasOpen);
    this.#box.toggleAttribute("data-single", !wasOpen);
    for (const figure of this.#figures) {
      const button = figure.querySelector(".enlarge");
      button?.setAttribute("aria-pressed", String(figure.hasAttribute("data-large")));
    }
    if (wasOpen || !chosen) {
      // All other views are visible again, and the scroll position is restored.
      if (wasSingle) scrollTo({ top: this.#top, behavior: "instant" });
      return;
    }
    chosen.querySelector("canvas")?.focus({ preventScroll: true });
    // The page has scrolled, because the views above the chosen one are visible again.
    chosen.scrollIntoView({ block: "nearest" });
  }

  get count(): number {
    return this.#figures.length;
  }

  #place(figure: HTMLElement, parent: string | undefined, title: string): void {
    this.#figures.push(figure);
    const number = this.#figures.length;
    // The tenth view has the key 0; later views have none.
    const key = number > 10 ? "+" : String(number % 10);
    const hint = number > 10 ? "Enlarge" : `Enlarge (${key})`;
    const button = make(
      "button",
      {
        type: "button",
        class: "quiet enlarge",
        "aria-pressed": "false",
        "aria-label": number > 10 ? `Enlarge ${title}` : `Enlarge ${title}, key ${key}`,
        title: hint,
      },
      key,
    );
    button.addEventListener("click", () => this.enlarge(number));
    figure.querySelector("figcaption")?.prepend(button);
    if (parent) byId(parent, HTMLElement).append(figure);
  }

  #showCharts(): void {
    for (const chart of this.#charts) this.#painter.request(chart, () => chart.show(this.#history, this.#pinned));
  }

  /** Runs after the views are on the page, each in a separate task, so that no click waits for all of them. */
  async #loadCharts(): Promise<void> {
    await nextTask();
    const { Chart } = await import("../draw/charts");
    const charts: Chart[] = [];
    for (const build of [
      () => Chart.objective(byId("objective-chart", HTMLElement)),
      () => Chart.rotation(byId("rotation-chart", HTMLElement)),
    ]) {
      await nextTask();
      charts.push(build());
    }
    for (const chart of charts) {
      await nextFrame();
      chart.begin();
    }
    this.#charts = charts;
    this.#showCharts();
  }
}
