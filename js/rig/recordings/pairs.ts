/**
 * Takes pairs of a colour image and a depth map from a recording, in three steps. Moments are spread evenly over the recording, each with
 * the pair whose stamps are nearest. Those at which the rig moves least are kept, since two cameras are seldom exposed at the same time. Of
 * these, the ones that differ most are taken.
 */
import { breathe } from "../../breathe.js";
import { BimodalError } from "../../errors.js";
import type { CheckFrame } from "../types.js";
import { type ReaderWarning, warning } from "../warnings.js";
import { type Turn, turnOf } from "./axes.js";
import { type Signature, changeOf, different, lightOf, signatureOf } from "./signature.js";
import type { Content, Shot, Source } from "./source.js";

/** Moments that are examined for each frame that is wanted. */
const PER_FRAME = 4;
/** Length of a moment, in periods of the slower topic. */
const REACH = 2.5;
/** Most seconds between the stamps of a pair without a warning; the limit of TUM's tool. */
const APART = 0.02;
/** Most seconds by which the delays of two topics may differ if one clock has set their stamps. */
const CLOCKS = 10;

export interface Pair {
  colour: Shot;
  depth: Shot;
  /** Seconds between them. */
  apart: number;
  /** The next colour image. */
  after?: Shot;
}

/** Whether stamps of two topics are missing, or come from two clocks. */
const areOfTwoClocks = (a: Shot, b: Shot): boolean =>
  a.taken === undefined || b.taken === undefined || Math.abs(a.taken - b.taken - (a.logged - b.logged)) > CLOCKS;

function withNext(pair: Pair, colours: readonly Shot[]): Pair {
  const after = colours.find(({ logged }) => logged > pair.colour.logged);
  return after ? { ...pair, after } : pair;
}

/** The pair whose times are nearest. */
export function nearest(colours: readonly Shot[], depths: readonly Shot[]): Pair | undefined {
  const [colour, depth] = [colours[0], depths[0]];
  if (!colour || !depth) return undefined;
  const byLog = areOfTwoClocks(colour, depth);
  const timeOf = ({ taken, logged }: Shot) => (byLog ? logged : (taken ?? logged));
  let best: Pair | undefined;
  for (const a of colours)
    for (const b of depths) {
      const apart = Math.abs(timeOf(a) - timeOf(b));
      if (best === undefined || apart < best.apart) best = { colour: a, depth: b, apart };
    }
  return best && withNext(best, colours);
}

async function pairWithin(source: Source, roles: Wanted, from: number, until: number): Promise<Pair | undefined> {
  const shots: Shot[] = [];
  for await (const shot of source.shots([roles.colour, roles.depth], from, until)) shots.push(shot);
  return nearest(
    shots.filter(({ track }) => track === roles.colour),
    shots.filter(({ track }) => track === roles.depth),
  );
}

export interface Wanted {
  colour: string;
  depth: string;
  /** Metres per stored unit of depth. */
  unit?: number;
  frames: number;
  signal?: AbortSignal;
  onProgress?: (share: number) => void;
}

/** A pair, decoded. */
export interface Moment {
  pair: Pair;
  /** The rotation by which the points of the cloud were turned. */
  turn?: Turn;
  image: Extract<Content, { kind: "colour" }>;
  map: Extract<Content, { kind: "depth" }>;
}

/** The rotation that turns a cloud so that z is depth; undefined if it need not be turned. */
export async function turnBetween(source: Pick<Source, "poses">, { colour, depth }: Pair): Promise<Turn | undefined> {
  if (depth.encoding !== "points") return undefined;
  const [found] = (await source.poses(depth, colour)).found;
  return found && turnOf(found.pose.rotation);
}

export async function decoded(pair: Pair, unit?: number, turn?: Turn): Promise<Moment> {
  const image = await pair.colour.read({ as: "colour" });
  const map = await pair.depth.read({ as: "depth", ...(unit !== undefined && { unit }), ...(turn && { turn }) });
  if (image.kind !== "colour" || map.kind !== "depth")
    throw new Error("A shot was decoded as a kind that was not requested.");
  return { pair, image, map, ...(turn && { turn }) };
}

/** A moment that can be read again: its pixels are not kept. */
interface Candidate {
  again(): Promise<Pair | undefined>;
}

/** Each shot of the slower topic with the nearest one of the other topic, for short recordings, which are read at once. */
async function allPairs(source: Source, { colour, depth }: Wanted): Promise<Pair[]> {
  const shots: Shot[] = [];
  for await (const shot of source.shots([colour, depth], ...source.span)) shots.push(shot);
  const [colours, depths] = [colour, depth].map((name) => shots.filter(({ track }) => track === name));
  if (!colours || !depths) return [];
  const found =
    colours.length < depths.length
      ? colours.map((shot) => nearest([shot], depths))
      : depths.map((shot) => nearest(colours, [shot]));
  return found.filter((pair) => pair !== undefined).map((pair) => withNext(pair, colours));
}

