import type { Estimator as Raw } from "../target/wasm-bindgen/bimodal_stereo.js";
import { breathe } from "./breathe.js";
import { bindings, explained } from "./engine.js";
import { BimodalError, isPanic, refused } from "./errors.js";
import { checkDepth, checkDraw, checkImage, checkLayer, checkOptions, checkRestore, checkRun } from "./inputs.js";
import type { PlainOptions } from "./options.js";
import { copyOf, plainDepth, plainImage, plainOptions } from "./plain.js";
import { type Reached, checksumOf, opened, otherNumbers, saved, unusable } from "./saved.js";
import type {
  ColorImage,
  ColorImageInput,
  DepthMap,
  DepthMapInput,
  DrawOptions,
  EstimatorWarning,
  Layer,
  Options,
  RestoreOptions,
  RunOptions,
  StepReport,
} from "./types/index.js";
import type { Views } from "./workers/messages.js";
import { RefinementWorker, type Refinement } from "./workers/refinement.js";
import { SearchWorkers } from "./workers/search.js";

/** Smallest number of depth pixels for which a refinement worker saves time: a refinement then takes some milliseconds. */
const LEAST_SHARED = 96 * 96;

/** Whether a value is the 2D context of a canvas of a page or a worker. Environments without canvases have no context. */
function isContext(value: unknown): boolean {
  const { CanvasRenderingContext2D: Own, OffscreenCanvasRenderingContext2D: Offscreen } = globalThis;
  return (Own !== undefined && value instanceof Own) || (Offscreen !== undefined && value instanceof Offscreen);
}

/** An input as a plain object. Its own members are checked before the conversion, and inherited members after it. */
function checked<T, Plain>(check: (value: unknown) => void, plain: (input: T) => Plain, input: T): Plain {
  check(input);
  const own = plain(input);
  check(own);
  return own;
}

/** The input of an estimator. */
export interface Given {
  /** The colour image, with its camera as members. */
  image: ColorImage;
  /** The depth map, with its camera as members. */
  depth: DepthMap;
  /** The options, with an initial pose as members. */
  options: Options;
}

/**
 * Shape, light and pose from one colour image and one depth map, one iteration after the other. Every returned array is a copy. An
 * estimator owns memory that the garbage collector frees too late or never, so call `free()`, or declare it with `using`.
 */
export class Estimator {
  #raw: Raw | undefined;
  #broken = false;
  /** The options of the current loop. */
  #options: PlainOptions;
  /** Copies, because the caller may change the pair before it is saved or sent to a worker. */
  readonly #pair: Views;
  #warnings: EstimatorWarning[] = [];
  /** Whether anything has been run since the start, and how many slices of the search this thread has done. */
  #begun = false;
  #slices = 0;
  readonly #searchWorkers: SearchWorkers | undefined;
  readonly #refinementWorker: RefinementWorker | undefined;

  constructor(image: ColorImageInput, depth: DepthMapInput, options: Options = {}) {
    const [ownImage, ownDepth] = [checked(checkImage, plainImage, image), checked(checkDepth, plainDepth, depth)];
    const own = checked(checkOptions, plainOptions, options);
    this.#options = own;
    const { Estimator: Binding } = bindings();
    try {
      this.#raw = new Binding(ownImage, ownDepth, own);
    } catch (error) {
      throw explained(error);
    }
    const workers = Math.min((own.workers ?? 1) - 1, this.#raw.workersAfforded());
    this.#pair = { image: copyOf(ownImage, []), depth: copyOf(ownDepth, []) };
    if (workers > 0) {
      const unavailable = (reason: unknown) => this.#warn(reason);
      this.#searchWorkers = new SearchWorkers(
        workers,
        this.#pair,
        {
          take: () => this.#call((raw) => raw.takeTask()),
          accept: (result) => this.#call((raw) => raw.accept(result)),
        },
        unavailable,
      );
      if (depth.width * depth.height >= LEAST_SHARED)
        this.#refinementWorker = new RefinementWorker(this.#pair, unavailable);
      this.#begin();
    }
  }

