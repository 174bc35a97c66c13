// Starts the package in a separate thread with or without SIMD; reports the files that it reads and the result of its run.
import { promises } from "node:fs";
import { syncBuiltinESMExports } from "node:module";
import { basename } from "node:path";
import { parentPort, workerData } from "node:worker_threads";
import { chance } from "../../protocols/numbers.mjs";
import { paintSoftly } from "../../protocols/soft.mjs";

const { inNode, knowsSimd, request, albedoSeed } = workerData;

const read = promises.readFile;
const opened = [];
function noted(address) {
  opened.push(basename(address.pathname));
  return read(address);
}
promises.readFile = noted;
syncBuiltinESMExports();
if (!inNode) {
  process.getBuiltinModule = undefined;
  // Node's own fetch refuses files.
  globalThis.fetch = async (address) =>
    new Response(await noted(address), { headers: { "content-type": "application/wasm" } });
}
if (!knowsSimd) WebAssembly.validate = () => false;

const { default: init, Estimator, sample } = await import("../../pkg/index.js");
await init();
const { image, depth, pose: truth } = sample(request);
if (albedoSeed) paintSoftly(image.data, image.width, image.mask, chance(albedoSeed));
const estimator = new Estimator(image, depth);
const { status, pose, uncertainty } = await estimator.run();
estimator.free();
parentPort.postMessage({ opened: opened.filter((name) => name.endsWith(".wasm")), status, pose, uncertainty, truth });
