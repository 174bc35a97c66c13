/**
 * The visitor's files, recognised by their contents: each is read by the package's readers of rig files in a separate thread, shown at
 * once, and put into its slot. Loaded with the first file.
 */

import type { ColorImage, DepthMap, ErrorDetails, Pinhole } from "../../pkg/index.js";
import { EngineError } from "../engine/engine";
import type { Read } from "../engine/protocol";
import type { Summary } from "../rig/protocol";
import { RigError, Session } from "../rig/session";
import { isFurther, sniffed } from "./kind";
import type { Value } from "./settings";
import type { Files, Slot } from "./storage";

/** What a file turned out to be. */
export interface Look {
  kind: Summary["kind"] | undefined;
  says: string;
  /** Why it could not be read here; the browser may still read it. */
  fault?: string;
  warnings: string[];
  /** Whether a picture is stored without colours. */
  isGrey?: boolean;
  width?: number;
  height?: number;
  cameras: Summary["cameras"];
  picture?: ImageBitmap;
}

/** Warnings that the Lab's own fields settle: it reads depths in stored numbers, and an object before nothing has holes around it. */
const SETTLED: ReadonlySet<string> = new Set(["unit-guessed", "units-differ", "depth-range", "many-holes"]);

/** Pixels of a preview's width. */
const PREVIEW = 192;

const session = new Session();
const looks = new WeakMap<File, Promise<Look>>();
let next = 1;

/** Looks at a file once. */
export function lookAt(file: File): Promise<Look> {
  const known = looks.get(file) ?? look(file);
  looks.set(file, known);
  return known;
}

async function look(file: File): Promise<Look> {
  const number = next++;
  try {
    // In stored numbers: what a unit would be, the Lab's own fields say.
    const read = await session.call("read", { file: number, name: file.name, blob: file, unit: 1 });
    const isPicture = read.kind !== "cameras" && read.kind !== "poses";
    const picture = isPicture ? await session.call("picture", { file: number, width: PREVIEW }) : undefined;
    void session.call("forget", { file: number });
    const { kind, width, height, cameras } = read;
    const warnings = read.warnings.filter(({ code }) => kind !== "depth" || !SETTLED.has(code));
    return {
      kind,
      says: inWords(read),
      warnings: warnings.map(({ message }) => message),
      isGrey: read.isGrey ?? false,
      cameras,
      ...(width && height ? { width, height } : {}),
      ...(picture ? { picture } : {}),
    };
  } catch (error) {
    const details = error instanceof RigError ? error.fault.details : undefined;
    return unread(file, details?.reason ?? (error instanceof Error ? error.message : String(error)), details);
  }
}

const PLACES = {
  colour: ["colour", "image"],
  depth: ["depth", "depth"],
  colourMask: ["mask", "image.mask"],
  depthMask: ["mask", "depth.mask"],
} as const;

/** The pixels of files that only these readers know. What is wrong with one is said of its slot. */
export async function pixelsOf(files: Files): Promise<Read> {
  const found: Read = {};
  for (const [slot, [as, field]] of Object.entries(PLACES) as [Slot, (typeof PLACES)[Slot]][]) {
    const file = files[slot];
    if (!file || !(await isFurther(file, slot === "colour"))) continue;
    const number = next++;
    try {
      // In stored numbers: the Lab's own fields say their unit, and its cameras.
      await session.call("read", { file: number, name: file.name, blob: file, as, unit: 1 });
      const reading = await session.call("reading", { file: number });
      if (reading.kind === "colour") found.colour = withoutCamera<ColorImage>(reading.image);
      else if (reading.kind === "depth") {
        const { unit: _, ...depth } = reading.depth;
        found.depth = withoutCamera<DepthMap>(depth);
      } else if (reading.kind === "mask" && (slot === "colourMask" || slot === "depthMask")) found[slot] = reading.mask;
    } catch (error) {
      if (!(error instanceof RigError)) throw error;
      throw new EngineError({ ...error.fault, field, fatal: false });
    } finally {
      void session.call("forget", { file: number });
    }
  }
  return found;
}

function withoutCamera<T>({ camera: _, ...rest }: Omit<T, "camera"> & { camera?: unknown }): T {
  return rest as T;
}

const short = (value: number): string => String(Number(value.toPrecision(3)));

const inWords = ({ kind, says, measured, width, height }: Summary): string =>
  kind === "depth" && measured
    ? `${width}x${height}, ${measured.stored}, ${(100 * measured.valid).toFixed(1)} % valid, stored numbers ${measured.range.map(short).join(" to ")}`
    : says;