  /** Runs one iteration, or one slice of the search while the search lasts. A search around an initial pose belongs to the first iteration. */
  step(): StepReport {
    const answer = this.#refinementWorker?.answer;
    if (answer) this.#call((raw) => raw.stepHalfway());
    return this.#finish(answer);
  }

  /** Runs one stage of an iteration, or one slice of the search; the report names the stage. */
  stepStage(): StepReport {
    this.#take(this.#refinementWorker?.answer);
    return this.#after(this.#call((raw) => raw.stepStage()));
  }

  /** Runs as many steps as fit into the time, at least one. In a search around an initial pose a step is one slice, as in `run`. */
  stepFor(milliseconds: number): StepReport {
    if (typeof milliseconds !== "number" || Number.isNaN(milliseconds)) {
      throw new BimodalError("type", "milliseconds: must be a number", "milliseconds", refused(milliseconds));
    }
    const end = performance.now() + milliseconds;
    let report = this.#advance();
    while (report.status === "running" && performance.now() < end) report = this.#advance();
    return report;
  }

  /**
   * Steps until the loop ends, at most `maxIterations` times, and lets events pass between the steps. When `signal`
   * aborts, the promise is rejected with its reason and the estimator stays as the last step left it.
   */
  async run(options: RunOptions = {}): Promise<StepReport> {
    checkRun(options);
    const { maxIterations = Infinity, signal, onStep } = options;
    signal?.throwIfAborted();
    let report = this.report;
    for (let done = 0; report.status === "running" && done < maxIterations; done++) {
      report = await this.#stepTogether();
      onStep?.(report);
      await breathe();
      signal?.throwIfAborted();
    }
    return report;
  }

  /**
   * Yields one report for each remaining step; the last one has the final status. Events pass between the steps. Leaving the iteration
   * early keeps the result so far; another iteration, or `run`, continues from there.
   */
  async *[Symbol.asyncIterator](): AsyncGenerator<StepReport, void, undefined> {
    for (let { status } = this.report; status === "running"; ) {
      const report = await this.#stepTogether();
      ({ status } = report);
      yield report;
      await breathe();
    }
  }

