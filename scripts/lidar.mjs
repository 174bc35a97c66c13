// npm run lidar [-- FOLDER ..]: converts LiDAR scans from the original files to range images, and checks the calibration that came with
// them.
//
// For each frame it prints how many points the camera sees, the share of them that the range image holds (aim: 99 %), the mean distance of
// a point to its pixel's ray in units of the sampling (the distance of neighbouring rays; aim: a half) and in units of a column. A FOLDER
// is one of KITTI's object detection (velodyne, image_2, calib), of OpenCalib or of nuScenes' samples, or holds such folders; without a
// FOLDER, those in ../shared/data are read.
//
// --json FILE  one row for each frame
// --ranks N also ranks N wrong candidates of each size, and by the costs of other tools (scripts/lidar/ranks.mjs) --draws N N more checks
// of each of three candidates, with the intensities and without them (scripts/lidar/draws.mjs)
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";
import { parseArgs } from "node:util";
import { build } from "./build.mjs";
import { drawn, printDrawn } from "./lidar/draws.mjs";
import { measured } from "./lidar/measures.mjs";
import { printRanked, ranked } from "./lidar/ranks.mjs";
import { framesBelow } from "./lidar/sources.mjs";
import { Failure, inRoot, say, script } from "./shell.mjs";

const DATA = "../shared/data";
const OTHERS = ["lidar_kitti", "lidar_opencalib", "lidar_nuscenes"];

const file = (path) => ({ name: basename(path), bytes: new Uint8Array(readFileSync(path)) });
const percent = (share) => `${(100 * share).toFixed(2)} %`;

/** Takes one frame from its files to a verdict. */
async function tried(frame, { rangeImage, readRigFile, checkCalibration }, { draws, ranks }) {
  const { scan, warnings } = await readRigFile(file(frame.scan), { as: "depth" });
  if (scan === undefined) throw new Failure(`${frame.scan} holds no points in no rows and columns.`);
  const { image } = await readRigFile(file(frame.picture), { as: "colour" });
  const { width, height } = image;
  const view = { rotation: frame.rotation, translation: frame.translation, camera: frame.camera, width, height };
  const range = await rangeImage(scan, view);
  const { width: columns, height: rows, points, intensity } = range;
  const depth = { width: columns, height: rows, points, ...(intensity && { intensity }) };
  const given = { rotation: frame.rotation, translation: frame.translation };
  const { verdict, candidates } = await checkCalibration([{ image: { ...image, camera: frame.camera }, depth }], {
    given,
  });
  const { offDegrees, offMillimetres, pixels, interval } = candidates.given;
  return {
    name: frame.name,
    how: range.how,
    size: [columns, rows],
    ...measured(scan, view, range),
    check: { verdict, offDegrees, offMillimetres, pixels, interval },
    warnings: warnings.map(({ code }) => code),
    draws: await drawn(checkCalibration, { frame, image, range }, draws),
    ranks: await ranked(checkCalibration, { frame, image, range }, ranks),
  };
}

function print({ name, how, size, count, kept, distance, ofSampling, ofColumn, filled, check, warnings }) {
  say(`${name}: ${size.join("x")} by ${how}, ${percent(filled)} filled (${warnings.join(", ")})`);
  say(
    `  ${count} points in view, ${percent(kept)} kept; ${(1000 * distance).toFixed(1)} mm from their rays, ${ofSampling.toFixed(2)} of the sampling, ${ofColumn.toFixed(2)} of a column`,
  );
  const { verdict, offDegrees, offMillimetres, pixels, interval } = check;
  say(
    `  given calibration: ${verdict}; estimate ${offDegrees.toFixed(2)} degrees and ${offMillimetres.toFixed(0)} mm away, ${pixels.toFixed(1)} px (${interval.map((value) => value.toFixed(1)).join(" to ")})`,
  );
}

await script(async () => {
  const text = { type: "string" };
  const count = { ...text, default: "0" };
  const options = { json: text, draws: count, ranks: count };
  const { values, positionals } = parseArgs({ options, allowPositionals: true });
  const counts = { draws: Number(values.draws), ranks: Number(values.ranks) };
  for (const [name, value] of Object.entries(counts))
    if (!(Number.isInteger(value) && value >= 0)) throw new Failure(`--${name} takes a whole number.`);
  const folders = positionals.length > 0 ? positionals : OTHERS.map((name) => inRoot(join(DATA, name)));
  await build();
  const [rig, index] = [await import(inRoot("pkg/rig.js")), await import(inRoot("pkg/index.js"))];
  const rows = [];
  for (const folder of folders) {
    if (!existsSync(folder)) {
      if (positionals.length > 0) throw new Failure(`There is no folder ${folder}.`);
      say(`Skipped: ${DATA}/${basename(folder)} is not there.`);
      continue;
    }
    const frames = framesBelow(folder);
    if (frames.length === 0)
      say(`${folder} holds no scan and picture with a calibration of KITTI, OpenCalib or nuScenes.`);
    for (const frame of frames) {
      const row = await tried({ ...frame, name: `${basename(folder)}/${frame.name}` }, { ...rig, ...index }, counts);
      rows.push(row);
      print(row);
    }
  }
  printRanked(rows.flatMap((row) => row.ranks));
  printDrawn(rows.flatMap((row) => row.draws));
  if (values.json) writeFileSync(values.json, `${JSON.stringify(rows, null, 1)}\n`);
});
