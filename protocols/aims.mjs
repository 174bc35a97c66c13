// The project's aims, computed only from the rows of the tables.
import { aim } from "./aim.mjs";
import { softAims, unseenAims } from "./aims-smooth-albedo.mjs";
import { FOUND_WITHIN, coverage3, isConfidentlyWrong, isFlagged, isFound, isFoundOrFlagged } from "./counts.mjs";
import { IMAGES } from "./reals.mjs";
import { CONDITIONS } from "./conditions.mjs";
import { ofSensor } from "./sensors.mjs";
import { COLOURFUL } from "./scenes.mjs";
import { mean, median, quantile, share, worst } from "./numbers.mjs";
import { degreesBetween } from "./rotations.mjs";

const least = (values) => (values.length === 0 ? null : Math.min(...values));

function table1Aims(rows = []) {
  const grid = rows.filter(({ protocol }) => protocol === "2A");
  const off = (key, truth) => worst(grid.map((row) => Math.abs(row[key] - truth(row))));
  return [
    aim(
      "table1",
      "2A, both signs: beta off, degrees",
      off("beta", ({ sign }) => 20 * sign),
      "<=",
      0.001,
      grid.length,
    ),
    aim(
      "table1",
      "2A, both signs: alpha off",
      off("alpha", () => 0),
      "<=",
      0.001,
      grid.length,
    ),
    aim(
      "table1",
      "2A, both signs: gamma off",
      off("gamma", () => 0),
      "<=",
      0.001,
      grid.length,
    ),
  ];
}

const table2AAims = (rows = []) => [
  aim(
    "table2A",
    "every cell: error / the paper's",
    worst(rows.map(({ error, paper }) => error / paper)),
    "<=",
    0.01,
    rows.length,
  ),
];

const ratios = (rows) => rows.filter(({ bound }) => bound > 0).map(({ degrees, bound }) => degrees / bound);

function table2BAims(rows = []) {
  const of = (size, light, passes = () => true) =>
    rows.filter((row) => row.size === size && row.light === light && passes(row));
  const wide = ({ overlap }) => overlap >= 0.5;
  const fair = (row) => wide(row) && row.beta <= 80;
  const line = (size, light, where, what, members, statistic, limit, sense = "<=") =>
    aim(
      "table2B",
      `${size}x${size}, light ${light}, ${where}: ${what}`,
      statistic(members),
      sense,
      limit,
      members.length,
    );
  const degrees = (statistic) => (members) => statistic(members.map((row) => row.degrees));
  const toBound = (members) => median(ratios(members));

  const known = of(128, "known");
  const unknown = of(128, "unknown", fair);
  const edge = of(128, "unknown", ({ beta }) => beta === 90);
  const small = of(64, "unknown", fair);
  return [
    line(128, "known", "P_w >= 0.5", "median degrees", known.filter(wide), degrees(median), 0.08),
    line(128, "known", "P_w >= 0.5", "worst degrees", known.filter(wide), degrees(worst), 0.4),
    line(
      128,
      "known",
      "P_w < 0.5",
      "worst degrees",
      known.filter((row) => !wide(row)),
      degrees(worst),
      2,
    ),
    line(128, "known", "all", "median of degrees / bound", known, toBound, 3),
    line(128, "unknown", "P_w >= 0.5, beta <= 80", "median degrees", unknown, degrees(median), 0.15),
    line(128, "unknown", "P_w >= 0.5, beta <= 80", "worst degrees", unknown, degrees(worst), 0.8),
    line(128, "unknown", "P_w >= 0.5, beta <= 80", "median of degrees / bound", unknown, toBound, 4),
    line(
      128,
      "unknown",
      "beta = 90",
      "share found or flagged",
      edge,
      (members) => share(members, isFoundOrFlagged),
      1,
      ">=",
    ),
    line(64, "unknown", "P_w >= 0.5, beta <= 80", "median degrees", small, degrees(median), 0.6),
    line(
      64,
      "unknown",
      "P_w >= 0.5, beta <= 80",
      `share under ${FOUND_WITHIN} degrees`,
      small,
      (members) => share(members, isFound),
      0.95,
      ">=",
    ),
  ];
}

