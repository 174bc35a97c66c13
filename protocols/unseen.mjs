// Photographs of objects that no constant was set on: nothing known, and from an initial pose that is off.
import { OFF } from "./conditions.mjs";
import { PHOTOGRAPH_BETAS, PHOTOGRAPH_SIZE } from "./reals.mjs";
import { FROM_ANYWHERE } from "./scenes.mjs";

/** What the runs are given, and the limits of their aims. */
export const CONDITIONS = [
  { condition: "nothing known", changes: {}, limits: { median: 1.2, found: 0.8 } },
  { condition: "initial pose 8 degrees off", changes: { off: OFF }, limits: { median: 1.1, found: 0.85 } },
];

export const unseen = {
  name: "unseen",
  title:
    "Photographs of objects that no constant was set on, 96x96: nothing known, and from an initial pose 8 degrees off",
  cells: ({ unseen: objects }, quick) =>
    CONDITIONS.flatMap(({ condition, changes }) =>
      (quick ? objects.slice(0, 1) : objects).flatMap((object) =>
        (quick ? [20] : PHOTOGRAPH_BETAS).map((beta) => ({
          id: `unseen/${condition}/${object}/${beta}`,
          kind: "photograph",
          row: { object, condition, beta },
          scene: { surface: object, light: "A", size: PHOTOGRAPH_SIZE, angles: { beta } },
          photograph: "lab_diffuse",
          ...changes,
          options: FROM_ANYWHERE,
        })),
      ),
    ),
};