async function candidates(source: Source, wanted: Wanted): Promise<Candidate[]> {
  const counts = [wanted.colour, wanted.depth].map(
    (name) => source.tracks.find((track) => track.name === name)?.count ?? 0,
  );
  const count = PER_FRAME * wanted.frames;
  if (Math.max(...counts) <= 2 * count)
    return (await allPairs(source, wanted)).map((pair) => ({ again: async () => pair }));
  const [from, until] = source.span;
  const reach = (REACH * (until - from)) / Math.max(1, Math.min(...counts) - 1);
  return Array.from({ length: count }, (_, index) => {
    const start = from + ((until - reach - from) * index) / (count - 1);
    return { again: () => pairWithin(source, wanted, start, start + reach) };
  });
}

/** Change of the image per second. */
async function unrest({ colour, after }: Pair, { light }: Signature): Promise<number> {
  const next = await after?.read({ as: "colour" });
  if (after === undefined || next?.kind !== "colour") return 0;
  return changeOf(light, lightOf(next.image)) / Math.max(1e-3, after.logged - colour.logged);
}

interface Seen {
  candidate: Candidate;
  signature: Signature;
  /** Change per second; zero if there are no more moments than requested frames. */
  unrest: number;
}

/** The half of the moments at which the rig moves least, but at least as many as requested. */
function restful(seen: readonly Seen[], wanted: number): Seen[] {
  const kept = Math.max(wanted, Math.ceil(seen.length / 2));
  const limit = seen.map(({ unrest }) => unrest).sort((a, b) => a - b)[kept - 1] ?? Infinity;
  return seen.filter(({ unrest }) => unrest <= limit);
}

/** Moments that differ, decoded, with warnings. */
export async function moments(
  source: Source,
  wanted: Wanted,
): Promise<{ moments: Moment[]; warnings: ReaderWarning[] }> {
  const seen: Seen[] = [];
  let failure: unknown;
  let turn: Turn | undefined;
  const all = await candidates(source, wanted);
  for (const [index, candidate] of all.entries()) {
    await breathe();
    wanted.signal?.throwIfAborted();
    wanted.onProgress?.(index / all.length);
    const pair = await candidate.again();
    if (pair === undefined) continue;
    try {
      turn ??= await turnBetween(source, pair);
      const moment = await decoded(pair, wanted.unit, turn);
      const signature = signatureOf(moment.image.image, moment.map.depth);
      seen.push({ candidate, signature, unrest: all.length > wanted.frames ? await unrest(pair, signature) : 0 });
    } catch (error) {
      if (!(error instanceof BimodalError)) throw error;
      failure ??= error;
    }
  }
  if (seen.length === 0 && failure !== undefined) throw failure;
  const found: Moment[] = [];
  const still = restful(seen, wanted.frames);
  const signatures = still.map(({ signature }) => signature);
  for (const index of different(signatures, wanted.frames)) {
    const pair = await still[index]?.candidate.again();
    if (pair) found.push(await decoded(pair, wanted.unit, turn));
  }
  return { moments: found, warnings: judged(found, seen.length, wanted.frames) };
}

/** The warnings about the chosen moments: their times, their clocks, and how few of the examined moments differ. */
export function judged(found: readonly Moment[], seen = found.length, wanted = found.length): ReaderWarning[] {
  const warnings: ReaderWarning[] = [];
  const apart = Math.max(0, ...found.map(({ pair }) => pair.apart));
  if (apart > APART)
    warnings.push(
      warning(
        "times-apart",
        `Colour images and depth maps are up to ${(1000 * apart).toFixed(0)} ms apart: if the rig or the scene moved, they show different scenes. Record while both stand still.`,
        { seconds: apart },
      ),
    );
  const [first] = found;
  if (first && areOfTwoClocks(first.pair.colour, first.pair.depth))
    warnings.push(
      warning(
        "clocks-differ",
        "The stamps of colour and depth are missing or come from two clocks: images were paired by the time of recording, which may be later than the exposure.",
      ),
    );
  if (found.length > 0 && found.length < Math.min(wanted, seen))
    warnings.push(
      warning(
        "frames-alike",
        `Only ${found.length} of ${seen} moments differ: the view hardly changes, and several images of one view carry no more information than one. Move the rig or the scene.`,
        { frames: found.length, seen },
      ),
    );
  return warnings;
}

/** A moment as a frame of the check. */
export function frameOf({ image, map, pair }: Moment, start: number): CheckFrame {
  return {
    name: `${(pair.colour.logged - start).toFixed(2)} s`,
    image: image.image,
    depth: map.depth,
  };
}
