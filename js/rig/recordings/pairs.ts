/**
 * Pairs of a colour image and a depth map of one moment out of a recording: moments evenly spread over it, at each the pair whose stamps are
 * nearest; of those the ones at which the rig moves least, since two cameras are seldom exposed at once; and of these the ones that differ.
 */
import { breathe } from "../../breathe.js";
import { BimodalError } from "../../errors.js";
import type { CheckFrame } from "../types.js";
import { type ReaderWarning, warning } from "../warnings.js";
import { type Turn, turnOf } from "./axes.js";
import { type Signature, changeOf, different, signatureOf } from "./signature.js";
import type { Content, Shot, Source } from "./source.js";

/** Moments that are looked at for each frame that is wanted. */
const PER_FRAME = 4;
/** Messages of the slower topic that a moment reaches over. */
const REACH = 2.5;
/** Stamps farther apart than this, in seconds, are no moment; TUM's own tool has the same. */
const APART = 0.02;
/** Stamps of one machine; farther apart, in seconds, two clocks have set them. */
const CLOCKS = 10;

export interface Pair {
  colour: Shot;
  depth: Shot;
  /** Seconds between them. */
  apart: number;
  /** The colour image after this one. */
  after?: Shot;
}

/** When a shot was taken, as far as its own clock can be compared with the other's. */
export const timeOf = (shot: Shot, byLog: boolean): number => (byLog || shot.taken === 0 ? shot.logged : shot.taken);

/** Whether two topics' stamps are of clocks that have nothing to do with each other, or missing. */
export const areApart = (a: Shot, b: Shot): boolean =>
  a.taken === 0 || b.taken === 0 || Math.abs(a.taken - b.taken - (a.logged - b.logged)) > CLOCKS;

function withNext(pair: Pair, colours: readonly Shot[]): Pair {
  const after = colours.find(({ logged }) => logged > pair.colour.logged);
  return after ? { ...pair, after } : pair;
}

/** The pair whose times are nearest. */
export function nearest(colours: readonly Shot[], depths: readonly Shot[]): Pair | undefined {
  const [colour, depth] = [colours[0], depths[0]];
  if (!colour || !depth) return undefined;
  const byLog = areApart(colour, depth);
  let best: Pair | undefined;
  for (const a of colours)
    for (const b of depths) {
      const apart = Math.abs(timeOf(a, byLog) - timeOf(b, byLog));
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

/** Both decoded. */
export interface Moment {
  pair: Pair;
  /** By which the cloud's points were turned. */
  turn?: Turn;
  image: Extract<Content, { kind: "colour" }>;
  map: Extract<Content, { kind: "depth" }>;
}

/** How a pair's cloud has to be turned, so that z is depth. */
export async function turnBetween(source: Pick<Source, "poses">, { colour, depth }: Pair): Promise<Turn | undefined> {
  if (depth.encoding !== "points") return undefined;
  const [found] = (await source.poses(depth, colour)).found;
  return found && turnOf(found.pose.rotation);
}

export async function decoded(pair: Pair, unit?: number, turn?: Turn): Promise<Moment> {
  const image = await pair.colour.read({ as: "colour" });
  const map = await pair.depth.read({ as: "depth", ...(unit !== undefined && { unit }), ...(turn && { turn }) });
  if (image.kind !== "colour" || map.kind !== "depth")
    throw new Error("A reading is of another kind than was asked for.");
  return { pair, image, map, ...(turn && { turn }) };
}

/** A moment that was looked at, and how to have it again: what was read is not kept. */
interface Candidate {
  again(): Promise<Pair | undefined>;
}

/** Each shot of the slower topic with the nearest of the other one: of short recordings, which are read at once. */
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

/** How much the picture changes in a second. */
async function unrest({ pair: { colour, after }, image }: Moment): Promise<number> {
  const next = await after?.read({ as: "colour" });
  if (after === undefined || next?.kind !== "colour") return 0;
  return changeOf(image.image, next.image) / Math.max(1e-3, after.logged - colour.logged);
}

interface Seen {
  candidate: Candidate;
  signature: Signature;
  /** Change in a second, where there are moments to choose from. */
  unrest: number;
}

/** The half at which the rig moves least, but as many as may be wanted. */
function restful(seen: readonly Seen[], wanted: number): Seen[] {
  const kept = Math.max(wanted, Math.ceil(seen.length / 2));
  const limit = seen.map(({ unrest }) => unrest).sort((a, b) => a - b)[kept - 1] ?? Infinity;
  return seen.filter(({ unrest }) => unrest <= limit);
}

/** Moments that differ, decoded, and what is doubtful about them. */
export async function moments(
  source: Source,
  wanted: Wanted,
): Promise<{ moments: Moment[]; warnings: ReaderWarning[] }> {
  const warnings: ReaderWarning[] = [];
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
      seen.push({ candidate, signature, unrest: all.length > wanted.frames ? await unrest(moment) : 0 });
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
  judge(found, seen.length, wanted.frames, warnings);
  return { moments: found, warnings };
}

export function judge(found: readonly Moment[], seen: number, wanted: number, warnings: ReaderWarning[]): void {
  const apart = Math.max(0, ...found.map(({ pair }) => pair.apart));
  if (apart > APART)
    warnings.push(
      warning(
        "times-apart",
        `Colour images and depth maps are up to ${(1000 * apart).toFixed(0)} ms apart: if the rig or the scene moved, they show different moments.`,
        { seconds: apart },
      ),
    );
  const [first] = found;
  if (first && areApart(first.pair.colour, first.pair.depth))
    warnings.push(
      warning(
        "clocks-differ",
        "The pictures have no stamps of one clock; they were paired by the time at which they were recorded, which may be later than they were taken.",
      ),
    );
  if (found.length > 0 && found.length < Math.min(wanted, seen))
    warnings.push(
      warning(
        "frames-alike",
        `Only ${found.length} of the ${seen} moments that were looked at differ: the view hardly changes, and pictures of one view tell no more than one.`,
        { frames: found.length, seen },
      ),
    );
}

/** A moment as a frame of the check. */
export function frameOf({ image, map, pair }: Moment, start: number): CheckFrame {
  return {
    name: `${(pair.colour.logged - start).toFixed(2)} s`,
    image: image.image,
    depth: map.depth,
  };
}
