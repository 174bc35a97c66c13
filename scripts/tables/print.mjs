// Formats the tables as text.
import { coverage3, isConfidentlyWrong, isFound } from "../../protocols/counts.mjs";
import { mean, median, share, worst } from "../../protocols/numbers.mjs";
import { paperDegrees } from "../../protocols/rotations.mjs";
import { PAPER_TABLE_1, PAPER_TABLE_3 } from "../../protocols/scenes.mjs";
import { columns, DASH, fixed, mark, percent, unique } from "./columns.mjs";
import { pinhole, rgbd, statue } from "./print-perspective.mjs";

/** Number of failures shown of a list; the JSON has all. */
const WRONG_SHOWN = 20;
const WORST_SHOWN = 5;
const small = (value) =>
  typeof value === "number" ? (value < 1e-4 ? value.toExponential(1) : value.toFixed(6)) : DASH;
function table1(rows) {
  const keys = ["scale", "alpha", "beta", "gamma", "iterations", "degrees"];
  const digits = (key) => (key === "iterations" ? 0 : 4);
  const line = (name, row) => [name, ...keys.map((key) => fixed(row[key], digits(key))), row.status ?? ""];
  return columns([
    ["protocol", ...keys, "status"],
    line("paper, +20", PAPER_TABLE_1),
    ...rows.map((row) => line(`${row.protocol}, ${row.sign > 0 ? "+" : "-"}20`, row)),
  ]);
}

/** Beta in rows, overlap in columns; for each beta, one line for every kind of figure. */
function matrix(rows, kinds) {
  const [betas, overlaps] = ["beta", "overlap"].map((key) => unique(rows.map((row) => row[key])).sort((a, b) => a - b));
  const at = (beta, overlap) => rows.find((row) => row.beta === beta && row.overlap === overlap);
  return columns([
    ["beta", "P_w", ...overlaps],
    ...betas.flatMap((beta) =>
      kinds.map(([name, show], index) => [
        index === 0 ? beta : "",
        name,
        ...overlaps.map((overlap) => (at(beta, overlap) ? show(at(beta, overlap)) : "")),
      ]),
    ),
  ]);
}

const table2A = (rows) =>
  matrix(rows, [
    ["paper", ({ paper }) => small(paper)],
    ["ours", (row) => small(row.error) + mark(row)],
  ]);

function table2B(rows, open3d) {
  const blocks = unique(rows.map(({ size, lightName, light }) => `${size}x${size}, ${lightName}, light ${light}`));
  return blocks.flatMap((block) => {
    const members = rows.filter(
      ({ size, lightName, light }) => `${size}x${size}, ${lightName}, light ${light}` === block,
    );
    const ratios = members.filter(({ bound }) => bound > 0).map(({ degrees, bound }) => degrees / bound);
    const baseline = (row) => open3d(row);
    return [
      `  ${block}: degrees (median ${fixed(median(members.map(({ degrees }) => degrees)))}, ${fixed(median(ratios), 1)} times the bound)`,
      ...matrix(members, [
        ["paper", ({ paper }) => fixed(paperDegrees(paper))],
        ...(members.some(baseline) ? [["Open3D", (row) => fixed(baseline(row))]] : []),
        ["ours", (row) => fixed(row.degrees) + mark(row)],
        ["bound", ({ bound }) => fixed(bound)],
      ]),
    ];
  });
}

function table3(rows) {
  const pose = ({ scale, angles: { alpha, beta, gamma } }) =>
    [scale, alpha, beta, gamma].map((value) => fixed(value, 2));
  return columns([
    ["pair", "s", "alpha", "beta", "gamma", "iterations", "residual", "degrees", "(within)", "identity", "status"],
    [
      "paper, food_box",
      ...pose({ ...PAPER_TABLE_3, angles: PAPER_TABLE_3 }),
      PAPER_TABLE_3.iterations,
      ...Array(5).fill(DASH),
    ],
    ...rows.map((row) => [
      ...[row.name, ...pose(row.pose), row.iterations, `${fixed(row.residualBefore)} -> ${fixed(row.residualAfter)}`],
      ...[fixed(row.degrees, 2), fixed(row.truthWithin, 2), fixed(row.identityDegrees, 2), row.status],
    ]),
  ]);
}

