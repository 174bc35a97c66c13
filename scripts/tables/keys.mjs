// The part of the JSON that readers rely on: its tables and the keys of their rows.

const KEYS = {
  table1: ["protocol", "sign", "scale", "alpha", "beta", "gamma", "iterations", "degrees"],
  table2A: [
    "beta",
    "overlap",
    "size",
    "light",
    "lightName",
    "degrees",
    "error",
    "paper",
    "bound",
    "status",
    "milliseconds",
  ],
  table2B: [
    "beta",
    "overlap",
    "size",
    "light",
    "lightName",
    "degrees",
    "error",
    "paper",
    "bound",
    "status",
    "milliseconds",
  ],
  table3: ["name", "pose", "iterations", "residualBefore", "residualAfter"],
  figure4: ["iteration", "depthRmse", "degrees"],
  figure5: ["size", "lightName", "shading", "fraction", "degrees", "depthRmse"],
  figure6: ["overlap", "error"],
  figure7: ["name", "holesBefore", "holesAfter", "normalChange"],
  refinement: ["lightName", "before", "after", "holes"],
  sensors: ["object", "before", "after", "ratio", "blur", "overBlur", "rms", "blurRms", "rmsOverBlur"],
  photographs: ["object", "image", "beta", "degrees", "status"],
  conditions: ["object", "condition", "beta", "degrees", "status"],
  unseen: ["object", "condition", "beta", "degrees", "status"],
  rgbd: ["name", "turned", "start", "degrees", "inPlane", "tilt", "lateral", "along", "status"],
  statue: ["name", "start", "view", "degrees", "lateral", "along", "status"],
  pinhole: ["scene", "start", "degrees", "translation", "status"],
  albedo: ["object", "image", "pose", "beta", "correlation", "error", "naive", "degrees", "status"],
  random: [
    ...["cases", "found", "ambiguousOrLost", "confidentlyWrong", "flaggedThoughFound", "medianDegrees"],
    ...["coverage1", "coverage3"],
  ],
  painted: [
    ...["cases", "found", "ambiguousOrLost", "confidentlyWrong", "flaggedThoughFound", "medianDegrees"],
    ...["coverage1", "coverage3"],
  ],
  parts: [
    ...["cases", "found", "ambiguousOrLost", "confidentlyWrong", "flaggedThoughFound", "medianDegrees"],
    ...["coverage1", "coverage3", "medianOfAll", "kinds"],
  ],
  soft: [
    ...["cases", "found", "ambiguousOrLost", "confidentlyWrong", "flaggedThoughFound", "medianDegrees"],
    ...["coverage1", "coverage3", "medianOfAll", "kinds"],
  ],
  cameras: [
    ...["cases", "found", "ambiguousOrLost", "confidentlyWrong", "flaggedThoughFound", "medianDegrees"],
    ...["coverage1", "coverage3", "kinds"],
  ],
  stress: [
    ...["cases", "found", "ambiguousOrLost", "confidentlyWrong", "flaggedThoughFound", "medianDegrees"],
    ...["coverage1", "coverage3", "kinds"],
  ],
  honesty: [
    ...["cases", "found", "ambiguousOrLost", "confidentlyWrong", "flaggedThoughFound", "medianDegrees"],
    ...["coverage1", "coverage3", "kinds"],
  ],
  perturbation: ["kind", "of", "change", "degrees", "isWithin", "status"],
  ablation: ["without", "medianDegrees", "found"],
};
/** Tables that need the data beside the project; built-in scenes cannot replace these. */
const REAL = ["table3", "figure7", "sensors", "photographs", "conditions", "unseen", "albedo", "rgbd", "statue"];

/** Tables without rows, and missing keys of rows. A key may be null, because not every row has a value. */
export const missingKeys = (json, { realPairs }) =>
  Object.entries(KEYS).flatMap(([table, keys]) => {
    if (json[table] === undefined) return [table];
    const rows = [json[table]].flat();
    if (rows.length === 0) return realPairs || !REAL.includes(table) ? [`rows of ${table}`] : [];
    return keys.filter((key) => rows.some((row) => row[key] === undefined)).map((key) => `${table}.${key}`);
  });
