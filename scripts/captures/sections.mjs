// The three parts of the measurement: the rows of each, and their printed summary.
import { percent, poseOf, quantile } from "../rigs/draws.mjs";
import { IDENTITY } from "../../protocols/rotations.mjs";
import { costs } from "./costs.mjs";
import { ranked, seedOf, toldOff } from "./draws.mjs";
import { checkFrame, nyu, registered, sevenScenes } from "./read.mjs";

/** Errors of 1, 2 and 4 degrees, each with 20, 40 and 60 mm. */
const CLEARLY_OFF = [1, 2, 4].flatMap((degrees) => [20, 40, 60].map((millimetres) => ({ degrees, millimetres })));
const NEARLY_RIGHT = { degrees: 0.1, millimetres: 3 };
const HALF_A_DEGREE = { degrees: 0.5, millimetres: 20 };
const ONE_DEGREE = { degrees: 1, millimetres: 20 };
const TOLD = { degrees: 3, millimetres: 20 };
const FARTHER = { degrees: 3, millimetres: 50 };
/** Wrong candidates of each kind in a draw; with the first and the true candidate, this is the most that a check takes. */
const RIVALS = [1, 2, 5]
  .map((degrees) => ({ degrees, millimetres: 0 }))
  .concat([5, 10, 20].map((millimetres) => ({ degrees: 0, millimetres })));
const EACH = 2;

const within = ({ fit }, { degrees, millimetres }) => fit.degrees <= degrees && fit.millimetres <= millimetres;
const count = (rows, test) => `${rows.filter(test).length} of ${rows.length}`;
const draws = (number) => Array.from({ length: number }, (_, draw) => draw);
const at = (rows, value, share) => quantile(rows.map(value), share);
const spread = (rows) =>
  [0.5, 0.9]
    .map(
      (share) =>
        `${at(rows, ({ fit }) => fit.degrees, share).toFixed(2)} deg, ${at(rows, ({ fit }) => fit.millimetres, share).toFixed(1)} mm`,
    )
    .join(" (90 %: ") + ")";

/** The share of each verdict and the refined error of one frame's candidates, for large and small errors. */
export async function verdicts(frames, { check, number, progress }) {
  const rows = [];
  const name = frames[0].name;
  for (const draw of draws(number)) {
    const error = CLEARLY_OFF[draw % CLEARLY_OFF.length];
    rows.push({ part: "off", ...(await toldOff(check, frames, error, { seed: seedOf(`${name} off`, draw) })) });
    rows.push({
      part: "near",
      ...(await toldOff(check, frames, NEARLY_RIGHT, { seed: seedOf(`${name} near`, draw) })),
    });
    progress(`${name} ${draw + 1} of ${number}`);
  }
  return rows;
}

export function printVerdicts(name, rows) {
  const [off, near] = ["off", "near"].map((part) => rows.filter((row) => row.part === part));
  console.log(`\n${name}: the truth hidden behind 10 degrees and 100 mm`);
  console.log(
    `  off by 1, 2, 4 deg and 20 to 60 mm: "off" in ${count(off, ({ verdict }) => verdict === "off")} (aim: all), "consistent" in ${count(off, ({ verdict }) => verdict === "consistent")}`,
  );
  console.log(
    `  .. refined to 0.5 deg, 20 mm in ${count(off, (row) => within(row, HALF_A_DEGREE))} (aim: 16 of 20); median ${spread(off)}`,
  );
  console.log(
    `  off by 0.1 deg, 3 mm: "consistent" in ${count(near, ({ verdict }) => verdict === "consistent")} (aim: 18 of 20), "off" in ${count(near, ({ verdict }) => verdict === "off")}`,
  );
}

export const room = async (options) => verdicts([nyu(options.files)], options);

const NOWHERE = poseOf(IDENTITY, [0, 0, 0]);
const withFocal = (frame, focal) => ({
  ...frame,
  image: { ...frame.image, camera: { ...frame.image.camera, fx: focal, fy: focal } },
});
/** Nominal focal lengths of a Kinect v1: 525 pixels for the colour camera and 585 for the depth camera. */
const [WRITTEN, NOMINAL] = [585, 525];
const MOMENTS = [150, 160, 190];