const figure4 = (rows) =>
  columns([
    ["run", "iteration", "depth rmse", "degrees"],
    ...rows.map((row) => [`${row.run}, ${row.protocol}`, row.iteration, fixed(row.depthRmse), fixed(row.degrees, 4)]),
  ]);

function figure5(rows) {
  const fractions = unique(rows.map(({ fraction }) => fraction)).sort((a, b) => a - b);
  const nameOf = ({ size, lightName, shading }) => `${size}x${size}, ${lightName}, ${shading}`;
  return columns([
    ["degrees (depth rmse)", ...fractions.map((fraction) => `P_er ${fraction}`)],
    ...unique(rows.map(nameOf)).map((name) => [
      name,
      ...fractions.map((fraction) => {
        const row = rows.find((other) => nameOf(other) === name && other.fraction === fraction);
        return row ? `${fixed(row.degrees, 2)} (${fixed(row.depthRmse, 2)})` : "";
      }),
    ]),
  ]);
}

const figure6 = (rows) =>
  columns([
    ["overlap", "paper", "ours, 2A", "ours, 2B 128x128"],
    ...rows.map((row) => [row.overlap, small(row.paper), small(row.error), small(row.rendered)]),
  ]);

const figure7 = (rows) =>
  columns([
    ["pair", "holes before", "after", "normals turned by"],
    ...rows.map((row) => [row.name, row.holesBefore, row.holesAfter, fixed(row.normalChange, 2)]),
  ]);

const refinement = (rows) =>
  columns([
    ["light", "pose", "before", "after", "in holes", "gain", "degrees", "status"],
    ...rows.map(({ lightName, pose, before, after, holes, gain, degrees, statuses }) => [
      ...[
        lightName,
        pose,
        fixed(before),
        fixed(after),
        fixed(holes),
        `x${fixed(gain, 2)}`,
        fixed(degrees),
        unique(statuses).join(", "),
      ],
    ]),
  ]);

function sensors(rows) {
  const sized = (error, sigma) => `${fixed(error)} (${sigma})`;
  const times = (ratio) => `x${fixed(ratio, 2)}`;
  return columns([
    [
      ...["sensor", "object", "half", "before", "after", "ratio", "of means"],
      ...["blur", "blur / ours", "RMS", "of blur", "blur / ours", "status"],
    ],
    ...rows.map((row) => [
      ...[
        row.sensor,
        row.object,
        row.half,
        fixed(row.before),
        fixed(row.after),
        times(row.ratio),
        times(row.meanRatio),
      ],
      ...[sized(row.blur, row.blurSigma), times(row.overBlur)],
      ...[fixed(row.rms), sized(row.blurRms, row.blurRmsSigma), times(row.rmsOverBlur), row.status],
    ]),
  ]);
}

function photographs(rows) {
  const [betas, images] = [unique(rows.map(({ beta }) => beta)), unique(rows.map(({ image }) => image))];
  const cell = (object, image, beta) =>
    rows.find((row) => row.object === object && row.image === image && row.beta === beta);
  const show = (row) => (row ? fixed(row.degrees, 2) + mark(row) : "");
  const medians = images.map((image) =>
    median(rows.filter((row) => row.image === image).map(({ degrees }) => degrees)),
  );
  const costs =
    images.length < 3
      ? []
      : [
          `  cost, by medians: albedo ${fixed(medians[0] - medians[1], 2)}, cast shadows and one white lamp ${fixed(medians[1] - medians[2], 2)} degrees`,
        ];
  return [
    ...columns([
      ["object", "image", ...betas.map((beta) => `beta ${beta}`)],
      ...unique(rows.map(({ object }) => object)).flatMap((object) =>
        images.map((image) => [object, image, ...betas.map((beta) => show(cell(object, image, beta)))]),
      ),
      [
        "median",
        "",
        ...betas.map((beta) => fixed(median(rows.filter((row) => row.beta === beta).map(({ degrees }) => degrees)), 2)),
      ],
    ]),
    ...costs,
    ...columns([
      SUMMED,
      ...images.map((image) =>
        summed(
          image,
          rows.filter((row) => row.image === image),
        ),
      ),
    ]),
  ];
}

