// npm run rigs: how often the check of a calibration is right, on rendered rigs whose extrinsics are known.
//
// --rigs N     rigs of each kind (default 5), seeds from --from (default 100; seeds below 20 had a part in choosing constants)
// --frames K   frames of a rig (default 1 and 3)
// --kinds A,B  of objects, sheet, boxes, room
// --json FILE  one row for each check
import { writeFileSync } from "node:fs";
import { parseArgs } from "node:util";
import { build } from "./build.mjs";
import { CHI_SQUARE, chance, mahalanobis, offset, percent, quantile, sizes, wrong } from "./rigs/draws.mjs";
import { Failure, inRoot, say, script, seconds } from "./shell.mjs";

/** Candidates: degrees about a random axis through the colour camera, millimetres in a random direction. */
const ERRORS = [
  { degrees: 0, millimetres: 0 },
  { degrees: 0.5, millimetres: 5 },
  { degrees: 1, millimetres: 10 },
  { degrees: 2, millimetres: 20 },
  { degrees: 4, millimetres: 60 },
];
const KINDS = ["objects", "sheet", "boxes", "room"];

function print(rows) {
  console.log("kind     frames  off by          off  undecided  consistent  degrees, mm: median   90 %          within 95 %");
  const keys = [...new Set(rows.map(({ kind, frames, error }) => JSON.stringify([kind, frames, error])))];
  for (const key of keys) {
    const some = rows.filter(({ kind, frames, error }) => JSON.stringify([kind, frames, error]) === key);
    const [kind, frames, error] = JSON.parse(key);
    const share = (verdict) => percent(some.filter((row) => row.verdict === verdict).length, some.length).padStart(5);
    const [degrees, millimetres] = [some.map((row) => row.degrees), some.map((row) => row.millimetres)];
    const at = (part) => `${quantile(degrees, part).toFixed(2)}, ${quantile(millimetres, part).toFixed(1)}`.padEnd(13);
    const covered = percent(some.filter((row) => row.chiSquare < CHI_SQUARE).length, some.length);
    const off = `${error.degrees} deg, ${error.millimetres} mm`.padEnd(13);
    console.log(`${kind.padEnd(8)} ${String(frames).padEnd(6)}  ${off} ${share("off")}  ${share("undecided")}      ${share("consistent")}       ${at(0.5)}        ${at(0.9)} ${covered}`);
  }
}

await script(async () => {
  const { values } = parseArgs({
    options: {
      rigs: { type: "string", default: "5" },
      from: { type: "string", default: "100" },
      frames: { type: "string", default: "1,3" },
      kinds: { type: "string", default: KINDS.join(",") },
      json: { type: "string" },
    },
  });
  const [rigs, from] = [values.rigs, values.from].map(Number);
  const kinds = values.kinds.split(",");
  const counts = values.frames.split(",").map(Number);
  if (!(rigs >= 1) || !Number.isInteger(from) || counts.some((count) => !(count >= 1))) throw new Failure("--rigs, --from and --frames take whole numbers.");
  const unknown = kinds.find((kind) => !KINDS.includes(kind));
  if (unknown !== undefined) throw new Failure(`There is no kind "${unknown}"; there are ${KINDS.join(", ")}.`);
  await build();
  const { checkCalibration, sampleRig } = await import(inRoot("pkg/index.js"));
  const start = performance.now();
  const rows = [];
  for (const kind of kinds) {
    for (let seed = from; seed < from + rigs; seed++) {
      const all = [];
      for (let frame = 0; frame < Math.max(...counts); frame++) all.push(await sampleRig({ kind, seed, frame }));
      const truth = all[0].pose;
      for (const frames of counts) {
        for (const [index, error] of ERRORS.entries()) {
          const told = wrong(truth, error, chance(1000 * seed + 10 * index + KINDS.indexOf(kind)).direction);
          const report = await checkCalibration(all.slice(0, frames), { told });
          const d = offset(report.estimate, truth, report.middle);
          rows.push({
            kind,
            seed,
            frames,
            error,
            verdict: report.verdict,
            ...sizes(d),
            chiSquare: mahalanobis(report.covariance, d),
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