function figure5Aims(rows = []) {
  const of = (shading, fraction) => rows.filter((row) => row.shading === shading && row.fraction === fraction);
  const pixel = rows.filter(({ shading }) => shading === "pixel").sort((a, b) => a.fraction - b.fraction);
  const sameRun = (a, b) => a.size === b.size && a.lightName === b.lightName;
  const rises = pixel.flatMap((row) => {
    const next = pixel.find((other) => sameRun(row, other) && other.fraction > row.fraction);
    return next ? [next.degrees - row.degrees] : [];
  });
  const halves = of("surface", 0).map(
    (row) => row.degrees / of("pixel", 0).find((other) => sameRun(row, other)).degrees,
  );
  const full = of("surface", 1);
  return [
    aim("figure5", "pixel: largest rise from one share to the next, degrees", worst(rises), "<=", 0, rises.length),
    aim("figure5", "no prior: surface / pixel, worst", worst(halves), "<=", 0.5, halves.length),
    aim(
      "figure5",
      "full prior: surface, worst degrees",
      worst(full.map(({ degrees }) => degrees)),
      "<=",
      3,
      full.length,
    ),
  ];
}

function refinementAims(rows = []) {
  const gains = (passes) => rows.filter((row) => row.pose === "estimated" && passes(row)).map(({ gain }) => gain);
  const [colourful, natural] = [
    gains(({ lightName }) => lightName === COLOURFUL),
    gains(({ lightName }) => lightName !== COLOURFUL),
  ];
  return [
    aim("refinement", "pose estimated, colourful: error in / out", least(colourful), ">=", 5, colourful.length),
    aim("refinement", "pose estimated, natural: error in / out, least", least(natural), ">=", 2.5, natural.length),
  ];
}

/** [sensor, half, least of error in / out, least of the best blur's error / ours]; the mitten has no held-out half. */
const SENSORS = [
  ["mitten", undefined, 1.6, 1.15],
  ...["tuned", "held out"].map((half) => ["kinect, photograph", half, 1.8, 1.4]),
  ...["tuned", "held out"].map((half) => ["scan, render", half, 2.5, 2]),
];

function sensorsAims(rows = []) {
  const lines = SENSORS.flatMap(([sensor, half, least, overBlur]) => {
    const members = ofSensor(rows, sensor, half);
    const line = (what, key, limit) => {
      const name = `${sensor}${half ? `, ${half}` : ""}: median of ${what}`;
      return aim("sensors", name, median(members.map((row) => row[key])), ">=", limit, members.length);
    };
    return [line("error in / out", "ratio", least), line("error of the best blur / ours", "overBlur", overBlur)];
  });
  const halves = ["tuned", "held out"].map((half) => {
    const members = rows.filter((row) => row.half === half);
    const better = share(members, ({ rmsOverBlur }) => rmsOverBlur > 1);
    return aim(
      "sensors",
      `${half}: share with a smaller RMS error than the best blur`,
      better,
      ">=",
      1,
      members.length,
    );
  });
  return [...lines, ...halves];
}

const coverageAim = (table, kind, rows) =>
  aim(table, `${kind}: found within 3 sigma on all axes`, coverage3(rows), ">=", 0.93, rows.filter(isFound).length);

function photographsAims(rows = []) {
  const of = (wanted) => rows.filter(({ image }) => image === wanted);
  const [painted, shaded, rendered] = IMAGES.map(of);
  const unflagged = painted.filter((row) => !isFlagged(row));
  const middle = (members) => median(members.map(({ degrees }) => degrees));
  return [
    aim("photographs", "median degrees", middle(painted), "<=", 1.2, painted.length),
    aim("photographs", `share under ${FOUND_WITHIN} degrees`, share(painted, isFound), ">=", 0.75, painted.length),
    aim(
      "photographs",
      "worst degrees of those not flagged",
      worst(unflagged.map(({ degrees }) => degrees)),
      "<=",
      4,
      unflagged.length,
    ),
    aim("photographs", "shading alone: median degrees", middle(shaded), "<=", 0.8, shaded.length),
    aim(
      "photographs",
      "renders: worst degrees",
      worst(rendered.map(({ degrees }) => degrees)),
      "<=",
      1,
      rendered.length,
    ),
    ...IMAGES.map((image) => coverageAim("photographs", image, of(image))),
  ];
}

/** Limits of each condition. */
const LIMITS = {
  told: { median: 1, found: 0.8 },
  lamps: { median: 0.8 },
  natural: { median: 0.4, mean: 1 },
  large: { median: 1.2, found: 0.75, worst: 4 },
};

