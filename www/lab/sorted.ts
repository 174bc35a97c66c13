/** Sorts the visitor's files by their contents: their slots, the fields that they fill, and remarks about files without a slot. */

import type { GivenCamera } from "../rig/protocol";
import type { Remark } from "./intake";
import { type Look, type Seen, imageAmong, isDepthName, lookAt } from "./look";
import { type Settings, type Value, guess, isGuessed } from "./settings";
import type { Files, Slot } from "./storage";

export interface Sorted {
  slots: Map<Slot, File>;
  /** Whether the files hold both pictures. */
  isPair: boolean;
  /** Fields that the files fill, other than those of cameras. */
  fields: Record<string, Value>;
  cameras: GivenCamera[];
  remarks: Remark[];
}

const isColourName = (name: string): boolean => /colou?r|rgb/i.test(name.replace(/[_.-]+/g, " "));

/** Of two pictures that compete for one slot, returns the one for the other slot, by its name or else by its content. */
function odd(pair: readonly [Seen, Seen], isOther: (name: string) => boolean): Seen {
  const byContent = pair.find(({ look }) => look.isGrey) ?? imageAmong(pair);
  return pair.find(({ file }) => isOther(file.name)) ?? byContent ?? pair[1];
}

const ofKind = (seen: readonly Seen[], kind: Look["kind"]): Seen[] => seen.filter(({ look }) => look.kind === kind);

interface Pictures {
  colours: Seen[];
  depths: Seen[];
}

/** A grey image has the bits of a depth map. Beside one that is there, it goes to the free slot for the colour image. */
async function besideDepth(depth: Seen, there: File): Promise<Pictures> {
  const last = { file: there, look: await lookAt(there) };
  const image = last.look.kind === "depth" ? imageAmong([last, depth]) : undefined;
  return { colours: image ? [image] : [], depths: image === depth ? [] : [depth] };
}

/** Assigns colour images and depth maps. If two of one kind arrive while the slot of the other kind is free, one of them goes there. */
async function picturesOf(seen: readonly Seen[], there: Files): Promise<Pictures> {
  const [colours, depths] = [ofKind(seen, "colour"), ofKind(seen, "depth")];
  const [one, two] = colours.length > 0 ? colours : depths;
  if (one && two && depths.length === 0 && !there.depth) {
    const moved = odd([one, two], isDepthName);
    return { colours: colours.filter((each) => each !== moved), depths: [moved] };
  }
  if (one && two && colours.length === 0 && !there.colour) {
    const moved = odd([one, two], isColourName);
    return { colours: [moved], depths: depths.filter((each) => each !== moved) };
  }
  if (one && colours.length === 0 && there.depth && !there.colour) return besideDepth(one, there.depth);
  return { colours, depths };
}

/** Assigns masks by name, by the size of the pictures, or to the free slot. */
async function placeMasks(masks: readonly Seen[], after: Files, slots: Sorted["slots"]): Promise<void> {
  const lookOf = async (file: File | undefined) => file && (await lookAt(file));
  const [colour, depth] = [await lookOf(after.colour), await lookOf(after.depth)];
  const fits = (look: Look, other: Look | undefined) =>
    other !== undefined && look.width === other.width && look.height === other.height;
  for (const { file, look } of masks) {
    const [isColours, isDepths] = [fits(look, colour), fits(look, depth)];
    const free = after.colourMask === undefined ? "colourMask" : "depthMask";
    const bySize = isColours === isDepths ? undefined : isColours ? "colourMask" : "depthMask";
    const slot = isDepthName(file.name) ? "depthMask" : isColourName(file.name) ? "colourMask" : (bySize ?? free);
    slots.set(slot, file);
    after[slot] = file;
  }
}

/** The fields of the depth map's numbers, from its kind and the text beside it. A unit that the visitor typed stays. */
function fieldsOf(
  depth: Seen | undefined,
  seen: readonly Seen[],
  settings: Settings,
  remarks: Remark[],
): Sorted["fields"] {
  const fields: Sorted["fields"] = {};
  const say = (words: string) => remarks.push({ words, wrong: false });
  if (depth?.look.isInverse && settings.meaning !== "inverse") {
    Object.assign(fields, guess("meaning", "inverse"));
    say(
      `${depth.file.name}: its name suggests disparities or inverse depths, so larger numbers are read as nearer (Depth camera, Numbers).`,
    );
  } else if (depth && !depth.look.isInverse && isGuessed(settings, "meaning")) fields.meaning = "depth";
  const beside = ofKind(seen, "cameras").find(({ look }) => look.unit !== undefined);
  const { file, look: { unit } = { unit: undefined } } = beside ?? {};
  if (file === undefined || unit === undefined) return fields;
  const isOpen = settings.unit === null || isGuessed(settings, "unit");
  if (isOpen) fields.unit = unit;
  const millimetres = Number((1000 * unit).toPrecision(4));
  say(`${file.name}: one stored unit of depth is ${millimetres} mm${isOpen ? "" : "; the unit that you typed stays"}.`);
  return fields;
}

function sayOthers(seen: readonly Seen[], say: (words: string, wrong?: boolean) => void): void {
  for (const { file, look } of seen) {
    if (look.kind === "poses")
      say(
        `${file.name}: a pose. The Lab does not need one; to begin from it, enter its angles under Settings, Start, near.`,
      );
    else if (look.kind === "recording") say(`${file.name}: a recording. Open it in Check a rig.`, true);
    else if (look.kind === undefined) say(`${file.name}: ${look.says}`, true);
  }
}

/** Takes at most one file of each kind; `there` are the files already in the slots. */
export async function sorted(files: readonly File[], there: Files, settings: Settings): Promise<Sorted> {
  const seen = await Promise.all(files.map(async (file): Promise<Seen> => ({ file, look: await lookAt(file) })));
  const slots: Sorted["slots"] = new Map();
  const remarks: Remark[] = [];
  const say = (words: string, wrong = false) => void remarks.push({ words, wrong });
  const { colours, depths } = await picturesOf(seen, there);
  const grey = colours.find(({ look }) => look.kind === "depth");
  if (grey)
    say(
      `${grey.file.name} is grey and has the bits of a depth map; it was taken for the colour image. If it is the depth map, choose it there by hand.`,
    );
  for (const [slot, all] of [
    ["colour", colours],
    ["depth", depths],
  ] as const) {
    const [first, ...more] = all;
    if (first) slots.set(slot, first.file);
    for (const { file } of more)
      say(
        `${file.name} looks like a second ${slot === "colour" ? "colour image" : "depth map"}; the Lab uses only one.`,
      );
  }
  // A complete pair replaces the last one, whose masks do not belong to it.
  const isPair = [colours, depths].every(([first]) => first !== undefined && files.includes(first.file));
  const after: Files = { ...(isPair ? {} : there), ...Object.fromEntries(slots) };
  const masks = ofKind(seen, "mask");
  await placeMasks(masks, after, slots);
  if (masks.length > 0 && after.colourMask && after.depth && !after.depthMask)
    say("The depth map has no mask. Add one if it shows more than the object.");
  const fields = fieldsOf(depths[0], seen, settings, remarks);
  sayOthers(seen, say);
  const cameras = ofKind(seen, "cameras").flatMap(({ file, look }) =>
    look.cameras.map((camera) => ({ ...camera, file: file.name })),
  );
  return { slots, isPair, fields, cameras, remarks };
}
