/** All pictures of the Lab: its canvases, the surfaces, and the charts. */

import type { Pose, StepReport } from "../../pkg/index.js";
import { Painter } from "../draw/painter";
import { Probe } from "../draw/probe";
import { Scale } from "../draw/scale";
import { View, type Content } from "../draw/view";
import { byId, make } from "../dom";
import { textured, textures, type Texture } from "../draw/texture";
import type { Charts } from "../draw/charts";
import type { Clouds } from "../draw/clouds";
import type { Frame, Opened, Picture } from "../engine/protocol";

export class Gallery {
  readonly #painter = new Painter();
  readonly #box = byId("lab", HTMLElement);
  readonly #figures: HTMLElement[] = [];
  readonly #picture: View;
  readonly #imageNormals: View;
  readonly #imageDepth: View;
  readonly #albedo: View;
  readonly #shading: View;
  readonly #residual: View;
  readonly #given: View;
  readonly #refinedDepth: View;
  readonly #depthNormals: View;
  readonly #errors: Readonly<Record<keyof NonNullable<Frame["errors"]>, View>>;
  #texture: Texture = "view";
  #colours: Picture | undefined;
  #units: Opened["units"] = { image: "px", depth: "px" };
  #clouds: Clouds | undefined;
  #charts: Charts | undefined;
  #frame: Frame | undefined;
  #history: readonly StepReport[] = [];
  /** Whether the surfaces are to be looked at anew. */
  #fresh = true;

  constructor() {
    const image = new Probe();
    const depth = new Probe();
    // Led by the refined depth, from which flying pixels are trimmed: they would stretch the range.
    const depths = new Scale("viridis");
    const view = (parent: string, probe: Probe, title: string, description: string, content: Content): View => {
      const built = new View({ title, description, content, probe, painter: this.#painter });
      this.#place(built.element, parent, title);
      return built;
    };
    this.#picture = view("inputs-views", image, "Colour", "the colour image as it was given", { kind: "picture", legend: "as it was given" });
    this.#imageNormals = view("image-views", image, "Normals", "normals found from shading in the colour image", { kind: "normals" });
    this.#imageDepth = view("image-views", image, "Depth", "depth of the colour image, integrated from its normals", { kind: "scalar", scale: new Scale("viridis"), leads: true });
    this.#albedo = view("image-views", image, "Albedo", "paint of the object, the colours without light and shadow", { kind: "picture", legend: "grey if all is one paint" });
    this.#shading = view("image-views", image, "Shading", "what the light makes of the shape, the colours without paint", { kind: "picture", legend: "light on shape" });
    this.#given = view("inputs-views", depth, "Given depth", "the depth map as it was given", { kind: "scalar", scale: depths, leads: false });
    this.#refinedDepth = view("depth-views", depth, "Refined depth", "the depth map after refinement", { kind: "scalar", scale: depths, leads: true });
    this.#depthNormals = view("depth-views", depth, "Refined normals", "normals of the depth map after refinement", { kind: "normals" });
    this.#place(byId("clouds", HTMLElement), undefined, "Both surfaces");
    this.#residual = view("image-views", image, "Colour residual", "how far the predicted colours are from the image", { kind: "scalar", scale: new Scale("magma", true), leads: true });
    const error = (title: string, probe: Probe, description: string): View =>
      view("error-views", probe, title, description, { kind: "scalar", scale: new Scale("magma", true), leads: true });
    this.#errors = {
      imageNormals: error("Error of normals", image, "angle between the colour view's normals and the true ones"),
      imageDepth: error("Error of depth", image, "distance of the colour view's depth from the true one, both about their middles"),
      refinedDepth: error("Refinement error", depth, "distance of the refined depth from the true one"),
    };
    void this.#loadCharts();
    this.#loadCloudsWhenSeen();
    this.#buildChoices();
  }

  /** How the surfaces are drawn, and what they are coloured by. */
  #buildChoices(): void {
    const style = byId("clouds-style", HTMLSelectElement);
    style.addEventListener("change", () => this.#clouds?.setStyle(style.value === "points" ? "points" : "surfaces"));
    const texture = byId("clouds-texture", HTMLSelectElement);
    texture.addEventListener("change", () => {
      this.#texture = textures.find((each) => each === texture.value) ?? "view";
      this.#showClouds();
    });
  }

  /** Resolves when the new input is on the screen; `fresh` looks at its surfaces from the front. */
  open({ picture, given, units, frame }: Opened, fresh: boolean): Promise<void> {
    this.#units = units;
    this.#fresh ||= fresh;
    this.preview(picture);
    this.#given.show(given, units.depth);
    byId("errors", HTMLElement).hidden = frame.errors === null;
    return this.show(frame, []);
  }

  /** Another picture, of which nothing has been computed yet. */
  preview(picture: Picture): void {
    this.#colours = picture;
    this.#picture.show(picture);
  }

  /** The depth map's surface under another pose than its own, or its own again. */
  pretend(pose: Pose | undefined): void {
    this.#clouds?.pretend(pose);
  }

  /** Resolves when the frame is on the screen, which is when the next one may be asked for. */
  show(frame: Frame, history: readonly StepReport[]): Promise<void> {
    this.#frame = frame;
    this.#history = history;
    this.#imageNormals.show(frame.imageNormals);
    this.#imageDepth.show(frame.imageDepth, this.#units.image);
    this.#albedo.show(frame.albedo);
    this.#shading.show(frame.shading);
    this.#residual.show(frame.residual, "log");
    this.#refinedDepth.show(frame.refinedDepth, this.#units.depth);
    this.#depthNormals.show(frame.depthNormals);
    if (frame.errors) {
      this.#errors.imageNormals.show(frame.errors.imageNormals, "°");
      this.#errors.imageDepth.show(frame.errors.imageDepth, this.#units.image);
      this.#errors.refinedDepth.show(frame.errors.refinedDepth, this.#units.depth);
    }
    this.#showClouds();
    this.#showCharts();
    return this.#painter.drawn();
  }

  recolour(): void {
    this.#clouds?.recolour();
    this.#charts?.recolour();
  }

  /** One view alone and large, or all again. Views count from 1. */
  enlarge(number: number | null): void {
    const chosen = number === null ? undefined : this.#figures[number - 1];
    const wasOpen = chosen?.hasAttribute("data-large") ?? true;
    for (const figure of this.#figures) figure.toggleAttribute("data-large", figure === chosen && !wasOpen);
    this.#box.toggleAttribute("data-single", !wasOpen);
    for (const figure of this.#figures) {
      const button = figure.querySelector(".enlarge");
      button?.setAttribute("aria-pressed", String(figure.hasAttribute("data-large")));
    }
    if (wasOpen || !chosen) return;
    chosen.querySelector("canvas")?.focus({ preventScroll: true });
    // The others have made room above it.
    chosen.scrollIntoView({ block: "nearest" });
  }

  get count(): number {
    return this.#figures.length;
  }

  #place(figure: HTMLElement, parent: string | undefined, title: string): void {
    this.#figures.push(figure);
    const number = this.#figures.length;
    // The tenth has the key 0; those after it have none.
    const key = number > 10 ? "+" : String(number % 10);
    const hint = number > 10 ? "Enlarge" : `Enlarge (${key})`;
    const button = make("button", { type: "button", class: "quiet enlarge", "aria-pressed": "false", "aria-label": number > 10 ? `Enlarge ${title}` : `Enlarge ${title}, key ${key}`, title: hint }, key);
    button.addEventListener("click", () => this.enlarge(number));
    figure.querySelector("figcaption")?.prepend(button);
    if (parent) byId(parent, HTMLElement).append(figure);
  }

  #showClouds(): void {
    const [frame, clouds, picture] = [this.#frame, this.#clouds, this.#colours];
    const report = frame?.reports.at(-1);
    if (!frame || !report || !clouds || !picture) return;
    const fresh = this.#fresh;
    this.#painter.request(clouds, () => {
      const { image, depth } = textured(frame, picture, this.#texture);
      clouds.show(image, depth, frame.depthPose, report.pose, fresh);
    });
    this.#fresh = false;
  }

