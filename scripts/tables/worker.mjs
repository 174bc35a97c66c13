// A separate process that runs cells one after the other, with one instance of the package.
//   WASM   a file to use instead of the package's own
import { pathToFileURL } from "node:url";
import { library } from "./library.mjs";
import { measure } from "../../protocols/measure.mjs";

const api = await import("../../pkg/index.js");
const [wasm] = process.argv.slice(2);
await api.default(wasm && pathToFileURL(wasm));
const data = library(await import("../../pkg/files.js"));

/** The members of an error that are kept. */
const failure = ({ name, code, message }) => ({ name, code, message });

process.on("message", async ({ cell }) => {
  const start = performance.now();
  let result;
  try {
    result = await measure(cell, api, data);
  } catch (error) {
    result = { failure: failure(error) };
  }
  process.send({ id: cell.id, result, took: performance.now() - start });
});
// Ctrl-C reaches every process of the terminal; the parent decides when to stop.
process.on("SIGINT", () => {});
process.on("disconnect", () => process.exit());
process.send({ ready: true });
