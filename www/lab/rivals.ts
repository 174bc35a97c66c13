/** Alternative poses that fit the image equally well, listed over the surfaces: each can be viewed, and a new run can start from it. */

import type { Pose, StepReport } from "../../pkg/index.js";
import { OPTIONS } from "../../pkg/options.js";
import { decimals } from "../draw/numbers";
import { byId, make } from "../dom";
import { angleBetween } from "./verdict";

export interface RivalHooks {
  /** An alternative pose is selected, or the best pose again. */
  onLook(pose: Pose | undefined): void;
  onStart(pose: Pose): void;
}

/** Another pose counts as the same pose within this angle: two sigmas of the least certain pose that still converges. */
const APART = 2 * (OPTIONS.tolerance.default ?? 0);

export class Rivals {
  readonly #box = byId("rivals", HTMLElement);
  readonly #hooks: RivalHooks;
  #shown = "";
  #looked: Pose | undefined;

  constructor(hooks: RivalHooks) {
    this.#hooks = hooks;
  }

  /** The alternative pose that is shown instead of the best one. */
  get looked(): Pose | undefined {
    return this.#looked;
  }

  show({ rivals = [], pose, status }: StepReport): void {
    const others = rivals.filter(({ rotation }) => angleBetween(rotation, pose.rotation) > APART);
    const poses = status === "running" ? [] : others;
    const key = JSON.stringify([poses, poses.length > 0 && pose]);
    if (key === this.#shown) return;
    this.#shown = key;
    this.#looked = undefined;
    this.#box.hidden = poses.length === 0;
    const start = make("button", { type: "button", hidden: true }, "Restart from here");
    const choices = [undefined, ...poses].map((rival) => {
      const away = rival && decimals(angleBetween(rival.rotation, pose.rotation), 0);
      const button = make(
        "button",
        { type: "button", "aria-pressed": String(!rival) },
        rival ? `alternative, ${away}° away` : "best pose",
      );
      button.addEventListener("click", () => {
        for (const choice of choices) choice.setAttribute("aria-pressed", String(choice === button));
        start.hidden = !rival;
        start.onclick = () => rival && this.#hooks.onStart(rival);
        this.#looked = rival;
        this.#hooks.onLook(rival);
      });
      return button;
    });
    this.#box.replaceChildren(...(poses.length > 0 ? [...choices, start] : []));
  }
}
