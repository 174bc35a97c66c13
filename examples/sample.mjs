// Writes files on which to try the commands: a colour image with a depth map, and three frames of a rig with its calibration.
//
// npm run build && node examples/sample.mjs FOLDER
import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import init, { sample, sampleRig } from "bimodal-stereo";
import { writePose } from "bimodal-stereo/rig-write";
import { writeNpy, writePng } from "bimodal-stereo/write";

const FRAMES = 3;

const folder = process.argv[2];
if (!folder || folder.startsWith("-")) {
  console.error("Usage: node examples/sample.mjs FOLDER");
  process.exit(3);
}
const file = (...names) => join(folder, ...names);
// Separate folders, because the command line uses camera files beside its pictures.
for (const name of ["pair", "rig/frames"]) mkdirSync(file(name), { recursive: true });

await init();
const { image, depth } = sample({ surface: "bust", light: "window", angles: { beta: 50 }, noise: 0.01 });
// A PNG of 16 bits holds linear intensities, of which only the ratios matter.
const brightest = image.data.reduce((most, value) => Math.max(most, value), 0);
const data = Uint16Array.from(image.data, (value) => (60_000 * value) / brightest);
writeFileSync(file("pair", "image.png"), await writePng({ ...image, channels: 3, data }));
writeFileSync(file("pair", "depth.npy"), writeNpy({ ...depth, channels: 1 }));

const frames = [];
for (let frame = 0; frame < FRAMES; frame += 1) frames.push(await sampleRig({ kind: "boxes", seed: 2, frame }));
for (const [k, { image, depth }] of frames.entries()) {
  writeFileSync(file("rig", "frames", `rgb_${k}.png`), await writePng(image));
  writeFileSync(file("rig", "frames", `depth_${k}.png`), await writePng(depth));
}
const [rig] = frames;
const size = ({ width, height }) => [width, height];
const sizes = { colour: size(rig.image), depth: size(rig.depth) };
const context = { colour: rig.image.camera, depth: rig.depth.camera, sizes };
writeFileSync(file("rig", "calibration.yaml"), writePose(rig.pose, "opencv", context).text);
console.log(`wrote ${file("pair")} and ${file("rig")}`);