/** What these readers do not take the Lab may still: larger pictures, which it scales down, and whatever else the browser decodes. */
async function unread(
  file: File,
  fault: string,
  { problem, width: wide, height: high }: ErrorDetails = {},
): Promise<Look> {
  const none = { warnings: [], cameras: [] };
  if (problem === "too-large") {
    const extent = wide && high ? `${wide}x${high}` : "";
    return { ...none, kind: await sniffed(file), says: [extent, "too large for a preview"].filter(Boolean).join(", ") };
  }
  const whole = problem === "picture" ? await createImageBitmap(file).catch(() => undefined) : undefined;
  if (!whole) return { ...none, kind: undefined, says: fault, fault };
  const { width, height } = whole;
  const picture = await createImageBitmap(whole, { resizeWidth: Math.min(PREVIEW, width), resizeQuality: "medium" });
  whole.close();
  return { ...none, kind: "colour", says: `${width}x${height}, read by the browser`, width, height, picture };
}

/** Where files go, and what is to be said of those that go nowhere. */
export interface Sorted {
  slots: Map<Slot, File>;
  settings: Record<string, Value>;
  remarks: { words: string; wrong: boolean }[];
}

const isDepthName = (name: string): boolean => /depth|dpt|\bir\b|infra|tof/i.test(name.replace(/[_.-]+/g, " "));
const isColourName = (name: string): boolean => /colou?r|rgb/i.test(name.replace(/[_.-]+/g, " "));

interface Seen {
  file: File;
  look: Look;
}

/** Of two pictures that claim the same place, the one that rather belongs into the other: by its name, or the grey one. */
function odd(pair: readonly [Seen, Seen], isOther: (name: string) => boolean): Seen {
  return pair.find(({ file }) => isOther(file.name)) ?? pair.find(({ look }) => look.isGrey) ?? pair[1];
}

/** One of each kind; `there` are the files that the slots already hold. */
export async function sorted(files: readonly File[], there: Files): Promise<Sorted> {
  const seen = await Promise.all(files.map(async (file): Promise<Seen> => ({ file, look: await lookAt(file) })));
  const of = (kind: Look["kind"]) => seen.filter(({ look }) => look.kind === kind);
  const result: Sorted = { slots: new Map(), settings: {}, remarks: [] };
  const say = (words: string, wrong = false) => result.remarks.push({ words, wrong });
  let [colours, depths] = [of("colour"), of("depth")];
  const [one, two] = colours.length > 0 ? colours : depths;
  if (one && two && depths.length === 0 && !there.depth) {
    const moved = odd([one, two], isDepthName);
    [colours, depths] = [colours.filter((each) => each !== moved), [moved]];
  } else if (one && two && colours.length === 0 && !there.colour) {
    const moved = odd([one, two], isColourName);
    [colours, depths] = [[moved], depths.filter((each) => each !== moved)];
  }
  for (const [slot, all] of [
    ["colour", colours],
    ["depth", depths],
  ] as const) {
    const [first, ...more] = all;
    if (first) result.slots.set(slot, first.file);
    for (const { file } of more)
      say(
        `${file.name} looks like a second ${slot === "colour" ? "colour image" : "depth map"}; the Lab uses only one.`,
      );
  }
  // A pair that comes whole is another one, to which the masks of the last do not belong.
  const isPair = result.slots.has("colour") && result.slots.has("depth");
  const after: Files = { ...(isPair ? {} : there), ...Object.fromEntries(result.slots) };
  const sizeOf = async (slot: "colour" | "depth") => {
    const file = after[slot];
    return file && (await lookAt(file));
  };
  const [colour, depth] = [await sizeOf("colour"), await sizeOf("depth")];
  const fits = (look: Pick<Look, "width" | "height">, other: Look | undefined) =>
    other !== undefined && look.width === other.width && look.height === other.height;
  for (const { file, look } of of("mask")) {
    const [isColours, isDepths] = [fits(look, colour), fits(look, depth)];
    const free = after.colourMask === undefined ? "colourMask" : "depthMask";
    const bySize = isColours === isDepths ? undefined : isColours ? "colourMask" : "depthMask";
    const slot = isDepthName(file.name) ? "depthMask" : isColourName(file.name) ? "colourMask" : (bySize ?? free);
    result.slots.set(slot, file);
    after[slot] = file;
  }
  if (of("mask").length > 0 && after.colourMask && after.depth && !after.depthMask) {
    say("The depth map has no mask. Add one if it shows more than the object.");
  }
  const cameras = of("cameras").flatMap(({ file, look }) =>
    look.cameras.map((camera) => ({ file: file.name, ...camera })),
  );
  addCameras(cameras, { colour, depth }, result);
  for (const { file } of of("poses"))
    say(
      `${file.name}: a pose. The Lab does not need one; to begin from it, enter its angles under Settings, Start, near.`,
    );
  for (const { file, look } of seen) if (look.kind === undefined) say(`${file.name}: ${look.says}`, true);
  return result;
}

type Side = "colour" | "depth";
type Given = Summary["cameras"][number] & { file: string };

