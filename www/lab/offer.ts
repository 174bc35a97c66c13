/** Files that seem to be in the wrong slot, and the change that would correct it. */

import { type Look, imageAmong, lookAt } from "./look";
import type { Files, Slot } from "./storage";

/** A proposed change of slots. */
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

/** The change to propose, if a file seems to be in the wrong slot. */
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
  // A coloured picture is not a depth map; a grey one may be.
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
  const isImage =
    files.colour !== undefined &&
    files.depth !== undefined &&
    colour !== undefined &&
    depth?.kind === "depth" &&
    imageAmong([
      { file: files.colour, look: colour },
      { file: files.depth, look: depth },
    ])?.look === colour;
  // A mask may have soft edges, and a coarse depth map may have 8 bits, so neither is evidence of a wrong slot.
  const wrong: [Slot, Look | undefined, boolean][] = [
    ["colour", colour, (seems(colour, "depth") && !isImage) || seems(colour, "mask")],
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
