// npm run rigs: measures how often the check of a calibration is right, on rendered rigs with known extrinsics.
//
// --rigs N     rigs of each kind (default 5), seeds from --from (default 100; seeds below 20 were used to choose constants)
// --frames K   frames of a rig (default 1 and 3)
// --kinds A,B  of objects, sheet, boxes, room
// --keep S     share of the depths that are kept at random (default 1), as in a sparse map
// --rings N    rows of the depth map that are kept, evenly spaced, as the rings of a LiDAR
// --json FILE  one row for each check
// --confusions instead: whether the first sentence of a check names common mistakes, on rigs of all kinds in turn and on nyu_raw_pair if
//              the third-party data are there --only A,B of the confusions, by name --right N number of right rigs of which a check should
//              name no mistake (default 40), seeds from --from --off N number of rigs whose candidates are merely off, not misread (default
//              40), seeds from --from --next instead: whether the frame that a check of one frame proposes sharpens it as predicted, --rigs
//              rigs of each kind --step N distance of the seeds of --confusions (default 2: odd seeds test what was chosen on even ones)
import { writeFileSync } from "node:fs";
import { parseArgs } from "node:util";
import { build } from "./build.mjs";
import { nyuRig } from "./captures/read.mjs";
import { hasData } from "./real-pairs.mjs";
import { CONFUSIONS, confused, merelyOff, printConfused, printOff, printRight, right } from "./rigs/confusions.mjs";
import { printProposed, proposed } from "./rigs/next.mjs";
import { chance, offset, percent, quantile, sizes, thinned, wrong } from "./rigs/draws.mjs";
import { Failure, inRoot, say, script, seconds } from "./shell.mjs";

/** Candidates: degrees about a random axis through the colour camera, millimetres in a random direction. */
const ERRORS = [
  { degrees: 0, millimetres: 0 },
  { degrees: 0.25, millimetres: 2.5 },
  { degrees: 0.5, millimetres: 5 },
  { degrees: 1, millimetres: 10 },
  { degrees: 2, millimetres: 20 },
  { degrees: 4, millimetres: 60 },
];
const KINDS = ["objects", "sheet", "boxes", "room"];

function print(rows) {
  const kinds = [...new Set(rows.map(({ kind }) => kind)), "all"];
  const frames = [...new Set(rows.map((row) => row.frames))];
  const among = (kind, count) => rows.filter((row) => (kind === "all" || row.kind === kind) && row.frames === count);
  const of = (kind, count, error) => among(kind, count).filter((row) => row.error.degrees === error.degrees);
  console.log(
    "The estimate of calibrations that are off, against the truth; of right ones: whether their error lies in the 95 % interval,",
  );
  console.log("whether the truth lies within 95 % of the distribution, and what is said of them.");
  console.log(
    "kind     frames  rigs  degrees, mm: median   90 %          interval  distribution  consistent  undecided  off",
  );
  for (const kind of kinds) {
    for (const count of frames) {
      const right = of(kind, count, ERRORS[0]);
      const wrong = among(kind, count).filter((row) => row.error.degrees > 0);
      const at = (part) =>
        `${quantile(
          wrong.map((row) => row.degrees),
          part,
        ).toFixed(2)}, ${quantile(
          wrong.map((row) => row.millimetres),
          part,
        ).toFixed(1)}`.padEnd(13);
      const share = (is) => percent(right.filter(is).length, right.length).padStart(6);
      const inside = share(({ own, interval }) => own >= interval[0] && own <= interval[1]);
      const within = share(({ probability }) => probability >= 0.05);
      const said = ["consistent", "undecided", "off"].map((verdict) => share((row) => row.verdict === verdict));
      console.log(
        `${kind.padEnd(8)} ${String(count).padEnd(6)} ${String(wrong.length).padStart(5)}  ${at(0.5)}         ${at(0.9)} ${inside}    ${within}        ${said[0]}     ${said[1]}  ${said[2]}`,
      );
    }
  }
  console.log(
    "\nShare of calibrations that are off by so much: said to be off; found by the lower bound of their interval at 5 % false alarms (and at 1 %).",
  );
  console.log(
    `kind     frames  ${ERRORS.slice(1)
      .map(({ degrees, millimetres }) => `${degrees} deg, ${millimetres} mm`.padEnd(22))
      .join("")}`,
  );
  for (const kind of kinds) {
    for (const count of frames) {
      const bounds = of(kind, count, ERRORS[0]).map((row) => row.bounds[0]);
      const cells = ERRORS.slice(1).map((error) => {
        const some = of(kind, count, error);
        const said = percent(some.filter((row) => row.verdict === "off").length, some.length);
        const [five, one] = [0.95, 0.99].map((part) =>
          percent(some.filter((row) => row.bounds[0] > quantile(bounds, part)).length, some.length),
        );
        return `${said}; ${five} (${one})`.padEnd(22);
      });
      console.log(`${kind.padEnd(8)} ${String(count).padEnd(6)}  ${cells.join("")}`);
    }
  }
}