/** By names, then by the size of the pictures; a single one that fits both is taken for both, as of pictures registered to each other. */
function addCameras(cameras: readonly Given[], sizes: Partial<Record<Side, Look | undefined>>, result: Sorted): void {
  const named = (isSide: (name: string) => boolean, isOther: (name: string) => boolean) =>
    cameras.find(
      ({ name = "", file }) =>
        (isSide(name) && !isOther(name)) || (cameras.length === 1 && isSide(file) && !isOther(file)),
    );
  const fits = ({ width, height }: Given, side: Side) =>
    width !== undefined && width === sizes[side]?.width && height === sizes[side]?.height;
  let [colour, depth] = [named(isColourName, isDepthName), named(isDepthName, isColourName)];
  const free = () => cameras.filter((each) => each !== colour && each !== depth);
  colour ??= free().find((each) => fits(each, "colour") && !fits(each, "depth"));
  depth ??= free().find((each) => fits(each, "depth") && !fits(each, "colour"));
  const [only, ...others] = cameras;
  if (only && others.length === 0 && !colour && !depth) [colour, depth] = [only, only];
  colour ??= depth && cameras.length === 1 ? undefined : free()[0];
  depth ??= colour && cameras.length === 1 ? undefined : free()[0];
  for (const [side, given] of [
    ["colour", colour],
    ["depth", depth],
  ] as const) {
    if (!given) continue;
    Object.assign(result.settings, fieldsOf(side, given.camera));
    const shared = colour === depth ? ", used for both images" : "";
    result.remarks.push({
      words: `${given.file}: the ${side} camera${shared}. Its numbers are in the fields below; Undo removes them.`,
      wrong: false,
    });
  }
}

/** A file's camera in the Lab's fields. */
function fieldsOf(side: Side, { model, fx, fy, cx, cy, distortion = [] }: Pinhole): Record<string, Value> {
  const isBent = model === "fisheye" || Array.from(distortion).some((value) => value !== 0);
  return {
    [`${side}.fx`]: fx,
    [`${side}.fy`]: fy,
    [`${side}.cx`]: cx,
    [`${side}.cy`]: cy,
    [`${side}.model`]: model ?? "brown",
    [`${side}.distortion`]: isBent ? Array.from(distortion).join(" ") : "",
  };
}

/** A change of places that seems due, in words. */
export interface Offer {
  words: string;
  button: string;
  slots: Files;
}

const called: Readonly<Record<Slot, string>> = {
  colour: "Colour image",
  depth: "Depth map",
  colourMask: "Colour mask",
  depthMask: "Depth mask",
};
const sorts: Readonly<Record<string, string>> = { colour: "a colour image", depth: "a depth map", mask: "a mask" };

/** What of the files seems to be in the wrong place. */
export async function offerFor(files: Files): Promise<Offer | undefined> {
  const look = async (slot: Slot) => {
    const file = files[slot];
    return file && (await lookAt(file));
  };
  const [colour, depth, colourMask, depthMask] = await Promise.all([
    look("colour"),
    look("depth"),
    look("colourMask"),
    look("depthMask"),
  ]);
  const seems = (there: Look | undefined, kind: Look["kind"]) => there?.kind === kind;
  const isCoarse = seems(depth, "colour") && depth?.isGrey === true;
  // Of a grey picture and a coloured one the coloured one is no depth map, while the grey one may be.
  const isGrey = seems(colour, "colour") && colour?.isGrey === true;
  if (
    files.colour &&
    files.depth &&
    ((seems(colour, "depth") && !seems(depth, "depth")) ||
      (seems(depth, "colour") && !isCoarse && (!seems(colour, "colour") || isGrey)))
  ) {
    return {
      words: "Colour and depth seem to be swapped.",
      button: "Swap",
      slots: { ...files, colour: files.depth, depth: files.colour },
    };
  }
  // A mask may have soft edges, and a coarse depth map 8 bits of grey: that alone proves nothing.
  const wrong: [Slot, Look | undefined, boolean][] = [
    ["colour", colour, seems(colour, "depth") || seems(colour, "mask")],
    ["depth", depth, (seems(depth, "colour") && !isCoarse) || seems(depth, "mask")],
    ["colourMask", colourMask, seems(colourMask, "depth") || colourMask?.isGrey === false],
    ["depthMask", depthMask, seems(depthMask, "depth") || depthMask?.isGrey === false],
  ];
  for (const [slot, there, isWrong] of wrong) {
    const file = files[slot];
    if (!isWrong || !there?.kind || !file) continue;
    const words = `${file.name} looks like ${sorts[there.kind]} but is in the slot of the ${called[slot].toLowerCase()}.`;
    const masks: Slot[] = slot === "depth" ? ["depthMask", "colourMask"] : ["colourMask", "depthMask"];
    const targets: Slot[] = there.kind === "mask" ? masks : there.kind === "depth" ? ["depth"] : ["colour"];
    const to = targets.find((each) => files[each] === undefined);
    const { [slot]: _, ...rest } = files;
    if (to) return { words, button: `Move it to ${called[to]}`, slots: { ...rest, [to]: file } };
    return { words, button: "Remove", slots: rest };
  }
  return undefined;
}
