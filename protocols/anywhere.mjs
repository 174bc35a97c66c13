// Random scenes with nothing known, the same scenes brighter and darker, and ablations of one part of the method at a time.
import { FROM_ANYWHERE, NOISE } from "./scenes.mjs";
import { aboutAxis, anglesOf, degreesBetween, product } from "./rotations.mjs";
import { chance, drawGaussian } from "./numbers.mjs";
import { measuredRows, randomRow } from "./counts.mjs";

export const SCENES = 300;
const QUICK_SCENES = 12;
/** Limits of a random scene (degrees, shares). */
const MOST_TILT = 75;
const MOST_ROLL = 30;
const SCALES = [0.8, 1.25];
const LEAST_OVERLAP = 0.4;
const SIZE = 96;

/** A direction, uniform over the sphere. */
export function direction({ gaussian }) {
  const vector = [gaussian(), gaussian(), gaussian()];
  const length = Math.hypot(...vector);
  return vector.map((part) => part / length);
}

/** A random scene. Its overlap is P_w, as in all tables: the image sees nearly all that the depth map shows. */
export function drawScene(dice, { surfaces, naturals }, gaussian) {
  const surface = surfaces[dice.below(surfaces.length)];
  const tilt = aboutAxis(direction(dice), dice.uniform(0, MOST_TILT));
  const roll = aboutAxis([0, 0, 1], dice.uniform(-MOST_ROLL, MOST_ROLL));
  const [low, high] = SCALES.map(Math.log);
  return {
    surface,
    light: gaussian ? drawGaussian(gaussian, dice) : naturals[dice.below(naturals.length)],
    size: SIZE,
    angles: anglesOf(product(tilt, roll)),
    scale: Math.exp(dice.uniform(low, high)),
    overlap: dice.uniform(LEAST_OVERLAP, 1),
    noise: NOISE,
  };
}

/** The random scene number `seed`, changed by `changes`. */
const randomCell = (kit, seed, { id = "random", row = {}, options = {}, ...changes } = {}) => ({
  id: `${id}/${seed}`,
  kind: "random",
  row: { scene: seed, ...row },
  kit,
  seed,
  options: { ...FROM_ANYWHERE, ...options },
  ...changes,
});

/** The scene of any cell: given, or drawn from its seed. */
export const sceneOf = (cell, library) =>
  cell.kind === "random"
    ? { ...drawScene(chance(cell.seed), cell.kit, library.gaussian), seed: cell.seed }
    : cell.scene;

const seeds = (count) => Array.from({ length: count }, (_, index) => index + 1);

export const random = {
  name: "random",
  title: "Random scenes: any surface, light, pose and scale, nothing known",
  cells: (kit, quick) => seeds(quick ? QUICK_SCENES : SCENES).map((seed) => randomCell(kit, seed)),
  rows: (results) => randomRow(measuredRows(results)),
};

const EXPOSURES = [0.1, 10];

export const exposure = {
  name: "exposure",
  title: "Exposure: random scenes with all colours times a factor; how far the pose moves",
  cells: (kit, quick) =>
    seeds(quick ? 2 : 40).flatMap((seed) => [
      randomCell(kit, seed),
      ...EXPOSURES.map((factor) =>
        randomCell(kit, seed, { id: `exposure/${factor}`, row: { factor }, exposure: factor }),
      ),
    ]),
  rows: (results) =>
    results
      .filter(({ cell }) => cell.exposure)
      .map(({ cell, result }) => {
        const plain = results.find((other) => !other.cell.exposure && other.cell.seed === cell.seed);
        const degreesMoved = plain ? degreesBetween(result.rotation, plain.result.rotation) : null;
        return { ...cell.row, degreesMoved, degrees: result.degrees, status: result.status };
      }),
};

/** The parts that are left out, and the options that leave them out. */
const ABLATIONS = [
  { without: "search", options: { start: "identity" } },
  // Pose and light in turn, beginning at the pose of the search.
  { without: "projection of the light", alternations: 8 },
  { without: "light prior", options: { lambda: { light: 0 } } },
  { without: "shape prior", options: { lambda: { prior: 0 } } },
  { without: "surface (pixel instead)", options: { shading: "pixel" } },
  { without: "joint (icp instead)", options: { registration: "icp" } },
  { without: "annealing", options: { annealing: false } },
];

export const ablation = {
  name: "ablation",
  title: "Ablation: the first random scenes without one part of the method",
  cells: (kit, quick) =>
    seeds(quick ? 2 : 30).flatMap((seed) => [
      randomCell(kit, seed),
      ...ABLATIONS.map(({ without, ...changes }) =>
        randomCell(kit, seed, { id: `ablation/${without}`, row: { without }, ...changes }),
      ),
    ]),
  rows: (results) =>
    ["nothing", ...ABLATIONS.map(({ without }) => without)].map((without) => {
      const members = results.filter(({ cell }) => (cell.row.without ?? "nothing") === without);
      const { cases, found, confidentlyWrong, medianDegrees } = randomRow(members.map(({ result }) => result));
      return { without, medianDegrees, found, cases, confidentlyWrong };
    }),
};
