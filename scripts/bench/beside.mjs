// npm run bench -- --beside: the package and what a person would write instead (scripts/reference/beside), run in turn.
//
// Ours is the built package in Node, on one thread: the same .wasm as on the page, in a process without windows, as theirs is. Each round
// times one iteration of both sides from the true pose, ICP, and an answer from the two views alone.
import { readFileSync } from "node:fs";
import { isFound } from "../../protocols/counts.mjs";
import { median } from "../../protocols/numbers.mjs";
import { inRoot, say } from "../shell.mjs";
import { runLoop, sceneOf } from "./page/runs.js";
import { theirSide } from "./theirs.mjs";

const SHAPES = ["light", "shading", "surface", "refinement"];
const STAGES = ["preparation", "light", "shading", "surface", "registration", "refinement", "step"];
/** A limit of iterations that is never reached. */
const TO_THE_END = 1000;
/** An iteration that takes less than this share of the one before it keeps settled shapes. */
const KEPT = 0.01;
export const ICP = "registration by ICP";
export const ANSWER = "answer";
/** Seconds after which a measurement of theirs is given up. */
const LIMIT = 300;
/** Rounds at one size end after so many, or once they have taken so many seconds. */
const ROUNDS = 5;
const PATIENCE = 120;

const RANDOM_SIZES = ["64x64", "128x128"];
export const FULL_BESIDE = {
  ...{ sizes: ["64x64", "128x128", "640x480"], rounds: ROUNDS },
  ...{ randomSizes: RANDOM_SIZES, randomScenes: 8 },
};
export const QUICK_BESIDE = { sizes: ["64x64"], rounds: 1, randomSizes: ["64x64"], randomScenes: 2 };

const sum = (values) => values.reduce((total, value) => total + value, 0);

/**
 * Times of an iteration by stage: the registration of the first, which later iterations skip, and the shapes of the last iteration that
 * did not keep settled ones. In larger views that is the third, in which the surface also tries the last of its initial values.
 */
export function iterationOf({ stages, preparation }) {
  const each = [];
  for (const { stage, iteration, milliseconds } of stages) (each[iteration] ??= {})[stage] = milliseconds;
  const shapes = each.map((times) => sum(SHAPES.map((stage) => times[stage])));
  const last = shapes.findLastIndex((time, index) => index === 0 || time > KEPT * shapes[index - 1]);
  const { registration } = each[0];
  const { light, shading, surface, refinement } = each[last];
  return { preparation, light, shading, surface, registration, refinement, step: shapes[last] + registration };
}

/** The package in this process. */
function ourSide({ Estimator }) {
  let scene;
  const run = (request) => runLoop(Estimator, scene, request);
  return {
    open({ path }) {
      scene = sceneOf(new Uint8Array(readFileSync(inRoot(path))).buffer);
    },
    /** The stages of an iteration, from the true pose, where a search would end, and the error of its registration. */
    async step() {
      const times = iterationOf(await run({ start: "near", most: TO_THE_END }));
      // The registration does not use the image's surface, so the fastest way of computing that surface serves here.
      const { degrees } = await run({ start: "near", shading: "pixel", most: 1 });
      return { times, degrees };
    },
    async icp() {
      const { stages, degrees } = await run({ start: "near", registration: "icp", most: 1 });
      return { milliseconds: stages.find(({ stage }) => stage === "registration").milliseconds, degrees };
    },
    answer: () => run({ start: "search", most: TO_THE_END }),
  };
}

/** Times and errors of one size by stage, in lists for both sides. */
function book() {
  const kept = new Map();
  const empty = () => ({ ours: [], theirs: [], ourDegrees: [], theirDegrees: [] });
  return {
    /** A time is null if it was over the limit; what is undefined was not measured. */
    add(stage, side, milliseconds, degrees) {
      if (!kept.has(stage)) kept.set(stage, empty());
      const row = kept.get(stage);
      if (milliseconds !== undefined) row[side].push(milliseconds);
      if (degrees !== undefined) row[side === "ours" ? "ourDegrees" : "theirDegrees"].push(degrees);
    },
    rows: (size, limit) => [...kept].map(([stage, row]) => rowOf(stage, size, row, limit)),
  };
}

