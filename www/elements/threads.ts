/**
 * Starts the threads of the elements and says where their .wasm is. A page may import modules from other origins but start workers only from
 * its own; a local worker that imports the thread satisfies both rules.
 */

import type { Places } from "../../pkg/elements.js";
import type { Loading } from "../learn/protocol";

let places: Places = {};

export function configure(given: Places): void {
  places = { ...places, ...given };
}

const absolute = (address: string | URL): string => new URL(address, document.baseURI).href;

/** The .wasm in a form that a thread receives, for which a relative address has another meaning; undefined if it is beside the thread. */
export function wasm(): Loading["wasm"] | undefined {
  const given = places.wasm;
  return typeof given === "string" || given instanceof URL ? absolute(given) : given;
}

function foreignWorker(address: string): Worker {
  const text = `import ${JSON.stringify(address)};`;
  const local = URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
  const worker = new Worker(local, { type: "module" });
  const forget = () => URL.revokeObjectURL(local);
  worker.addEventListener("message", forget, { once: true });
  worker.addEventListener("error", forget, { once: true });
  return worker;
}

/** Where the package is. Bundlers follow the address of a .wasm; webpack replaces that of the module by a path on its own machine. */
const beside = (name: string): URL => new URL(name, new URL("./bimodal_stereo_bg.wasm", import.meta.url));

function started(name: string, given: string | URL | undefined, own: () => Worker): Worker {
  const address = given === undefined ? beside(name) : new URL(absolute(given));
  if (address.origin !== location.origin) return foreignWorker(address.href);
  return given === undefined ? own() : new Worker(address, { type: "module" });
}

// Each address is written in one piece: bundlers look for exactly this form to include the file.
const ownStereo = () => new Worker(new URL("./elements-thread.js", import.meta.url), { type: "module" });
const ownFigure = () => new Worker(new URL("./figure-thread.js", import.meta.url), { type: "module" });

export const startStereo = (): Worker => started("elements-thread.js", places.stereoThread, ownStereo);

/** Replaces www/learn/thread.ts in the package. */
export function startThread(): Worker {
  const worker = started("figure-thread.js", places.figureThread, ownFigure);
  const source = wasm();
  if (source !== undefined) worker.postMessage({ wasm: source } satisfies Loading);
  return worker;
}