/** Summary of the rows of one kind. */
const summed = (name, rows) => {
  const degrees = rows.map((row) => row.degrees);
  return [
    name,
    rows.length,
    fixed(median(degrees), 2),
    fixed(mean(degrees), 2),
    percent(share(rows, isFound)),
    rows.filter(isConfidentlyWrong).length,
    percent(coverage3(rows)),
  ];
};
const SUMMED = ["", "cells", "median", "mean", "under 3", "confidently wrong", "found within 3 sigma"];

function conditions(rows) {
  const [betas, kinds] = [unique(rows.map(({ beta }) => beta)), unique(rows.map(({ condition }) => condition))];
  const of = (condition) => rows.filter((row) => row.condition === condition);
  const show = (row) => (row ? fixed(row.degrees, 2) + mark(row) : "");
  return [
    ...kinds.flatMap((condition) =>
      columns([
        [condition, ...betas.map((beta) => `beta ${beta}`)],
        ...unique(of(condition).map(({ object }) => object)).map((object) => [
          object,
          ...betas.map((beta) => show(of(condition).find((row) => row.object === object && row.beta === beta))),
        ]),
      ]),
    ),
    ...columns([SUMMED, ...kinds.map((condition) => summed(condition, of(condition)))]),
  ];
}

function albedo(rows) {
  const groups = unique(rows.map(({ image, pose }) => `${image}, pose ${pose}`));
  const cell = (object, group) =>
    rows.find((row) => row.object === object && `${row.image}, pose ${row.pose}` === group);
  const show = (row) =>
    row ? `${fixed(row.correlation, 2)} ${fixed(row.error, 3)} (${fixed(row.naive, 2)}) ${fixed(row.normals, 1)}` : "";
  const middle = (group) => {
    const members = rows.filter((row) => `${row.image}, pose ${row.pose}` === group);
    const of = (key) => median(members.map((row) => row[key]));
    return `${fixed(of("correlation"), 2)} ${fixed(of("error"), 3)} (${fixed(of("naive"), 2)}) ${fixed(of("normals"), 1)}`;
  };
  return [
    "  correlation, error in log units (naive), and degrees that the image's normals are off",
    ...columns([
      ["object", ...groups],
      ...unique(rows.map(({ object }) => object)).map((object) => [
        object,
        ...groups.map((group) => show(cell(object, group))),
      ]),
      ["median", ...groups.map(middle)],
    ]),
  ];
}

const random = (row) => [
  `  ${row.cases} scenes: ${row.found} found, ${row.confidentlyWrong} confidently wrong, ${row.ambiguousOrLost} ambiguous or lost ` +
    `(${row.flaggedThoughFound} of them found)`,
  `  median of the found ${fixed(row.medianDegrees)} degrees; within 1 sigma ${percent(row.coverage1)} ` +
    `(x, y, z: ${row.coverage1PerAxis.map(percent).join(", ")}), within 3 sigma ${percent(row.coverage3)}; ` +
    `${fixed(row.meanMilliseconds / 1000, 2)} s each`,
  ...row.scenes
    .filter(isConfidentlyWrong)
    .slice(0, WRONG_SHOWN)
    .map(
      ({ scene, surface, degrees, status, overlap }) =>
        `  wrong: scene ${scene}, ${surface}, ${fixed(degrees, 1)} degrees, ${status}, P_w ${fixed(overlap, 2)}`,
    ),
];

