/** The light, shown on a ball: estimated, true, and their ratio. The true light of a sample can be dragged, and its coefficients can be set. */

import { byId, make } from "../dom";
import type { Frame, KnownLight } from "../engine/protocol";
import { Coefficients } from "./coefficients";
import type { Settings } from "./settings";
import { dated } from "./verdict";

export interface Turn {
  alpha: number;
  beta: number;
}

export interface LightHooks {
  /** The rotation of the light before a drag. */
  turn(): Turn;
  /**
   * Called with the changed settings while the light is moved, and once more when it stops or is released; `gesture` is the same for the
   * whole drag.
   */
  onLight(patch: Settings, done: boolean, gesture: object): void;
}

/** Degrees per press of an arrow key. */
const PRESS = 5;
/** How long, in milliseconds, the light must rest before its rotation takes effect. */
const REST = 200;

const within = (degrees: number): number => Math.round(((((degrees + 180) % 360) + 360) % 360) - 180);

const patchOf = ({ alpha, beta }: Turn): Settings => ({ lightTurn: beta, lightTilt: alpha });

export class LightPanel {
  readonly #found: Ball;
  readonly #truth: Ball;
  readonly #difference: Ball;
  readonly #coefficients: Coefficients;
  readonly #box = byId("light", HTMLElement);
  #resting: ReturnType<typeof setTimeout> | undefined;
  /** The rotation by the pointer, before the settings have changed. */
  #turn: Turn | undefined;
  #gesture = {};
  #standing = "found";
  #isBefore = false;
  #isBesideRival = false;
  readonly #hooks: LightHooks;

  constructor(hooks: LightHooks) {
    this.#hooks = hooks;
    this.#found = new Ball("found", "A ball under the estimated light");
    this.#truth = new Ball(
      "true light (drag to turn)",
      "A ball under the true light. Drag it or use the arrow keys to turn the light.",
    );
    this.#difference = new Ball("difference", "The estimated light divided by the true one: grey where they are equal");
    this.#coefficients = new Coefficients(hooks);
    this.#box.append(this.#found.element, this.#truth.element, this.#difference.element);
    this.#box.after(this.#coefficients.element);
    this.#listen(this.#truth.canvas);
  }

  /** Whether the light that is shown as found is that of the previous run. */
  date(isBefore: boolean): void {
    this.#isBefore = isBefore;
    this.#found.say(dated(this.#isBesideRival ? "best pose" : this.#standing, isBefore));
  }

  /** While a rival's surfaces and numbers are shown, the light remains that of the pose found; the label says so. */
  beside(isRival: boolean): void {
    this.#isBesideRival = isRival;
    this.date(this.#isBefore);
  }

  /** While a search tries poses, the light is that of the best candidate. */
  show({ found, difference }: Frame["light"], standing: string): void {
    this.#standing = standing;
    this.date(this.#isBefore);
    this.#found.show(found);
    this.#difference.show(difference);
  }

  showTruth(light: KnownLight | null): void {
    this.#truth.show(light?.ball ?? null);
    this.#coefficients.show(light?.coefficients ?? null);
  }

  #listen(canvas: HTMLCanvasElement): void {
    canvas.tabIndex = 0;
    canvas.classList.add("turns");
    let from: { x: number; y: number; turn: Turn } | undefined;
    canvas.addEventListener("pointerdown", (event) => {
      this.#gesture = {};
      from = { x: event.clientX, y: event.clientY, turn: this.#turn ?? this.#hooks.turn() };
      canvas.setPointerCapture(event.pointerId);
      event.preventDefault();
      canvas.focus();
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!from) return;
      // A drag across the ball rotates by half a turn. The nearest side follows the pointer: right is about +y, because y points down and z
      // away.
      const degrees = 180 / canvas.clientWidth;
      const [across, down] = [event.clientX - from.x, event.clientY - from.y].map((distance) => degrees * distance);
      this.#to({ beta: within(from.turn.beta - (across ?? 0)), alpha: within(from.turn.alpha + (down ?? 0)) });
    });
    const end = () => {
      if (from && this.#turn) this.#finish();
      from = undefined;
      this.#gesture = {};
    };
    canvas.addEventListener("pointerup", end);
    canvas.addEventListener("pointercancel", end);
    canvas.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
      if (!step || event.altKey || event.ctrlKey || event.metaKey) return;
      event.preventDefault();
      const { alpha, beta } = this.#turn ?? this.#hooks.turn();
      this.#to({ beta: within(beta + PRESS * (step[0] ?? 0)), alpha: within(alpha + PRESS * (step[1] ?? 0)) });
    });
  }

  #to(turn: Turn): void {
    this.#turn = turn;
    this.#hooks.onLight(patchOf(turn), false, this.#gesture);
    clearTimeout(this.#resting);
    this.#resting = setTimeout(() => this.#finish(), REST);
  }

  #finish(): void {
    clearTimeout(this.#resting);
    const turn = this.#turn;
    this.#turn = undefined;
    if (turn) this.#hooks.onLight(patchOf(turn), true, this.#gesture);
  }
}

class Ball {
  readonly canvas: HTMLCanvasElement;
  readonly element: HTMLElement;
  readonly #title: HTMLElement;
  /** Like the contexts of the views, this one is requested before its canvas is on the page. */
  readonly #context: CanvasRenderingContext2D | null;

  constructor(title: string, description: string) {
    this.canvas = make("canvas", { width: 72, height: 72, role: "img", "aria-label": description });
    this.#context = this.canvas.getContext("2d");
    this.#title = make("figcaption", {}, title);
    this.element = make("figure", { class: "ball" }, this.canvas, this.#title);
  }

  say(title: string): void {
    if (this.#title.textContent !== title) this.#title.textContent = title;
  }

  show(bitmap: ImageBitmap | null): void {
    this.element.hidden = bitmap === null;
    if (!bitmap) return;
    this.canvas.width = bitmap.width;
    this.canvas.height = bitmap.height;
    this.#context?.drawImage(bitmap, 0, 0);
    bitmap.close();
  }
}