  /** Returns to the initial state with the same views and, if given, new options. */
  reset(options?: Options): void {
    const own = options === undefined ? undefined : checked(checkOptions, plainOptions, options);
    const workers = this.#options.workers ?? 1;
    if ((own?.workers ?? workers) !== workers) {
      const message =
        "options.workers: threads receive the views when they are created; create a new estimator to change their number";
      throw new BimodalError("unsupported", message, "options.workers", refused(own?.workers));
    }
    this.#call((raw) => raw.reset(own));
    if (own) this.#options = { ...own, workers };
    [this.#begun, this.#slices] = [false, 0];
    this.#begin();
  }

  /** Features that are missing in this environment: "workers-unavailable" if no other thread could be started. */
  get warnings(): readonly EstimatorWarning[] {
    return this.#warnings;
  }

  /** The report of the last step; before the first one, that of the start. */
  get report(): StepReport {
    return this.#call((raw) => raw.report());
  }

  /**
   * Normals of the image view, 3*w*h interleaved, NaN outside the mask. Black and saturated pixels are removed from the mask, because their
   * colour is unknown.
   */
  imageNormals(): Float32Array {
    return this.#call((raw) => raw.imageNormals());
  }

  /** Depth of the image view, w*h, NaN outside the mask. If the view is orthographic, the median is zero. */
  imageDepth(): Float32Array {
    return this.#call((raw) => raw.imageDepth());
  }

  /** Refined normals of the depth view, 3*w*h interleaved. */
  depthNormals(): Float32Array {
    return this.#call((raw) => raw.depthNormals());
  }

  /** Refined depth of the depth view, w*h. */
  refinedDepth(): Float32Array {
    return this.#call((raw) => raw.refinedDepth());
  }

  /** For each image pixel the index of its depth pixel, or -1. */
  correspondence(): Int32Array {
    return this.#call((raw) => raw.correspondence());
  }

  /** |log S - predicted| for each image pixel, NaN outside the mask: the length of log S - albedo - shading over R, G, B. */
  residual(): Float32Array {
    return this.#call((raw) => raw.residual());
  }

  /**
   * Log albedo of the image view (natural logarithm), 3*w*h interleaved, mean 0 over the mask in each channel, NaN outside it. Zero if a
   * single albedo explains the colours, with `registration: "icp"`, and before the pose has converged.
   */
  albedo(): Float32Array {
    return this.#call((raw) => raw.albedo());
  }

  /**
   * Log shading of the image view, 3*w*h interleaved, NaN outside the mask and where there is no normal yet. The light includes the
   * exposure; log S - albedo - shading is noise and model error.
   */
  shading(): Float32Array {
    return this.#call((raw) => raw.shading());
  }

  /**
   * Draws a layer into the top left corner of a canvas, one canvas pixel for each pixel of the view. Pixels without a value stay
   * transparent. The canvas keeps its size, which should be that of the view.
   */
  draw(
    context: CanvasRenderingContext2D | OffscreenCanvasRenderingContext2D,
    layer: Layer,
    options: DrawOptions = {},
  ): void {
    if (!isContext(context)) throw new BimodalError("type", "context: must be the 2D context of a canvas", "context");
    checkLayer(layer);
    checkDraw(options);
    const { range, map = "viridis" } = options;
    this.#call((raw) => raw.draw(context, layer, range && Float64Array.from(range), map));
  }

  /** The 27 coefficients of the light: R1..9, G1..9, B1..9. */
  light(): Float64Array {
    return this.#call((raw) => raw.light());
  }

  /** Points of one view, 3*n. The points of either view are in the colour view's frame. */
  points(view: "image" | "depth"): Float32Array {
    if (view !== "image" && view !== "depth") {
      throw new BimodalError("option", 'view: must be "image" or "depth"', "view");
    }
    return this.#call((raw) => raw.points(view));
  }

  /**
   * The rotations that the search has tried so far, 4*n: alpha, beta and gamma in degrees, and the score, which is higher if the pose fits
   * the image better. Empty before the search and after it.
   */
  searchScores(): Float32Array {
    return this.#call((raw) => raw.searchScores());
  }

  /**
   * The registration that found the pose. For the project's tests only, not part of the contract. @internal
   */
  get registeredBy(): string {
    return this.#call((raw) => raw.registeredBy());
  }

  /** The input, as copies: both views, and the options of the last `reset`. */
  get given(): Given {
    return structuredClone({ ...this.#pair, options: this.#options });
  }

  /**
   * The run as bytes: both views, the options and the number of steps done. A repeated run is bit-identical, and `restore` relies on that.
   */
  save(): Uint8Array {
    const { stage, iteration, status } = this.report;
    const reached = { begun: this.#begun, stage, iteration, slices: this.#slices, ended: status !== "running" };
    return saved({ ...this.#pair, options: this.#options, reached, found: checksumOf(this) });
  }

  /**
   * An estimator in the bit-identical state of the saved one. Restoring takes as long as the run had taken. A search that was interrupted
   * may be at a different point if threads shared it; it ends in the same pose.
   *
   * @throws BimodalError of code "state": the bytes are not a saved run, are damaged, have another format version, or hold numbers that
   * this build does not reproduce.
   */
  static restore(state: Uint8Array): Estimator {
    const restoring = Estimator.#restoring(state);
    let next = restoring.next();
    while (!next.done) next = restoring.next();
    return next.value;
  }

  /** As `restore`, but lets events pass while the run is repeated. When `signal` aborts, the promise is rejected with its reason. */
  static async restoreAsync(state: Uint8Array, options: RestoreOptions = {}): Promise<Estimator> {
    checkRestore(options);
    const { signal } = options;
    signal?.throwIfAborted();
    const restoring = Estimator.#restoring(state);
    let next = restoring.next();
    while (!next.done) {
      await breathe();
      next = signal?.aborted ? restoring.throw(signal.reason) : restoring.next();
    }
    return next.value;
  }

  /** Repeats a saved run, stage by stage, and frees it if it is cancelled. */
  static *#restoring(state: Uint8Array): Generator<void, Estimator, undefined> {
    const { image, depth, options, reached, found } = opened(state);
    const estimator = unusable(() => new Estimator(image, depth, options));
    try {
      yield* estimator.#repeat(reached);
      // The number of slices that a search has completed depends on the number of threads that share it.
      const isWithinSearch = reached.stage === "search" && !reached.ended;
      if (!isWithinSearch && checksumOf(estimator) !== found) throw otherNumbers();
      return estimator;
    } catch (error) {
      estimator.free();
      throw error;
    }
  }

  /** Frees the memory. Further calls do nothing. */
  free(): void {
    const raw = this.#raw;
    this.#raw = undefined;
    this.#searchWorkers?.end();
    this.#refinementWorker?.end();
    // A crashed estimator cannot be freed: wasm-bindgen still counts it as borrowed by the call that crashed.
    if (!this.#broken) raw?.free();
  }

  /** The same as `free`, for `using`. */
  [Symbol.dispose](): void {
    this.free();
  }

  /** Warns once: without other threads an estimator takes longer, but finds the same result. */
  #warn(reason: unknown): void {
    if (this.#warnings.length > 0) return;
    const message = `options.workers: no other thread could be started (${reason instanceof Error ? reason.message : String(reason)}); this thread does all the work`;
    this.#warnings = [{ code: "workers-unavailable", message, field: "options.workers" }];
    console.warn(`bimodal-stereo: workers-unavailable: ${message}`);
  }

  /** Restarts the workers: those of the search if the loop starts with one, or else the refinement worker. */
  #begin(): void {
    this.#searchWorkers?.end();
    this.#refinementWorker?.end();
    if ((this.#options.start ?? "search") === "search") this.#searchWorkers?.begin(this.#options);
    else this.#share();
  }

  /**
   * The refinement worker starts with the first iteration, because it needs time to get ready. It does not start with the paper's
   * registration, which changes the pose in every iteration, so that a refinement for the previous pose would be useless.
   */
  #share(): void {
    if (this.#options.registration !== "icp") this.#refinementWorker?.begin(this.#options);
  }

  /** Runs as many stages as another run has, with the same views and options. */
  *#repeat({ begun, stage, iteration, slices, ended }: Reached): Generator<void, void, undefined> {
    if (!begun) return;
    let report: StepReport;
    const isThere = () => !ended && report.stage === stage && report.iteration === iteration && this.#slices >= slices;
    do {
      report = this.#after(this.#call((raw) => raw.stepStage()));
      yield;
    } while (report.status === "running" && !isThere());
  }

  /** As `step`, but a search around an initial pose is done in slices; `step` does it as a whole. */
  #advance(): StepReport {
    if (this.#refinementWorker?.answer) return this.step();
    return this.#after(this.#call((raw) => raw.advance()));
  }

  /** A step that waits for the refinement worker, if it is busy. */
  async #stepTogether(): Promise<StepReport> {
    if (!this.#refinementWorker?.isBusy) return this.#advance();
    this.#call((raw) => raw.stepHalfway());
    await this.#refinementWorker.settled();
    return this.#finish(this.#refinementWorker.answer);
  }

  /** The rest of a step, with the result of the refinement worker. */
  #finish(answer: Refinement | undefined): StepReport {
    this.#take(answer);
    return this.#after(this.#call((raw) => raw.step()));
  }

  #take(answer: Refinement | undefined): void {
    if (answer) this.#call((raw) => raw.acceptRefinement(answer.shape, answer.planes));
  }

  /** Sends the workers their next tasks, or ends them. */
  #after(report: StepReport): StepReport {
    this.#begun = true;
    if (report.stage === "search") this.#slices++;
    if (report.status !== "running") {
      this.#searchWorkers?.end();
      this.#refinementWorker?.end();
    } else if (report.stage === "search") {
      this.#searchWorkers?.feed(this.#options);
    } else {
      this.#searchWorkers?.end();
      this.#share();
      if (report.stage === "refinement")
        this.#refinementWorker?.ask((held) => this.#call((raw) => raw.refinementTask(held)));
    }
    return report;
  }

  #call<T>(method: (raw: Raw) => T): T {
    if (this.#raw === undefined) throw new BimodalError("freed", "this estimator has been freed");
    if (this.#broken) {
      throw new BimodalError("poisoned", "this estimator failed in an earlier call; free it and create another one");
    }
    try {
      return method(this.#raw);
    } catch (error) {
      this.#broken = isPanic(error);
      throw explained(error);
    }
  }
}
