/** The types of the custom elements. Their code is in www/elements, which is bundled after this package. */
import type { ErrorDetails } from "./errors.js";
import type { ColorImageInput, DepthMapInput, Options, SampleRequest, StepReport } from "./types/index.js";

/** A failure: `code` is that of a `BimodalError`, or "lost" if the browser ended the worker. */
export interface ElementError {
  /** Stable, for programs. */
  readonly code: string;
  /** The attribute or the input at fault. */
  readonly field?: string;
  /** The failure in words, which may change. */
  readonly message: string;
  /** Further values for programs, as in a `BimodalError`. */
  readonly details?: ErrorDetails;
}

/** A pair as arrays, as the `Estimator` takes it. */
export interface StereoPair {
  /** The colour image. */
  image: ColorImageInput;
  /** The depth map. */
  depth: DepthMapInput;
}

/** The addresses of the elements' files. A missing address stands for the file beside the module. */
export interface Places {
  /** The .wasm: its address, its bytes or the compiled module. */
  wasm?: string | URL | BufferSource | WebAssembly.Module;
  /** The address of elements-thread.js, which may be of another origin. */
  stereoThread?: string | URL;
  /** The address of figure-thread.js, which may be of another origin. */
  figureThread?: string | URL;
}

/** Sets the addresses of the files of all elements of the page. Call it before the first element is in the document. */
export declare function configure(places: Places): void;

/** The values under a lesson's figure: numbers and words. */
export interface FigureResult {
  /** The numbers, by the names of the lesson's readouts. */
  readonly numbers: Readonly<Record<string, number>>;
  /** The words, such as the status of a run, by the names of the lesson's readouts. */
  readonly words: Readonly<Record<string, string>>;
}

/** The detail of a `status` event of `<bimodal-stereo>`. */
export interface StatusDetail {
  /** The new status. */
  readonly status: StepReport["status"];
}

/** The detail of a `status` event of `<bimodal-figure>`. */
export interface StateDetail {
  /** The new state, in the form of the attribute. */
  readonly state: string;
}

/** The events of `<bimodal-stereo>`; none of them bubbles. */
export interface StereoEvents {
  /** Sent after each iteration and each slice of the search. */
  step: CustomEvent<StepReport>;
  /** The status has changed. */
  status: CustomEvent<StatusDetail>;
  /** The run has ended. */
  done: CustomEvent<StepReport>;
  /** The run has failed; no further event follows. */
  error: CustomEvent<ElementError>;
}

/** The events of `<bimodal-figure>`; none of them bubbles. */
export interface FigureEvents {
  /** A drawing has arrived; some lessons send several drawings before the last one. */
  step: CustomEvent<FigureResult>;
  /** The state has changed, by an attribute or by the visitor. */
  status: CustomEvent<StateDetail>;
  /** The last drawing has arrived. */
  done: CustomEvent<FigureResult>;
  /** The run has failed; no further event follows. */
  error: CustomEvent<ElementError>;
}

/** `<bimodal-stereo>`: finds the pose between an image and a depth map, one iteration per frame, and shows it. */
export interface BimodalStereoElement extends HTMLElement {
  /** Address of the colour image; empty without one. All strings here reflect the attributes. */
  image: string;
  /** Address of the depth map, PNG or .npy; empty without one. */
  depth: string;
  /** Address of the depth map's mask; empty for none. */
  mask: string;
  /** Pixels or metres per stored number of the depth map; `undefined` for the default. */
  unit: number | undefined;
  /** A rendered surface to use instead of files, such as "bust"; empty for none. */
  sample: string;
  /** Whether the run waits for `play()` or `step()`. */
  paused: boolean;
  /** Whether both surfaces and the curves of the run are also shown. */
  charts: boolean;
  /** A pair as arrays, instead of addresses; setting it restarts the run. */
  pair: StereoPair | undefined;
  /** Options of the estimator; setting them restarts the run. */
  options: Options;
  /** The scene of `sample` except its surface; setting it restarts the run. */
  scene: Partial<SampleRequest>;
  /** The report of the last step; `undefined` before the first. */
  readonly report: StepReport | undefined;
  /** The last failure of this run. */
  readonly error: ElementError | undefined;
  /** Continues, one step per frame. */
  play(): void;
  /** Waits before the next step. */
  pause(): void;
  /** Runs one step and pauses. */
  step(): void;
  /** Takes listeners of this element's events by their names. */
  addEventListener<K extends keyof StereoEvents>(
    type: K,
    listener: (event: StereoEvents[K]) => void,
    options?: boolean | AddEventListenerOptions,
  ): void;
  /** Takes listeners of all other events. */
  addEventListener(
    type: string,
    listener: EventListenerOrEventListenerObject,
    options?: boolean | AddEventListenerOptions,
  ): void;
}

