// Times the loop run by run, alternating between browser and native, so that a busy machine slows both equally.
import { Failure, say } from "../shell.mjs";

/** Iterations before the steady state: the surface first tries three initialisations (STARTS in src/shape/heights/starts.rs). */
const WARMING = 3;
/** A limit of iterations that is never reached, so that runs go to their end. */
const TO_THE_END = 1000;

/** The times of one kind of stage in a run. */
const timesOf = ({ stages }, wanted) => stages.filter(wanted).map(({ milliseconds }) => milliseconds);

/** The steady iterations of a run, each as its stages by name; for a run that ends earlier, its last iteration. */
function steadyIterations({ stages, iterations }) {
  const first = Math.max(0, Math.min(WARMING, iterations - 1));
  const each = Array.from({ length: Math.max(0, iterations - first) }, () => ({}));
  for (const { stage, iteration, milliseconds } of stages)
    if (each[iteration - first]) each[iteration - first][stage] = milliseconds;
  return each;
}

const sum = (values) => values.reduce((total, value) => total + value, 0);

/**
 * Samples of every stage at one size on one side. The registration computes only in the first iteration of a run; later iterations find
 * that the pose no longer moves and skip it. A step is therefore composed of the other stages of a steady iteration and of a registration
 * that did compute. "standing step" is the steady iteration as it ran, with a settled pose; "last step" is the last iteration of a loop,
 * in which most shapes have settled and are kept. The last iteration counts as steady only if there is no other.
 */
class Samples {
  #steady = [];
  #last = [];
  #registrations = [];
  #preparations = [];

  get steady() {
    return this.#steady.length;
  }

  get registrations() {
    return this.#registrations.length;
  }

  addSteady(run) {
    const steady = steadyIterations(run);
    this.#last.push(steady.at(-1));
    this.#steady.push(...steady.slice(0, Math.max(1, steady.length - 1)));
  }

  /** This holds only for runs without a search, because after a search the first iteration also skips the registration. */
  addRegistration(run) {
    this.#registrations.push(...timesOf(run, ({ stage, iteration }) => stage === "registration" && iteration === 0));
    this.#preparations.push(run.preparation);
  }

  /** [stage, times] in the order of the report. */
  all() {
    const others = ["light", "shading", "surface", "refinement"];
    const registrations = this.#registrations;
    const steps = this.#steady.map(
      (stages, index) => sum(others.map((name) => stages[name])) + registrations[index % registrations.length],
    );
    const of = (name) => this.#steady.map((stages) => stages[name]);
    return [
      ["preparation", this.#preparations],
      ...[
        ["light", of("light")],
        ["shading", of("shading")],
        ["surface", of("surface")],
      ],
      ...[
        ["registration", registrations],
        ["refinement", of("refinement")],
        ["step", steps],
      ],
      ...[
        ["standing step", this.#steady],
        ["last step", this.#last],
      ].map(([name, steps]) => [name, steps.map((stages) => sum(Object.values(stages)))]),
    ];
  }
}

/** Runs until every stage has `least` samples on every side. */
export async function stages(sides, scene, { size, least }) {
  for (const side of sides) await side.open(scene);
  const samples = new Map(sides.map((side) => [side.where, new Samples()]));
  const lacks = (what) => sides.some(({ where }) => samples.get(where)[what] < least);
  // The first runs are not counted, because a browser compiles during them. They start at the true pose. In the smallest views the image
  // does not determine the pose. Their loop ends early, so steady iterations have to follow a search.
  let start = "near";
  for (const side of sides) {
    const { iterations } = await side.run({ start, most: WARMING + 1 });
    if (iterations <= WARMING) start = "search";
  }
  let ends = [];
  while (lacks("steady")) {
    ends = [];
    for (const side of sides) {
      const run = await side.run({ start, most: TO_THE_END });
      const kept = samples.get(side.where);
      kept.addSteady(run);
      if (start === "near") kept.addRegistration(run);
      ends.push({ where: side.where, size, start, ...endOf(run) });
    }
    const done = Math.min(...sides.map(({ where }) => samples.get(where).steady));
    say(`${size}: ${Math.min(done, least)} of ${least} steps`);
    if (ends.some(({ iterations }) => iterations === 0))
      throw new Failure(`${size}: a loop ended before its first iteration was over`);
  }
  // The registration does not use the image's surface, so the fastest way of computing that surface serves here.
  while (lacks("registrations")) {
    for (const side of sides)
      samples.get(side.where).addRegistration(await side.run({ start: "near", shading: "pixel", most: 1 }));
  }
  say(`${size}: ${least} registrations`);
  const rows = sides.flatMap(({ where }) =>
    samples
      .get(where)
      .all()
      .map(([stage, times]) => ({ where, size, stage, times })),
  );
  return { rows, ends: ends.filter((end) => end.start === "near") };
}

/** Samples steady iterations shared by several workers, until there are `least` for each number of workers. */
export async function sharedSteps(sides, scene, { size, least }) {
  const rows = [];
  for (const side of sides) {
    await side.open(scene);
    for (const workers of side.workerCounts.filter((workers) => workers > 1)) {
      const times = [];
      await side.run({ start: "near", most: WARMING + 1, workers });
      while (times.length < least) {
        const run = await side.run({ start: "near", most: TO_THE_END, workers });
        const steady = run.shared.filter(({ iteration }) => iteration >= WARMING);
        if (steady.length === 0) throw new Failure(`${size}: a loop ended before its steady state`);
        times.push(...steady.map(({ milliseconds }) => milliseconds));
      }
      rows.push({ where: `${side.where}, ${workers} workers`, size, stage: "standing step", times });
      say(`${size}: ${least} steps of ${workers} workers`);
    }
  }
  return rows;
}

const endOf = ({ milliseconds, degrees, status, iterations }) => ({ milliseconds, degrees, status, iterations });

/** Complete runs with nothing known but the two views, `times` times on each side. */
export async function searches(sides, scene, { size, times, name = size }) {
  for (const side of sides) await side.open(scene);
  const found = [];
  for (let round = 0; round < times; round++) {
    for (const [side, workers] of sides.flatMap((side) => side.workerCounts.map((workers) => [side, workers]))) {
      const where = workers > 1 ? `${side.where}, ${workers} workers` : side.where;
      const run = await side.run({ start: "search", most: TO_THE_END, workers });
      const search = sum(timesOf(run, ({ stage }) => stage === "search"));
      found.push({ where, size, scene: name, start: "search", ...endOf(run), search, longestSlice: run.longestSlice });
      say(
        `${name}, ${where}: ${run.status} after ${(run.milliseconds / 1000).toFixed(1)} s, ${run.degrees.toFixed(2)} degrees off`,
      );
    }
  }
  return found;
}
