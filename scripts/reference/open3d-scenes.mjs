// node scripts/reference/open3d-scenes.mjs FOLDER: the scenes of Table 2B as clouds, for open3d.py.
//
// For each scene `N.image.f32` (x y z and normal of the surface from shading: light known, one normal for each pixel, independent of
// the pose) and `N.depth.f32` (x y z of the depth map), float32, and in `scenes.json` their names and the rotation to find.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import init, { Estimator, sample } from "../../pkg/index.js";
import * as files from "../../pkg/files.js";
import { hasData, library } from "../tables/library.mjs";
import { table2B } from "../../protocols/poses.mjs";
import { kit, requestOf } from "../../protocols/scenes.mjs";

const [, , folder] = process.argv;
if (!folder || !hasData()) throw new Error("needs a folder to write to, and the data beside the project");

/** The exposure settles in the first two steps; without a prior and with a fixed pose nothing changes after that. */
const STEPS = 3;

/** Pixels of a view in coordinates of the frame. */
const place = ({ width, height }, index) => [
  (index % width) - (width - 1) / 2,
  Math.floor(index / width) - (height - 1) / 2,
];

function surfaceFromShading({ image, depth, light }) {
  // The loop needs a pose: the identity, fixed. With the weight of the prior at zero, neither the pose nor the depth has any effect.
  const options = { light, start: "identity", scale: 1, registration: "fixed", shading: "pixel", lambda: { prior: 0 } };
  const estimator = new Estimator(image, depth, options);
  for (let step = 0; step < STEPS && estimator.report.status === "running"; step++) estimator.step();
  const [heights, normals] = [estimator.imageDepth(), estimator.imageNormals()];
  estimator.free();
  return [...heights.keys()]
    .filter((index) => Number.isFinite(heights[index]) && Number.isFinite(normals[3 * index]))
    .flatMap((index) => [...place(image, index), heights[index], ...normals.subarray(3 * index, 3 * index + 3)]);
}

const cloud = (depth) =>
  [...depth.data.keys()]
    .filter((index) => depth.data[index] > 0)
    .flatMap((index) => [...place(depth, index), depth.data[index]]);

await init();
const data = library(files);
// If the light is unknown, there is no surface to register to.
const known = table2B.cells(kit(true), false).filter(({ row }) => row.light === "known");
const scenes = known.map((cell, index) => {
  const made = sample(requestOf(cell.scene, data));
  writeFileSync(join(folder, `${index}.image.f32`), Float32Array.from(surfaceFromShading(made)));
  writeFileSync(join(folder, `${index}.depth.f32`), Float32Array.from(cloud(made.depth)));
  const { beta, overlap, size, lightName } = cell.row;
  return { beta, overlap, size, light: lightName, rotation: made.pose.rotation };
});
writeFileSync(join(folder, "scenes.json"), JSON.stringify(scenes));