/** Rigs of all kinds in turn, one frame each. */
async function rendered(sampleRig, count, { from, step }) {
  const rigs = [];
  for (let k = 0; k < count; k++) {
    const [kind, seed] = [KINDS[k % KINDS.length], from + step * k];
    const { pose, ...frame } = await sampleRig({ kind, seed });
    rigs.push({ name: `${kind} ${seed}`, frames: [frame], pose });
  }
  return rigs;
}

async function confusions({ checkCalibration: check, sampleRig }, { names, counts, seeds, json }) {
  const start = performance.now();
  const options = { check, progress: (name) => say(`${name} (${seconds(start)})`) };
  const own = hasData() ? [nyuRig(await import(inRoot("pkg/files.js")))] : [];
  const rows = await confused([...(await rendered(sampleRig, counts.rigs, seeds)), ...own], names, options);
  printConfused(rows);
  const told = await right(await rendered(sampleRig, counts.right, seeds), options);
  printRight(told);
  const off = await merelyOff(await rendered(sampleRig, counts.off, seeds), options);
  printOff(off);
  if (json) writeFileSync(json, `${JSON.stringify([...rows, ...told, ...off], null, 1)}\n`);
}

/** The names of the confusions that the option `only` selects. */
function selected(only) {
  const names = only?.split(",") ?? Object.keys(CONFUSIONS);
  const unclear = names.find((name) => !(name in CONFUSIONS));
  if (unclear !== undefined)
    throw new Failure(`There is no confusion "${unclear}"; there are ${Object.keys(CONFUSIONS).join(", ")}.`);
  return names;
}

await script(async () => {
  const { values } = parseArgs({
    options: {
      rigs: { type: "string", default: "5" },
      from: { type: "string", default: "100" },
      frames: { type: "string", default: "1,3" },
      kinds: { type: "string", default: KINDS.join(",") },
      keep: { type: "string", default: "1" },
      rings: { type: "string" },
      json: { type: "string" },
      confusions: { type: "boolean", default: false },
      only: { type: "string" },
      right: { type: "string", default: "40" },
      off: { type: "string", default: "40" },
      step: { type: "string", default: "2" },
      next: { type: "boolean", default: false },
    },
  });
  const [rigs, from] = [values.rigs, values.from].map(Number);
  const kinds = values.kinds.split(",");
  const counts = values.frames.split(",").map(Number);
  if (!(rigs >= 1) || !Number.isInteger(from) || counts.some((count) => !(count >= 1)))
    throw new Failure("--rigs, --from and --frames take whole numbers.");
  const [keep, rings] = [Number(values.keep), values.rings === undefined ? Infinity : Number(values.rings)];
  if (!(keep > 0 && keep <= 1) || !(rings >= 2))
    throw new Failure("--keep takes a share up to 1, --rings a number from 2.");
  const unknown = kinds.find((kind) => !KINDS.includes(kind));
  if (unknown !== undefined) throw new Failure(`There is no kind "${unknown}"; there are ${KINDS.join(", ")}.`);
  const names = selected(values.only);
  if (!process.env.NO_BUILD) await build();
  const { checkCalibration, sampleRig } = await import(inRoot("pkg/index.js"));
  if (values.confusions) {
    const named = { rigs, right: Number(values.right), off: Number(values.off) };
    const seeds = { from, step: Number(values.step) };
    return confusions({ checkCalibration, sampleRig }, { names, counts: named, seeds, json: values.json });
  }
  const start = performance.now();
  const rows = [];
  if (values.next) {
    for (const kind of kinds)
      for (let seed = from; seed < from + rigs; seed++) {
        rows.push(await proposed({ checkCalibration, sampleRig }, { kind, seed }));
        say(`${kind} ${seed - from + 1} of ${rigs} (${seconds(start)})`);
      }
    printProposed(rows);
    if (values.json) writeFileSync(values.json, `${JSON.stringify(rows, null, 1)}\n`);
    return;
  }
  for (const kind of kinds) {
    for (let seed = from; seed < from + rigs; seed++) {
      const all = [];
      for (let frame = 0; frame < Math.max(...counts); frame++)
        all.push(thinned(await sampleRig({ kind, seed, frame }), { keep, rings }));
      const truth = all[0].pose;
      for (const frames of counts) {
        // The right candidate, and a wrong one whose size varies with the seed.
        for (const index of [0, 1 + (seed % (ERRORS.length - 1))]) {
          const error = ERRORS[index];
          const told = wrong(truth, error, chance(1000 * seed + 10 * index + KINDS.indexOf(kind)).direction);
          const report = await checkCalibration(all.slice(0, frames), { told });
          const d = offset(report.estimate, truth, report.middle);
          rows.push({
            kind,
            seed,
            frames,
            error,
            verdict: report.candidates.told.verdict,
            probability: report.candidates.told.probability,
            interval: report.health.interval,
            bounds: report.candidates.told.interval,
            // Mean squares add up, so for a right candidate the difference is the estimate's own error, pixels.
            own: Math.sqrt(Math.max(0, report.candidates.told.pixels ** 2 - report.health.pixels ** 2)),
            ...sizes(d),
            pixels: report.health.pixels,
          });
        }
      }
      say(`${kind} ${seed - from + 1} of ${rigs} (${seconds(start)})`);
    }
  }
  print(rows);
  if (values.json) writeFileSync(values.json, `${JSON.stringify(rows, null, 1)}\n`);
});