/** The offset between the cameras that each of several focal lengths implies, from colour and depth of one moment. */
async function focals({ check, files, progress }) {
  const rows = [];
  for (const moment of MOMENTS) {
    const frame = sevenScenes(moment, moment, files);
    for (const focal of [WRITTEN, (WRITTEN + NOMINAL) / 2, NOMINAL]) {
      const assumed = withFocal(frame, focal);
      const { estimate } = await check([checkFrame(assumed)], { told: NOWHERE });
      const { near } = costs(assumed, NOWHERE);
      const millimetres = estimate.translation.map((value) => 1000 * value);
      rows.push({
        part: "focal",
        moment,
        focal,
        millimetres,
        near: near(estimate),
        nearUntouched: near(NOWHERE),
        estimate,
      });
    }
    progress(`seven_scenes, focal length at ${moment}`);
  }
  return rows;
}

export async function scenes(options) {
  const { check, files, number, progress } = options;
  const rows = await focals(options);
  // The offset between the two cameras, from the frame whose colours the draws do not use.
  const { estimate: correction } = rows.find(({ moment, focal }) => moment === MOMENTS[0] && focal === NOMINAL);
  const pair = MOMENTS.slice(1).map((to) => sevenScenes(MOMENTS[0], to, files));
  const sets = [...pair.map((frame) => [`150 onto ${frame.name.slice(-3)}`, [frame]]), ["both frames", pair]];
  for (const [name, frames] of sets) {
    const right = frames.map((frame) => withFocal(frame, NOMINAL));
    // A few draws suffice for the focal length in the files.
    for (const [focal, set, times, better] of [
      [WRITTEN, frames, Math.ceil(number / 5)],
      [NOMINAL, right, number, correction],
    ]) {
      for (const draw of draws(times)) {
        const row = await toldOff(check, set, FARTHER, {
          seed: seedOf(`seven_scenes ${name}`, draw),
          correction: better,
        });
        rows.push({ ...row, part: "pose", name, assumed: focal });
      }
      progress(`seven_scenes ${name}, focal length ${focal}`);
    }
  }
  return rows;
}

export function printScenes(rows) {
  console.log(
    "\nseven_scenes, colour and depth of one moment, from the identity: where the check puts the colour camera",
  );
  console.log(
    "moment  focal length  x, y, z mm          depth edges within 2 px of an image edge: there, at the identity",
  );
  for (const { moment, focal, millimetres, near, nearUntouched } of rows.filter(({ part }) => part === "focal")) {
    console.log(
      `${moment}     ${focal}           ${millimetres
        .map((value) => value.toFixed(0))
        .join(", ")
        .padEnd(18)}  ${near.toFixed(2)}, ${nearUntouched.toFixed(2)}`,
    );
  }
  console.log(
    "\nseven_scenes, depth of 150 onto other colours, off by 3 deg, 50 mm, against its makers' poses (585), or these after the cameras' offset at 150 (525)",
  );
  const poses = rows.filter(({ part }) => part === "pose");
  for (const key of new Set(poses.map(({ name, assumed }) => `${name}, ${assumed}`))) {
    const some = poses.filter(({ name, assumed }) => `${name}, ${assumed}` === key);
    console.log(
      `  ${key.padEnd(19)} within 1 deg, 20 mm: ${count(some, (row) => within(row, ONE_DEGREE)).padEnd(8)} median ${spread(some)}; the candidate is "off" in ${count(some, ({ verdict }) => verdict === "off")}`,
    );
  }
}

/** Sets of three objects in front of one Kinect. */
const trios = (all) => {
  const first = all.filter(({ name }) => /_1 1$/.test(name));
  return first.map((_, left) => first.filter((_, index) => index !== left));
};

