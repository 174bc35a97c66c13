// node by_wasm.mjs FOLDER: runs the package in pkg/ on the pair in FOLDER and writes the results next to it, one file for each output.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import init, { Estimator } from "../../pkg/index.js";

const KINDS = { u1: Uint8Array, u2: Uint16Array, f4: Float32Array };
const folder = process.argv[2];

/** A typed array with its own memory, because the file's memory may not be aligned. */
function read(name, kind) {
  const bytes = readFileSync(join(folder, name));
  return new KINDS[kind](bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length));
}
const member = ([name, value]) => [name, value?.file ? read(value.file, value.kind) : value];
const view = (members) => Object.fromEntries(Object.entries(members).map(member));

await init();
const { image, depth, options, steps } = JSON.parse(readFileSync(join(folder, "case.json"), "utf8"));
const estimator = new Estimator(view(image), view(depth), options);
const report = await estimator.run({ maxIterations: steps });
const arrays = ["imageNormals", "imageDepth", "depthNormals", "refinedDepth", "correspondence", "residual", "albedo", "shading", "light"];
for (const name of arrays) writeFileSync(join(folder, `${name}.out`), estimator[name]());
for (const name of ["image", "depth"]) writeFileSync(join(folder, `points-${name}.out`), estimator.points(name));
writeFileSync(join(folder, "report.json"), JSON.stringify(report));