/** `<bimodal-figure>`: the live figure of a lesson. */
export interface BimodalFigureElement extends HTMLElement {
  /** The lesson's name, such as "pixel". */
  lesson: string;
  /** The values of the controls in the form of an address, such as "noise=2&light=window". Follows the visitor's changes. */
  state: string;
  /** The numbers of the last drawing. */
  readonly result: FigureResult | undefined;
  /** The last failure since the last drawing. */
  readonly error: ElementError | undefined;
  /** Takes listeners of this element's events by their names. */
  addEventListener<K extends keyof FigureEvents>(
    type: K,
    listener: (event: FigureEvents[K]) => void,
    options?: boolean | AddEventListenerOptions,
  ): void;
  /** Takes listeners of all other events. */
  addEventListener(
    type: string,
    listener: EventListenerOrEventListenerObject,
    options?: boolean | AddEventListenerOptions,
  ): void;
}

/**
 * Both elements for JSX; `Common` holds the attributes that the framework accepts on every element. For React 19:
 * `declare module "react" { namespace JSX { interface IntrinsicElements extends ElementsInJsx<React.HTMLAttributes<HTMLElement>> {} } }`
 */
export interface ElementsInJsx<Common = unknown> {
  /** The run, with its attributes, its properties and its events. */
  "bimodal-stereo": Omit<Common, "onerror"> &
    Partial<
      Pick<
        BimodalStereoElement,
        "image" | "depth" | "mask" | "sample" | "options" | "scene" | "pair" | "paused" | "charts"
      >
    > & {
      /** Pixels (or metres) per stored number. */
      unit?: number;
      /** React's key. */
      key?: string | number;
      /** A reference to the element. */
      ref?: unknown;
      /** Listens to `step`. */
      onstep?: (event: StereoEvents["step"]) => void;
      /** Listens to `status`. */
      onstatus?: (event: StereoEvents["status"]) => void;
      /** Listens to `done`. */
      ondone?: (event: StereoEvents["done"]) => void;
      /** Listens to `error`. */
      onerror?: (event: StereoEvents["error"]) => void;
    };
  /** The figure, with its attributes and its events. */
  "bimodal-figure": Omit<Common, "onerror"> & {
    /** The lesson's name. */
    lesson: string;
    /** The values of the controls in the form of an address. */
    state?: string;
    /** React's key. */
    key?: string | number;
    /** A reference to the element. */
    ref?: unknown;
    /** Listens to `step`. */
    onstep?: (event: FigureEvents["step"]) => void;
    /** Listens to `status`. */
    onstatus?: (event: FigureEvents["status"]) => void;
    /** Listens to `done`. */
    ondone?: (event: FigureEvents["done"]) => void;
    /** Listens to `error`. */
    onerror?: (event: FigureEvents["error"]) => void;
  };
}

declare global {
  interface HTMLElementTagNameMap {
    /** Finds the pose between an image and a depth map. */
    "bimodal-stereo": BimodalStereoElement;
    /** The live figure of a lesson. */
    "bimodal-figure": BimodalFigureElement;
  }
}
