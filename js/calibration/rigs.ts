/** Rendered rigs with a known answer, in a separate .wasm file that a check does not load. */
import start, { sampleRig } from "../../target/rigs/wasm-bindgen/bimodal_stereo_rigs.js";
import { across, compile, lazily } from "../border.js";
import { object, ranged, word } from "../check.js";
import type { RigRequest, RigSample } from "../types/index.js";

// Written as one expression, because bundlers look for exactly this form to include the file.
const load = lazily("sampleRig", async () =>
  start({ module_or_path: await compile(() => new URL("./bimodal_stereo_rigs_bg.wasm", import.meta.url)) }),
);

const rigRequest = object(
  {
    kind: word("objects", "sheet", "boxes", "room"),
    seed: ranged({ kind: "whole", min: 0 }),
    frame: ranged({ kind: "whole", min: 0, max: 2 ** 31 }),
    noise: ranged({ kind: "number", min: 0 }),
  },
  ["kind"],
);

export async function render(request: RigRequest): Promise<RigSample> {
  rigRequest(request, "request");
  await load();
  const { kind, seed = 0, frame = 0, noise } = request;
  return across(() => sampleRig(kind, seed, frame, noise));
}
