// The ingredients of the tables: surfaces, lights, angles, overlaps, and the paper's own figures (docs/lab/protocols.md).

export const BETAS = [20, 40, 60, 80, 90];
export const OVERLAPS = [0.125, 0.25, 0.375, 0.5, 0.75, 1];

/** The paper's Table 2: the error for each beta (rows) and overlap (columns). */
const PAPER_TABLE_2 = {
  20: [0.022806, 0.015999, 0.006442, 0.006005, 0.007384, 0.008664],
  40: [0.022903, 0.011479, 0.00686, 0.005768, 0.005786, 0.006653],
  60: [0.022379, 0.01844, 0.01225, 0.00766, 0.004729, 0.004509],
  80: [0.010623, 0.008897, 0.008637, 0.005853, 0.0025, 0.001922],
  90: [0.00787, 1.631535, 0.006505, 0.004082, 0.000622, 0.000649],
};
export const paperTable2 = (beta, overlap) => PAPER_TABLE_2[beta][OVERLAPS.indexOf(overlap)];

/** The paper's Tables 1 and 3. */
export const PAPER_TABLE_1 = {
  scale: 1,
  alpha: 0.03216,
  beta: 18.7013,
  gamma: 0.01812,
  iterations: 16,
  degrees: 1.2993,
};
export const PAPER_TABLE_3 = { scale: 0.9972, alpha: -0.4813, beta: 17.3492, gamma: 9.322, iterations: 19 };

export const COLOURFUL = "colourful";

/** Noise of log S unless a protocol states another. */
export const NOISE = 0.01;

/** Nothing known: the options of a user who has only two files. */
export const FROM_ANYWHERE = {
  start: "search",
  registration: "joint",
  shading: "surface",
  light: "estimate",
  scale: "free",
};

/** Objects of `mit_berkeley`. */
export const OBJECTS = ["raccoon", "frog2", "squirrel", "turtle"];
/** These surfaces and six more, all with measured albedo. */
export const PAINTED = [...OBJECTS, "deer", "panther", "sun", "paper1", "cup1", "teabag1"];
/** Objects that no constant was set on. */
const UNSEEN = ["apple", "dinosaur", "phone", "potato"];
export const BUILT_IN = ["bust", "vase", "ripples"];

/**
 * Names of surfaces and lights: with the data beside the project the paper's bust and natural lights, otherwise those of the package.
 * A cell names its surface and its light; the program that runs it has a library that resolves these names (`requestOf`).
 */
export const kit = (complete, statues = []) =>
  complete
    ? {
        complete,
        main: "mozart",
        naturals: ["A", "B", "C"],
        surfaces: ["mozart", ...OBJECTS, ...BUILT_IN],
        objects: OBJECTS,
        painted: PAINTED,
        unseen: UNSEEN,
        statues,
      }
    : {
        complete,
        main: "bust",
        naturals: ["window", "overcast"],
        surfaces: BUILT_IN,
        objects: [],
        painted: [],
        unseen: [],
        statues,
      };

/** A cell's scene as a request for `sample`: names that the package lacks become heights and coefficients. */
export const requestOf = ({ surface, light, ...rest }, library) => ({
  surface: library.surface(surface),
  light: typeof light === "string" ? library.light(light) : light,
  ...rest,
});
