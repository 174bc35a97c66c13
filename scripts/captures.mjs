// npm run captures: checks calibrations of other people's captures, with the true pose hidden behind a known motion.
//
// --draws N    draws of each pair (default 20); of each small object a fifth as many, a tenth for its own calibration, and half as many
//              restarts
// --only A,B   of room, scenes, objects, truth, restarts
// --json FILE  one row for each check or candidate
// --folder DIR --calibration FILE   the draws of the room on your own rig, whose calibration is taken as true
import { writeFileSync } from "node:fs";
import { parseArgs } from "node:util";
import { build } from "./build.mjs";
import { folderOf } from "./captures/folder.mjs";
import {
  objects,
  printRanking,
  printScenes,
  printTold,
  printVerdicts,
  room,
  scenes,
  verdicts,
} from "./captures/sections.mjs";
import { capturesAnew, printTruths, truths } from "./captures/truth.mjs";
import { MISSING, hasData } from "./real-pairs.mjs";
import { printRestarts } from "./rigs/restarts.mjs";
import { Failure, inRoot, say, script, seconds } from "./shell.mjs";

const SECTIONS = {
  room: [room, (rows) => printVerdicts("nyu_raw_pair", rows)],
  scenes: [scenes, printScenes],
  objects: [
    objects,
    (rows) => [
      printRanking(rows.filter(({ part }) => part === "rank")),
      printTold(rows.filter(({ part }) => part === "told")),
    ],
  ],
  truth: [truths, printTruths],
  restarts: [capturesAnew, printRestarts],
};

await script(async () => {
  const text = { type: "string" };
  const { values } = parseArgs({
    options: { draws: { ...text, default: "20" }, only: text, json: text, folder: text, calibration: text },
  });
  const number = Number(values.draws);
  if (!(Number.isInteger(number) && number >= 1)) throw new Failure("--draws takes a whole number.");
  const names = values.only?.split(",") ?? Object.keys(SECTIONS);
  const unknown = names.find((name) => !(name in SECTIONS));
  if (unknown !== undefined)
    throw new Failure(`There is no part "${unknown}"; there are ${Object.keys(SECTIONS).join(", ")}.`);
  if ((values.folder === undefined) !== (values.calibration === undefined))
    throw new Failure("--folder and --calibration belong together.");
  if (values.folder === undefined && !hasData()) throw new Failure(`Nothing to do: ${MISSING}.`);
  await build();
  const { checkCalibration: check } = await import(inRoot("pkg/index.js"));
  const files = await import(inRoot("pkg/files.js"));
  const start = performance.now();
  const options = { check, files, number, progress: (message) => say(`${message} (${seconds(start)})`) };
  const all = [];
  const finish = (rows, print) => {
    print(rows);
    all.push(...rows);
  };
  if (values.folder !== undefined) {
    const frames = await folderOf(await import(inRoot("pkg/rig.js")), values.folder, values.calibration);
    finish(await verdicts(frames, options), (rows) => printVerdicts(values.folder, rows));
  } else {
    for (const name of names) {
      const [measure, print] = SECTIONS[name];
      finish(await measure(options), print);
    }
  }
  if (values.json) writeFileSync(values.json, `${JSON.stringify(all, null, 1)}\n`);
});
