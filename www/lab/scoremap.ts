/**
 * The map of scores during the search. Columns show the rotation about the object's vertical axis, rows that about its horizontal axis.
 */

import type { Pose } from "../../pkg/index.js";
import { colourAt } from "../draw/colours";
import { byId } from "../dom";
import { decimals } from "../draw/numbers";

/** Half of the range shown, degrees; the search leaves out views from behind. */
const REACH = 105;
/** Distance of neighbouring rotations, degrees, which is the side of a square. */
const SPACING = 16;
/** Share of the best score above which another rotation counts as nearly as good. */
const NEAR = 0.95;

export class ScoreMap {
  readonly #figure = byId("score-map", HTMLElement);
  readonly #canvas = byId("score-canvas", HTMLCanvasElement);
  readonly #words = byId("score-words", HTMLElement);

  /** Alpha, beta, gamma and score of each rotation so far. Where rotations differ only in gamma, the best one is drawn. */
  show(scores: Float32Array, truth: Pose | null): void {
    const context = this.#canvas.getContext("2d");
    const count = scores.length / 4;
    if (!context || count === 0) return;
    const rows = Array.from({ length: count }, (_, row) => scores.subarray(4 * row, 4 * row + 4)).sort(
      (a, b) => (a[3] ?? 0) - (b[3] ?? 0),
    );
    const best = rows.at(-1) ?? scores;
    const { width } = this.#canvas;
    const at = (degrees: number) => ((degrees + REACH) / (2 * REACH)) * width;
    const side = (SPACING / (2 * REACH)) * width;
    context.clearRect(0, 0, width, width);
    for (const [alpha = 0, beta = 0, , score = 0] of rows) {
      const [r, g, b] = colourAt("viridis", score / Math.max(best[3] ?? 0, Number.MIN_VALUE));
      context.fillStyle = `rgb(${r} ${g} ${b})`;
      context.fillRect(at(beta) - side / 2, at(alpha) - side / 2, side, side);
    }
    const mark = (alpha: number, beta: number, inks: readonly string[]) => {
      inks.forEach((ink, line) => {
        context.strokeStyle = ink;
        context.lineWidth = 5 - 3 * line;
        context.beginPath();
        context.arc(at(beta), at(alpha), 0.6 * side, 0, 2 * Math.PI);
        context.stroke();
      });
    };
    mark(best[0] ?? 0, best[1] ?? 0, ["#000", "#fff"]);
    if (truth) mark(truth.angles.alpha, truth.angles.beta, ["#fff", "#d55e00"]);
    this.#figure.hidden = false;
    // If many rotations have nearly the best score, chance decides which one is best. The colours cannot show this.
    const others = rows.filter(([, , , score = 0]) => score >= NEAR * (best[3] ?? 0)).length - 1;
    const rings = `white ring: best${truth ? "; orange: true" : ""}`;
    const alike = others === 0 ? "none" : String(others);
    this.#words.textContent = ` of ${count} trial rotations (${rings}); ${alike} within 5 % of the best`;
    this.#canvas.setAttribute(
      "aria-label",
      `Scores of ${count} rotations. The best one is ${decimals(best[1], 0)} degrees about the vertical axis and ${decimals(best[0], 0)} about the horizontal one. Within 5 percent of its score: ${alike}.`,
    );
  }

  clear(): void {
    this.#figure.hidden = true;
  }
}