/** One row; a side that was over the limit has `over`, the limit in milliseconds, and no time. */
export function rowOf(stage, size, { ours, theirs, ourDegrees, theirDegrees }, limit) {
  const isOver = theirs.includes(null);
  const [mine, other] = [median(ours), isOver ? null : median(theirs)];
  return {
    ...{ stage, size, samples: ours.length, ours: mine, theirs: other, over: isOver ? 1000 * limit : null },
    ratio: (isOver ? 1000 * limit : other) / mine,
    ...{ ourDegrees: median(ourDegrees), theirDegrees: median(theirDegrees) },
  };
}

async function round(ours, theirs, kept) {
  const [{ times, degrees }, step] = [await ours.step(), await theirs.step()];
  for (const stage of STAGES) {
    kept.add(stage, "ours", times[stage]);
    kept.add(stage, "theirs", step && step.milliseconds[stage]);
  }
  kept.add("registration", "ours", undefined, degrees);
  kept.add("registration", "theirs", undefined, step?.degrees);
  if (theirs.hasOpen3d) {
    const { milliseconds, degrees: off } = await ours.icp();
    kept.add(ICP, "ours", milliseconds, off);
    kept.add(ICP, "theirs", step && step.milliseconds.ICP, step?.icpDegrees);
  }
  const [mine, other] = [await ours.answer(), await theirs.answer()];
  kept.add(ANSWER, "ours", mine.milliseconds, mine.degrees);
  kept.add(ANSWER, "theirs", other && other.milliseconds.answer, other?.degrees);
}

/** All rows of one size. */
async function sized(ours, theirs, scene, { size, rounds }) {
  const [kept, begun] = [book(), performance.now()];
  ours.open(scene);
  await theirs.open(scene);
  // The first runs are not counted: ours is compiled during them, and theirs settles the shapes that a steady iteration begins with.
  await ours.step();
  await theirs.step();
  for (let count = 0; count < rounds && (count === 0 || performance.now() - begun < 1000 * PATIENCE); count++) {
    await round(ours, theirs, kept);
    say(`${size}: ${count + 1} of at most ${rounds} rounds, ${((performance.now() - begun) / 1000).toFixed(0)} s`);
  }
  return kept.rows(size, theirs.limit);
}

/** Random surfaces, lights, poses and scales: how many poses each side finds, and the median time. */
async function searched(ours, theirs, made, { size, scenes }) {
  const found = { ours: [], theirs: [] };
  for (let seed = 1; seed <= scenes; seed++) {
    const scene = made.random(size, seed);
    ours.open(scene);
    await theirs.open(scene);
    found.ours.push(await ours.answer());
    const answer = await theirs.answer();
    found.theirs.push({ degrees: answer?.degrees ?? null, milliseconds: answer?.milliseconds.answer ?? null });
    say(
      `${size}, scene ${seed}: ${[found.ours, found.theirs].map((list) => list.at(-1).degrees?.toFixed(2) ?? "over")}`,
    );
  }
  const summed = (list) => ({
    found: list.filter(isFound).length,
    medianDegrees: median(list.filter(isFound).map(({ degrees }) => degrees)),
    milliseconds: median(list.map(({ milliseconds }) => milliseconds)),
    degrees: list.map(({ degrees }) => degrees),
  });
  return { size, scenes, ours: summed(found.ours), theirs: summed(found.theirs) };
}

/** Measures both sides at every size; the result is the JSON. */
export async function measureBeside(api, made, { sizes, rounds, randomSizes, randomScenes }) {
  const [ours, theirs] = [ourSide(api), await theirSide({ limit: LIMIT })];
  try {
    const [rows, random] = [[], []];
    for (const size of sizes) rows.push(...(await sized(ours, theirs, made.plain(size), { size, rounds })));
    for (const size of randomSizes) random.push(await searched(ours, theirs, made, { size, scenes: randomScenes }));
    return { rows, random, limit: LIMIT, open3d: theirs.hasOpen3d, surface: made.surface, lightName: made.lightName };
  } finally {
    theirs.close();
  }
}