const conditionsAims = (rows = []) =>
  CONDITIONS.flatMap(({ condition, kind }) => {
    const members = rows.filter((row) => row.condition === condition);
    const [limits, degrees] = [LIMITS[kind], members.map((row) => row.degrees)];
    const unflagged = members.filter((row) => !isFlagged(row)).map((row) => row.degrees);
    const line = (what, measured, sense, limit, count = members.length) =>
      limit === undefined ? [] : [aim("conditions", `${condition}: ${what}`, measured, sense, limit, count)];
    return [
      ...line("median degrees", median(degrees), "<=", limits.median),
      ...line("mean degrees", mean(degrees), "<=", limits.mean),
      ...line(`share under ${FOUND_WITHIN} degrees`, share(members, isFound), ">=", limits.found),
      ...line("worst degrees of those not flagged", worst(unflagged), "<=", limits.worst, unflagged.length),
      coverageAim("conditions", condition, members),
    ];
  });

function rgbdAims(rows = []) {
  const told = rows.filter(({ start }) => start === "told");
  const known = rows.filter(({ start }) => start === "search");
  const line = (what, members, measured, sense, limit) => aim("rgbd", what, measured, sense, limit, members.length);
  const of = (key, at) =>
    quantile(
      told.map((row) => row[key]),
      at,
    );
  return [
    line("initial pose given: lateral, median mm", told, of("lateral", 0.5), "<=", 2),
    line("initial pose given: lateral, ninetieth percentile", told, of("lateral", 0.9), "<=", 4),
    line("initial pose given: along the line of sight, median mm", told, of("along", 0.5), "<=", 6),
    line("initial pose given: along the line of sight, ninetieth percentile", told, of("along", 0.9), "<=", 14),
    line("initial pose given: in-plane turn, median degrees", told, of("inPlane", 0.5), "<=", 0.7),
    line(
      "initial pose given: median tilt error / tilt of the initial pose",
      told,
      of("tilt", 0.5) / median(told.map((row) => row.told.tilt)),
      "<=",
      1,
    ),
    line("initial pose given: share confidently wrong", told, share(told, isConfidentlyWrong), "<=", 0),
    line(
      "nothing known: share under 10 degrees",
      known,
      share(known, ({ degrees }) => degrees < 10),
      ">=",
      0.7,
    ),
    line("nothing known: share confidently wrong", known, share(known, isConfidentlyWrong), "<=", 0),
  ];
}

/** Distance of the final poses, in degrees, below which an initial pose counts as ending like the search. */
const SAME_END = 0.5;

function pinholeAims(rows = []) {
  const of = (start) => rows.filter((row) => row.start === start);
  const searched = of("search");
  const middle = (members, key) => median(members.map((row) => row[key]));
  const ends = (start) =>
    share(of(start), (row) => {
      const own = searched.find(({ scene }) => scene === row.scene);
      return own !== undefined && degreesBetween(row.rotation, own.rotation) < SAME_END;
    });
  const sure = rows.filter((row) => isFound(row) && row.sigmas);
  const held = (offs, sigmas) => offs.every((off, axis) => Math.abs(off) <= 3 * sigmas[axis]);
  const [turns, places] = [
    ({ rotationOff, sigmas }) => held(rotationOff, sigmas),
    (row) => held(row.translationOff, row.translationSigmas),
  ];
  return [
    aim("pinhole", "nothing known: median degrees", middle(searched, "degrees"), "<=", 0.35, searched.length),
    aim("pinhole", "nothing known: median mm", middle(searched, "translation"), "<=", 5.5, searched.length),
    ...[1, 2, 4, 8].map((start) =>
      aim(
        "pinhole",
        `${start} degrees off: share that ends like the search`,
        ends(start),
        ">=",
        0.95,
        of(start).length,
      ),
    ),
    aim("pinhole", "share confidently wrong", share(rows, isConfidentlyWrong), "<=", 0, rows.length),
    aim("pinhole", "found: rotations within 3 sigma on all axes", share(sure, turns), ">=", 0.93, sure.length),
    aim("pinhole", "found: translations within 3 sigma on all axes", share(sure, places), ">=", 0.93, sure.length),
  ];
}

function albedoAims(rows = []) {
  const of = (image, pose) => rows.filter((row) => row.image === image && row.pose === pose);
  const told = of("lab_diffuse", "told");
  const plain = of("lab_shading", "told");
  return [
    aim(
      "albedo",
      "photographs, pose given: median correlation with the measured albedo",
      median(told.map(({ correlation }) => correlation)),
      ">=",
      0.85,
      told.length,
    ),
    aim(
      "albedo",
      "photographs, pose given: median of error / naive error",
      median(told.map(({ error, naive }) => error / naive)),
      "<=",
      0.5,
      told.length,
    ),
    aim(
      "albedo",
      "shading alone: largest error, log units",
      worst(plain.map(({ error }) => error)),
      "<=",
      0.02,
      plain.length,
    ),
  ];
}

