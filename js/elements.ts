/** The types of the custom elements. Their code is in www/elements, which is bundled after this package. */
import type { ErrorDetails } from "./errors.js";
import type { Options, SampleRequest, StepReport } from "./types/index.js";

/** A failure: `code` is that of a `BimodalError`, or "lost" if the browser ended the worker. */
export interface ElementError {
  /** Stable, for programs. */
  readonly code: string;
  /** The attribute or the input at fault. */
  readonly field?: string;
  /** In words, which may change. */
  readonly message: string;
  readonly details?: ErrorDetails;
}

/** The numbers under a lesson's figure, and those that are words. */
export interface FigureResult {
  readonly numbers: Readonly<Record<string, number>>;
  readonly words: Readonly<Record<string, string>>;
}

/** The events of `<bimodal-stereo>`; none of them bubbles. */
export interface StereoEvents {
  /** After each iteration and each slice of the search. */
  step: CustomEvent<StepReport>;
  /** The status has changed. */
  status: CustomEvent<{ status: StepReport["status"] }>;
  /** The run has ended. */
  done: CustomEvent<StepReport>;
  error: CustomEvent<ElementError>;
}

/** The events of `<bimodal-figure>`; none of them bubbles. */
export interface FigureEvents {
  /** A drawing has arrived; some lessons draw several on the way to the last. */
  step: CustomEvent<FigureResult>;
  /** The state has changed, by an attribute or by the visitor. */
  status: CustomEvent<{ state: string }>;
  /** The last drawing has arrived. */
  done: CustomEvent<FigureResult>;
  error: CustomEvent<ElementError>;
}

/** `<bimodal-stereo>`: finds the pose between an image and a depth map, one iteration per frame, and shows it. */
export interface BimodalStereoElement extends HTMLElement {
  /** Address of the colour image; "" if there is none. Reflects the attribute, as do all strings here. */
  image: string;
  /** Address of the depth map, PNG or .npy; "" if there is none. */
  depth: string;
  /** Address of the depth map's mask; "" for none. */
  mask: string;
  /** Pixels (or metres) per stored number of the depth map; `undefined` for the default. */
  unit: number | undefined;
  /** A rendered surface to use instead of files, such as "bust"; "" for none. */
  sample: string;
  /** Whether the run waits for `play()` or `step()`. */
  paused: boolean;
  /** Options of the estimator; setting them restarts the run. */
  options: Options;
  /** The scene of `sample`, beside its surface; setting it restarts the run. */
  scene: Partial<SampleRequest>;
  /** The report of the last step; `undefined` before the first. */
  readonly report: StepReport | undefined;
  /** The last failure of this run. */
  readonly error: ElementError | undefined;
  play(): void;
  pause(): void;
  /** One step; the run is paused then. */
  step(): void;
  addEventListener<K extends keyof StereoEvents>(
    type: K,
    listener: (event: StereoEvents[K]) => void,
    options?: boolean | AddEventListenerOptions,
  ): void;
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
  /** Its controls as in an address, such as "noise=2&light=window"; follows the visitor's changes. */
  state: string;
  /** The numbers of the last drawing. */
  readonly result: FigureResult | undefined;
  readonly error: ElementError | undefined;
  addEventListener<K extends keyof FigureEvents>(
    type: K,
    listener: (event: FigureEvents[K]) => void,
    options?: boolean | AddEventListenerOptions,
  ): void;
  addEventListener(
    type: string,
    listener: EventListenerOrEventListenerObject,
    options?: boolean | AddEventListenerOptions,
  ): void;
}

/**
 * Both elements for JSX; `Common` is what every element of the framework takes. For React 19:
 * `declare module "react" { namespace JSX { interface IntrinsicElements extends ElementsInJsx<React.HTMLAttributes<HTMLElement>> {} } }`
 */
export interface ElementsInJsx<Common = unknown> {
  "bimodal-stereo": Omit<Common, "onerror"> &
    Partial<Pick<BimodalStereoElement, "image" | "depth" | "mask" | "sample" | "options" | "scene" | "paused">> & {
      unit?: number;
      key?: string | number;
      ref?: unknown;
      onstep?: (event: StereoEvents["step"]) => void;
      onstatus?: (event: StereoEvents["status"]) => void;
      ondone?: (event: StereoEvents["done"]) => void;
      onerror?: (event: StereoEvents["error"]) => void;
    };
  "bimodal-figure": Omit<Common, "onerror"> & {
    lesson: string;
    state?: string;
    key?: string | number;
    ref?: unknown;
    onstep?: (event: FigureEvents["step"]) => void;
    onstatus?: (event: FigureEvents["status"]) => void;
    ondone?: (event: FigureEvents["done"]) => void;
    onerror?: (event: FigureEvents["error"]) => void;
  };
}

declare global {
  interface HTMLElementTagNameMap {
    "bimodal-stereo": BimodalStereoElement;
    "bimodal-figure": BimodalFigureElement;
  }
}
