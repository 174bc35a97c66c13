/** `<bimodal-stereo>`: one run, one iteration per frame, in one worker. */

import type { BimodalStereoElement, ElementError, StereoPair } from "../../pkg/elements.js";
import type { Options, SampleRequest, StepReport } from "../../pkg/index.js";
import { GONE, onGone } from "../engine/alive";
import { Base } from "./base";
import type { Answer, Input, Order } from "./protocol";
import { startStereo, wasm } from "./threads";
import { StereoView } from "./view";

/** The scene of a sample if only its surface is named. */
const SCENE = { light: "window", angles: { beta: 30 }, noise: 0.01 } as const;

export class BimodalStereo extends Base implements BimodalStereoElement {
  static readonly observedAttributes = ["image", "depth", "mask", "unit", "sample", "paused", "charts"];
  protected readonly settable = [...BimodalStereo.observedAttributes, "options", "scene", "pair"];
  #worker: Worker | undefined;
  #view: StereoView | undefined;
  #options: Options = {};
  #scene: Partial<SampleRequest> = {};
  #pair: StereoPair | undefined;
  #report: StepReport | undefined;
  /** Whether the worker has the pair, and whether a step is under way. */
  #isOpen = false;
  #isBusy = false;
  #frame = 0;

  get image(): string {
    return this.text("image");
  }
  set image(value: string) {
    this.write("image", value);
  }
  get depth(): string {
    return this.text("depth");
  }
  set depth(value: string) {
    this.write("depth", value);
  }
  get mask(): string {
    return this.text("mask");
  }
  set mask(value: string) {
    this.write("mask", value);
  }
  get sample(): string {
    return this.text("sample");
  }
  set sample(value: string) {
    this.write("sample", value);
  }
  get unit(): number | undefined {
    return this.hasAttribute("unit") ? Number(this.getAttribute("unit")) : undefined;
  }
  set unit(value: number | undefined) {
    this.write("unit", value === undefined ? undefined : String(value));
  }
  get paused(): boolean {
    return this.hasAttribute("paused");
  }
  set paused(value: boolean) {
    this.toggleAttribute("paused", Boolean(value));
  }
  get charts(): boolean {
    return this.hasAttribute("charts");
  }
  set charts(value: boolean) {
    this.toggleAttribute("charts", Boolean(value));
  }
  get options(): Options {
    return this.#options;
  }
  set options(value: Options) {
    this.#options = value ?? {};
    this.restart();
  }
  get scene(): Partial<SampleRequest> {
    return this.#scene;
  }
  set scene(value: Partial<SampleRequest>) {
    this.#scene = value ?? {};
    this.restart();
  }
  get pair(): StereoPair | undefined {
    return this.#pair;
  }
  set pair(value: StereoPair | undefined) {
    this.#pair = value ?? undefined;
    this.restart();
  }
  get report(): StepReport | undefined {
    return this.#report;
  }

  play(): void {
    this.paused = false;
  }
  pause(): void {
    this.paused = true;
  }
  step(): void {
    this.pause();
    this.#ask();
  }

  attributeChangedCallback(name: string, before: string | null, now: string | null): void {
    if (before === now) return;
    if (name === "charts") return this.#view?.showCharts(this.charts);
    if (name !== "paused") return this.restart();
    this.#view?.showPaused(this.paused);
    this.#next();
  }

  protected stop(): void {
    cancelAnimationFrame(this.#frame);
    this.#worker?.terminate();
    this.#worker = undefined;
    this.#isOpen = this.#isBusy = false;
  }

  protected start(): void {
    this.#view ??= new StereoView(this.attachShadow({ mode: "open" }), {
      toggle: () => (this.paused ? this.play() : this.pause()),
      step: () => this.step(),
      restart: () => this.restart(),
    });
    this.#report = undefined;
    this.#view.clear(this.paused);
    this.#view.showCharts(this.charts);
    if (!this.#pair && this.sample === "" && (this.image === "" || this.depth === "")) return this.#missing();
    try {
      this.#worker = this.#spawn();
    } catch (error) {
      return this.#fault({ code: "init", message: `the worker cannot be started (${String(error)})` });
    }
    this.#send({ kind: "open", input: this.#input(), options: this.#options, wasm: wasm() });
  }

  /** An element that was just made has no attributes yet; a half of a pair is an error. */
  #missing(): void {
    if (this.image === "" && this.depth === "") return this.#view?.say("no image and no depth map");
    const field = this.image === "" ? "image" : "depth";
    this.#fault({ code: "missing", field, message: `${field}: the address is missing` });
  }

  #input(): Input {
    const absolute = (address: string) => (address === "" ? "" : new URL(address, this.baseURI).href);
    return {
      image: absolute(this.image),
      depth: absolute(this.depth),
      mask: absolute(this.mask),
      unit: this.unit,
      sample: this.sample === "" ? undefined : { ...SCENE, ...this.#scene, surface: this.sample },
      pair: this.#pair,
    };
  }

  #spawn(): Worker {
    const worker = startStereo();
    const isMine = () => worker === this.#worker;
    onGone(worker, () => {
      if (isMine()) this.#fault({ code: "lost", message: `This run stopped: ${GONE}.` });
    });
    worker.onmessage = ({ data }: MessageEvent<Answer>) => {
      if (isMine()) this.#receive(data);
    };
    worker.onerror = (event) => {
      event.preventDefault();
      if (isMine()) this.#fault({ code: "init", message: event.message || "The worker could not be loaded." });
    };
    return worker;
  }

  #send(order: Order): void {
    this.#worker?.postMessage(order);
  }

  /** The next step in the next frame, unless the run is paused or has ended. */
  #next(): void {
    cancelAnimationFrame(this.#frame);
    if (!this.paused) this.#frame = requestAnimationFrame(() => this.#ask());
  }

  #ask(): void {
    if (!this.#isOpen || this.#isBusy || (this.#report && this.#report.status !== "running")) return;
    this.#isBusy = true;
    this.#send({ kind: "step", withCharts: this.charts });
  }

  #receive(answer: Answer): void {
    if (answer.kind === "fault") return this.#fault(answer.fault);
    this.#view?.draw(answer.pictures);
    if (answer.kind === "opened") {
      this.#isOpen = true;
      this.#view?.say(this.paused ? "paused" : "running");
      return this.#next();
    }
    this.#isBusy = false;
    if (answer.panels) this.#view?.drawCharts(answer.panels);
    this.#take(answer.report);
  }

  #take(report: StepReport): void {
    const before = this.#report?.status;
    this.#report = report;
    this.#view?.show(report);
    this.tell("step", report);
    if (report.status !== before) this.tell("status", { status: report.status });
    if (report.status === "running") return this.#next();
    // The run has ended, so the worker is no longer needed.
    this.stop();
    this.tell("done", report);
  }

  #fault({ code, field, message, details }: ElementError): void {
    this.stop();
    this.#view?.complain(message);
    this.fail({ code, message, ...(field === undefined ? {} : { field }), ...(details && { details }) });
  }
}