function randomAims(row) {
  if (!row) return [];
  const { cases, found } = row;
  const perAxis = row.coverage1PerAxis.filter((value) => value !== null);
  return [
    aim("random", `share under ${FOUND_WITHIN} degrees`, found / cases, ">=", 0.95, cases),
    aim("random", "median degrees of those", row.medianDegrees, "<=", 0.4, found),
    aim("random", "share confidently wrong", row.confidentlyWrong / cases, "<=", 0.01, cases),
    aim("random", "share of the good ones flagged", row.flaggedThoughFound / found, "<=", 0.1, found),
    aim("random", "found within 3 sigma on all axes", row.coverage3, ">=", 0.95, found),
    aim("random", "found within 1 sigma, lowest axis", least(perAxis), ">=", 0.5, found),
    aim("random", "found within 1 sigma, highest axis", worst(perAxis), "<=", 0.85, found),
  ];
}

function paintedAims(table, row) {
  if (!row) return [];
  const { cases, found } = row;
  return [
    aim(table, `share under ${FOUND_WITHIN} degrees`, found / cases, ">=", 0.9, cases),
    aim(table, "median degrees of those", row.medianDegrees, "<=", 0.5, found),
    aim(table, "share confidently wrong", row.confidentlyWrong / cases, "<=", 0.01, cases),
    aim(table, "found within 3 sigma on all axes", row.coverage3, ">=", 0.93, found),
  ];
}

/** Aims for all cases and for each kind; found poses are judged by their sigmas. */
function honestyAims(row) {
  if (!row) return [];
  const each = row.kinds.filter(({ cases }) => cases > 0);
  return [
    aim("honesty", "share confidently wrong", row.confidentlyWrong / row.cases, "<=", 0.005, row.cases),
    aim(
      "honesty",
      "share confidently wrong, the worst kind",
      worst(each.map(({ confidentlyWrong, cases }) => confidentlyWrong / cases)),
      "<=",
      0.02,
      row.cases,
    ),
    aim(
      "honesty",
      "found within 3 sigma on all axes, the worst kind",
      least(each.map(({ coverage3 }) => coverage3).filter((value) => value !== null)),
      ">=",
      0.95,
      row.found,
    ),
  ];
}

/** A pose must move by less than its sigma in 95 % of the cases. */
const perturbationAims = (rows = []) => [
  aim(
    "perturbation",
    "moves by less than its sigma",
    share(rows, ({ isWithin }) => isWithin),
    ">=",
    0.95,
    rows.length,
  ),
];

const exposureAims = (rows = []) => [
  aim(
    "exposure",
    "largest move of a pose, degrees",
    worst(rows.map(({ degreesMoved }) => degreesMoved)),
    "<=",
    0.01,
    rows.length,
  ),
];

/** Every aim of the tables that are present. */
export const aims = (json) =>
  [
    ...(json.table1 ? table1Aims(json.table1) : []),
    ...(json.table2A ? table2AAims(json.table2A) : []),
    ...(json.table2B ? table2BAims(json.table2B) : []),
    ...(json.figure5 ? figure5Aims(json.figure5) : []),
    ...(json.refinement ? refinementAims(json.refinement) : []),
    ...(json.sensors ? sensorsAims(json.sensors) : []),
    ...(json.photographs ? photographsAims(json.photographs) : []),
    ...(json.conditions ? conditionsAims(json.conditions) : []),
    ...unseenAims(json.unseen),
    ...(json.rgbd ? rgbdAims(json.rgbd) : []),
    ...(json.pinhole ? pinholeAims(json.pinhole) : []),
    ...(json.albedo ? albedoAims(json.albedo) : []),
    ...randomAims(json.random),
    ...paintedAims("cameras", json.cameras),
    ...paintedAims("painted", json.painted),
    ...softAims(json.soft),
    ...paintedAims("stress", json.stress),
    ...honestyAims(json.honesty),
    ...(json.exposure ? exposureAims(json.exposure) : []),
    ...perturbationAims(json.perturbation),
  ].filter(({ rows }) => rows > 0);
