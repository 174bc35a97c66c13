/** The light as a ball that it falls on: found, true, and what differs. The true one of a sample can be dragged. */

import { byId, make } from "../dom";
import { paintPicture } from "../draw/colours";
import type { Picture } from "../engine/protocol";

export interface Turn {
  alpha: number;
  beta: number;
}

export interface LightHooks {
  /** How the light is turned before a drag. */
  turn(): Turn;
  /** Told while it is dragged, and once more when it has been let go. */
  onTurn(turn: Turn, done: boolean): void;
}

/** Degrees of a press of an arrow key. */
const PRESS = 5;
/** How long, in milliseconds, the light rests before its turn counts. */
const REST = 200;

const within = (degrees: number): number => Math.round(((((degrees + 180) % 360) + 360) % 360) - 180);

export class LightPanel {
  readonly #found: Ball;
  readonly #truth: Ball;
  readonly #difference: Ball;
  readonly #box = byId("light", HTMLElement);
  #resting: ReturnType<typeof setTimeout> | undefined;
  /** Turned as the pointer says, and not yet as the settings do. */
  #turn: Turn | undefined;
  readonly #hooks: LightHooks;

  constructor(hooks: LightHooks) {
    this.#hooks = hooks;
    this.#found = new Ball("found", "A ball under the light that was found");
    this.#truth = new Ball("true: drag it", "A ball under the true light. Drag it or use the arrow keys to turn the light.");
    this.#difference = new Ball("difference", "The light that was found over the true one: grey where both are equal");
    this.#box.append(this.#found.element, this.#truth.element, this.#difference.element);
    this.#listen(this.#truth.canvas);
  }

  show({ found, difference }: { found: Picture; difference: Picture | null }): void {
    this.#found.show(found);
    this.#difference.show(difference);
  }

  showTruth(picture: Picture | null): void {
    this.#truth.show(picture);
  }

  #listen(canvas: HTMLCanvasElement): void {
    canvas.tabIndex = 0;
    canvas.classList.add("turns");
    let from: { x: number; y: number; turn: Turn } | undefined;
    canvas.addEventListener("pointerdown", (event) => {
      from = { x: event.clientX, y: event.clientY, turn: this.#turn ?? this.#hooks.turn() };
      canvas.setPointerCapture(event.pointerId);
      event.preventDefault();
      canvas.focus();
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!from) return;
      // Half a turn across the ball. What is nearest follows the pointer: right is about +y, because y points down and z away.
      const degrees = 180 / canvas.clientWidth;
      const [across, down] = [event.clientX - from.x, event.clientY - from.y].map((distance) => degrees * distance);
      this.#to({ beta: within(from.turn.beta - (across ?? 0)), alpha: within(from.turn.alpha + (down ?? 0)) });
    });
    const end = () => {
      if (from && this.#turn) this.#finish();
      from = undefined;
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
    this.#hooks.onTurn(turn, false);
    clearTimeout(this.#resting);
    this.#resting = setTimeout(() => this.#finish(), REST);
  }

  #finish(): void {
    clearTimeout(this.#resting);
    const turn = this.#turn;
    this.#turn = undefined;
    if (turn) this.#hooks.onTurn(turn, true);
  }
}

class Ball {
  readonly canvas: HTMLCanvasElement;
  readonly element: HTMLElement;

  constructor(title: string, description: string) {
    this.canvas = make("canvas", { width: 72, height: 72, role: "img", "aria-label": description });
    this.element = make("figure", { class: "ball" }, this.canvas, make("figcaption", {}, title));
  }

  show(picture: Picture | null): void {
    this.element.hidden = picture === null;
    if (!picture) return;
    this.canvas.width = picture.width;
    this.canvas.height = picture.height;
    this.canvas.getContext("2d")?.putImageData(paintPicture(picture), 0, 0);
  }
}