const byKind = (row) => [
  ...random(row),
  ...columns([
    ["kind", "found", "median degrees", "confidently wrong", "flagged though found", "within 3 sigma"],
    ...row.kinds.map(({ kind, cases, found, medianDegrees, confidentlyWrong, flaggedThoughFound, coverage3 }) => [
      ...[kind, `${found} of ${cases}`, fixed(medianDegrees), confidentlyWrong, flaggedThoughFound, percent(coverage3)],
    ]),
  ]),
];

function exposure(rows) {
  const factors = unique(rows.map(({ factor }) => factor));
  const moved = (factor) => rows.filter((row) => row.factor === factor).map(({ degreesMoved }) => degreesMoved);
  const most = rows.filter(({ degreesMoved }) => degreesMoved !== null).sort((a, b) => b.degreesMoved - a.degreesMoved);
  return [
    ...columns([
      ["colours x", "scenes", "median move", "worst, degrees"],
      ...factors.map((factor) => [
        factor,
        moved(factor).length,
        small(median(moved(factor))),
        small(worst(moved(factor))),
      ]),
    ]),
    ...most
      .slice(0, WORST_SHOWN)
      .map(
        ({ scene, factor, degreesMoved, degrees, status }) =>
          `  scene ${scene} x${factor}: moved ${small(degreesMoved)}, ${fixed(degrees)} degrees off, ${status}`,
      ),
  ];
}

/** A line for each kind of cell, for each change, and for all. */
function perturbation(rows) {
  const line = (name, some) => [
    name,
    `${some.filter(({ isWithin }) => isWithin).length} of ${some.length}`,
    fixed(median(some.map(({ degrees }) => degrees))),
    fixed(Math.max(...some.map(({ degrees }) => degrees))),
  ];
  const lines = (key) =>
    unique(rows.map((row) => row[key])).map((value) =>
      line(
        value,
        rows.filter((row) => row[key] === value),
      ),
    );
  return columns([
    ["", "moves by less than its sigma", "median degrees", "worst"],
    ...lines("kind"),
    ...lines("change"),
    line("all", rows),
  ]);
}

const ablation = (rows) =>
  columns([
    ["without", "found", "median degrees of those", "confidently wrong"],
    ...rows.map((row) => [row.without, `${row.found} of ${row.cases}`, fixed(row.medianDegrees), row.confidentlyWrong]),
  ]);

const SHOWS = {
  ...{ table1, table2A, table2B, table3, figure4, figure5, figure6, figure7 },
  ...{
    refinement,
    sensors,
    photographs,
    conditions,
    unseen: conditions,
    albedo,
    rgbd,
    statue,
    pinhole,
    parts: byKind,
    random,
    cameras: byKind,
    painted: random,
    soft: byKind,
    stress: byKind,
    honesty: byKind,
    exposure,
    perturbation,
    ablation,
  },
};

/** The lines of one table; `open3d` gives the baseline's degrees for a row of Table 2B, if there are any. */
export function show({ name, title, notes = [] }, rows, open3d = () => undefined) {
  const empty = rows.length === 0 || rows.cases === 0;
  return [
    title,
    ...notes.map((note) => `  ${note}`),
    ...(empty ? ["  nothing to show"] : SHOWS[name](rows, open3d)),
    "",
  ];
}

/** Every aim with its value and verdict. */
export const showAims = (list) => [
  "Aims (computed from the rows above)",
  ...columns([
    ["aim", "rows", "measured", "limit", ""],
    ...list.map(({ table, what, rows, measured, sense, limit, ok }) => [
      `${table}: ${what}`,
      rows,
      Math.abs(measured) < 1e-3 && measured !== 0 ? measured.toExponential(1) : fixed(measured),
      `${sense} ${limit}`,
      ok ? "ok" : "MISSED",
    ]),
  ]),
];
