// Photographs under other conditions: with an initial pose, with three lamps as channels, under natural light, at a larger size.
import { PHOTOGRAPH_BETAS, PHOTOGRAPH_SIZE } from "./reals.mjs";
import { FROM_ANYWHERE } from "./scenes.mjs";

/** Objects that were also photographed under single lamps. */
const UNDER_LAMPS = ["turtle", "squirrel", "deer", "paper1"];
const LAMPS = ["lab_light01", "lab_light05", "lab_light09"];
/** Error of a given initial pose about the object's middle, degrees. */
export const OFF = 8;
const LARGE = 128;

/** The changes that make each condition; the aims refer to the kind of a condition. */
export const CONDITIONS = [
  { condition: "initial pose 8 degrees off", kind: "told", changes: { photograph: "lab_diffuse", off: OFF } },
  { condition: "three lamps", kind: "lamps", changes: { lamps: LAMPS }, objects: UNDER_LAMPS },
  { condition: "natural light", kind: "natural", changes: { photograph: "natural_diffuse" } },
  { condition: "128x128", kind: "large", changes: { photograph: "lab_diffuse" }, size: LARGE },
];

const cellsOf = ({ condition, changes, objects, size = PHOTOGRAPH_SIZE }, painted, betas) =>
  painted
    .filter((object) => !objects || objects.includes(object))
    .flatMap((object) =>
      betas.map((beta) => ({
        id: `conditions/${condition}/${object}/${beta}`,
        kind: "photograph",
        row: { object, condition, beta },
        scene: { surface: object, light: "A", size, angles: { beta } },
        ...changes,
        options: FROM_ANYWHERE,
      })),
    );

export const conditions = {
  name: "conditions",
  title:
    "Photographs under other conditions: initial pose given, three lamps as R, G, B, varying albedo under natural light, 128x128",
  cells: ({ painted }, quick) =>
    CONDITIONS.flatMap((condition) =>
      cellsOf(condition, quick ? painted.slice(2, 3) : painted, quick ? [20] : PHOTOGRAPH_BETAS),
    ),
};
