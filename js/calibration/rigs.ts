/** Rendered rigs and pairs with a known answer, and suggested masks, in a separate .wasm file that neither a run nor a check loads. */
import start, { Segmentation, samplePair, sampleRig } from "../../target/rigs/wasm-bindgen/bimodal_stereo_rigs.js";
import { across, compile, lazily } from "../border.js";
import { breathe } from "../breathe.js";
import { checkedPose, twelve } from "./check.js";
import { array, callback, object, ranged, signal as abortSignal, side, word } from "../check.js";
import type {
  ColorImage,
  MaskSuggestion,
  PairKind,
  PairSample,
  RigRequest,
  RigSample,
  SuggestOptions,
} from "../types/index.js";

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
    motion: () => {},
  },
  ["kind"],
);

export async function render(request: RigRequest): Promise<RigSample> {
  rigRequest(request, "request");
  await load();
  const { kind, seed = 0, frame = 0, noise, motion } = request;
  const moved = motion === undefined ? undefined : Float64Array.from(twelve(checkedPose(motion, "request.motion")));
  return across(() => sampleRig(kind, seed, frame, noise, moved));
}

const pairKind = word("bust", "knot", "marble", "relief", "cut", "bowl");

export async function pair(kind: PairKind): Promise<PairSample> {
  pairKind(kind, "kind");
  await load();
  return across(() => samplePair(kind));
}

const picture = object({ width: side, height: side, data: array(Uint8Array, Uint8ClampedArray) }, [
  "width",
  "height",
  "data",
]);
const options = object({ signal: abortSignal, onProgress: callback });

/** Events are handled between rounds, so that the suggestion can be cancelled. */
async function rounds(found: Segmentation, { signal, onProgress }: SuggestOptions): Promise<MaskSuggestion> {
  for (;;) {
    signal?.throwIfAborted();
    const [round = 0, changed = 0, share = 0, isLast] = across(() => found.step());
    onProgress?.(changed, round);
    if (isLast) return { mask: across(() => found.mask()), share, rounds: round, changed };
    await breathe();
  }
}

type Picture = Pick<ColorImage, "width" | "height" | "data">;

export async function suggest(image: Picture, marks: Uint8Array, given: SuggestOptions): Promise<MaskSuggestion> {
  // An image may have other members, such as a camera. A missing image has no members, which the check reports.
  const { width, height, data } = (image ?? {}) as Picture;
  picture({ width, height, data }, "image");
  array(Uint8Array)(marks, "marks");
  options(given, "options");
  await load();
  const bytes = data as Uint8Array;
  const found = across(
    () => new Segmentation(width, height, new Uint8Array(bytes.buffer, bytes.byteOffset, bytes.length), marks),
  );
  try {
    return await rounds(found, given);
  } finally {
    found.free();
  }
}