export async function objects(options) {
  const { check, files, number, progress } = options;
  const all = registered(files);
  const rooms = [nyu(files), ...MOMENTS.slice(1).map((to) => withFocal(sevenScenes(MOMENTS[0], to, files), NOMINAL))];
  const times = Math.ceil(number / 5);
  const rows = [];
  const about = (draw) => (draw % 2 === 0 ? "middle" : "camera");
  for (const [kind, set] of [
    ["objects", all],
    ["rooms", rooms],
  ]) {
    for (const frame of set) {
      for (const draw of draws(times)) {
        const seed = seedOf(`${frame.name} rank`, draw);
        const {
          rows: found,
          verdict,
          near,
        } = await ranked(check, frame, { start: TOLD, errors: RIVALS, each: EACH, seed, about: about(draw) });
        rows.push(...found.map((row) => ({ part: "rank", kind, name: frame.name, draw, verdict, near, ...row })));
        if (kind === "objects")
          rows.push({
            part: "told",
            frames: 1,
            name: frame.name,
            draw,
            ...(await toldOff(check, [frame], TOLD, { seed, about: about(draw) })),
          });
      }
      progress(`${frame.name}: ${times} draws`);
    }
  }
  for (const frames of trios(all)) {
    const name = frames.map((frame) => frame.name.split("_")[0]).join(", ");
    for (const draw of draws(times))
      rows.push({
        part: "told",
        frames: 3,
        name,
        draw,
        ...(await toldOff(check, frames, TOLD, { seed: seedOf(name, draw), about: about(draw) })),
      });
    progress(`${name} as one rig: ${times} draws`);
  }
  return rows;
}

const MEASURES = [
  ["ours: distance from the estimate", "distance"],
  ["ours: pixels of the report", "pixels"],
  ["normalised information distance", "information"],
  ["edge alignment", "edges"],
];

export function printRanking(rows) {
  const mean = (some, measure) =>
    `${Math.round((100 * some.reduce((sum, row) => sum + row[measure], 0)) / some.length)}`.padStart(5);
  const sizesOf = RIVALS.map(({ degrees, millimetres }) => (degrees > 0 ? `${degrees} deg` : `${millimetres} mm`));
  for (const kind of new Set(rows.map((row) => row.kind))) {
    console.log(
      `\n${kind}: share of wrong candidates that are worse than the true one, % (aim for objects: 85, 92, 98; 70, 82, 90)`,
    );
    console.log(`${"".padEnd(34)}${sizesOf.map((size) => size.padStart(7)).join("")}`);
    for (const [title, measure] of MEASURES) {
      const cells = RIVALS.map((rival) =>
        mean(
          rows.filter(
            ({ kind: k, error }) =>
              k === kind && error.degrees === rival.degrees && error.millimetres === rival.millimetres,
          ),
          measure,
        ),
      );
      console.log(`${title.padEnd(34)}${cells.map((cell) => cell.padStart(7)).join("")}`);
    }
  }
  console.log("\nby capture: ours (distance), information, edges over all sizes, %; verdicts on the true candidate");
  for (const name of new Set(rows.map((row) => row.name))) {
    const some = rows.filter((row) => row.name === name);
    const said = ["consistent", "undecided", "off"].map(
      (word) => `${word} ${percent(some.filter(({ verdict }) => verdict === word).length, some.length)}`,
    );
    console.log(
      `${name.padEnd(26)}${["distance", "information", "edges"].map((measure) => mean(some, measure)).join("")}   ${said.join(", ")}`,
    );
  }
}

const PARTS = ["turn", "inPlane", "tilt", "lateral", "along"];
const line = (title, rows, of) => {
  const cell = (part) =>
    [0.5, 0.9]
      .map((share) => at(rows, (row) => of(row)[part], share).toFixed(part === "lateral" || part === "along" ? 1 : 2))
      .join(" / ");
  console.log(`${title.padEnd(26)}${PARTS.map((part) => cell(part).padStart(14)).join("")}`);
};

export function printTold(rows) {
  console.log(
    "\ncandidates 3 deg, 20 mm off, about the object or the camera: median / 90 %, degrees and mm at the object's middle",
  );
  console.log(
    `${"".padEnd(26)}${["turn", "in plane", "tilt", "lateral", "along"].map((title) => title.padStart(14)).join("")}`,
  );
  const one = rows.filter(({ frames }) => frames === 1);
  line("start", one, ({ start }) => start);
  line("refined", one, ({ parts }) => parts);
  const kinect = one.filter(({ name }) => /_1 \d$/.test(name));
  line(".. of rgbd_object", kinect, ({ parts }) => parts);
  line(
    ".. three of them, one rig",
    rows.filter(({ frames }) => frames === 3),
    ({ parts }) => parts,
  );
  for (const name of new Set(one.map((row) => row.name)))
    line(
      `.. ${name}`,
      one.filter((row) => row.name === name),
      ({ parts }) => parts,
    );
  console.log(
    `the candidate is "off" in ${count(one, ({ verdict }) => verdict === "off")}, "consistent" in ${count(one, ({ verdict }) => verdict === "consistent")}`,
  );
}