  #showCharts(): void {
    const charts = this.#charts;
    if (charts) this.#painter.request(charts, () => charts.show(this.#history));
  }

  async #loadCharts(): Promise<void> {
    const { Charts } = await import("../draw/charts");
    this.#charts = new Charts(byId("objective-chart", HTMLElement), byId("rotation-chart", HTMLElement));
    this.#showCharts();
  }

  #loadCloudsWhenSeen(): void {
    const box = byId("clouds-box", HTMLElement);
    const seen = new IntersectionObserver((entries) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      seen.disconnect();
      void this.#loadClouds(box);
    }, { rootMargin: "200px" });
    seen.observe(box);
  }

  async #loadClouds(box: HTMLElement): Promise<void> {
    const canvas = byId("clouds-canvas", HTMLCanvasElement);
    const fallback = byId("clouds-note", HTMLElement);
    try {
      const { Clouds } = await import("../draw/clouds");
      const clouds = await Clouds.open(canvas, box);
      this.#clouds = clouds;
      fallback.hidden = true;
      canvas.addEventListener("keydown", (event) => {
        const turn = { ArrowLeft: [-10, 0], ArrowRight: [10, 0], ArrowUp: [0, -10], ArrowDown: [0, 10] }[event.key];
        if (!turn) return;
        event.preventDefault();
        clouds.turn(turn[0] ?? 0, turn[1] ?? 0);
      });
      byId("clouds-home", HTMLButtonElement).addEventListener("click", () => clouds.home());
      clouds.setStyle(byId("clouds-style", HTMLSelectElement).value === "points" ? "points" : "surfaces");
      this.#showClouds();
    } catch {
      fallback.textContent = "This browser offers no WebGL, so the clouds cannot be turned here.";
    }
  }
}
