/** What is doubtful about the input of a check: each keeps its verdict from being better than the files are. */

import type { RigState, Side } from "./state";

/** A principal point farther from the middle than this share of the picture's side is likelier another size's. */
const OFF_CENTRE = 0.2;

/** Numbers for another size of image are the second commonest mistake. */
export function cameraDoubt(rig: RigState, side: Side): string {
  const file = rig.given.find(({ source }) => source === rig.cameras[side].source)?.camera;
  const size = rig.sizeOf(side);
  if (!size) return "";
  if (file?.width && file.height && (file.width !== size.width || file.height !== size.height))
    return `these are for ${file.width}×${file.height} px, the files have ${size.width}×${size.height} px.`;
  const camera = rig.cameraOf(side);
  const isOff = (centre: number, length: number) => Math.abs(centre / length - 0.5) > OFF_CENTRE;
  return camera && (isOff(camera.cx, size.width) || isOff(camera.cy, size.height))
    ? `the centre is far from the middle of ${size.width}×${size.height} px; are these for another size?`
    : "";
}

/** What the readers of files and folders warned of, once for files that are alike, and what speaks against the cameras' numbers. A guessed unit is told apart: it can be confirmed. */
export function doubtsOf(rig: RigState): string[] {
  const used = new Set(rig.complete.flatMap(({ colour, depth }) => [colour, depth]));
  const alike = new Map<string, { first: string; count: number }>();
  for (const { id, name, summary } of rig.items) {
    if (!used.has(id)) continue;
    for (const words of summary?.warnings ?? []) {
      if (isOfUnit(words)) continue;
      const about = words.replace(/\d+(\.\d+)?/g, "#");
      const known = alike.get(about);
      if (known) known.count++;
      else alike.set(about, { first: `${name}: ${words}`, count: 1 });
    }
  }
  const ofFiles = [...alike.values()].map(({ first, count }) =>
    count > 1 ? `${first} (And ${count - 1} more alike.)` : first,
  );
  const sizes = rig.complete.flatMap((frame) =>
    (["colour", "depth"] as const).flatMap((side) => {
      const [own, usual] = [rig.item(frame[side])?.summary, rig.sizeOf(side)];
      const isUsual = !own || !usual || (own.width === usual.width && own.height === usual.height);
      return isUsual || !rig.cameraOf(side) || own.organised
        ? []
        : [
            `${frame.name}: its ${side === "colour" ? "colour image" : "depth map"} is ${own.width}×${own.height} px, not ${usual.width}×${usual.height} px as the first frame's, and the camera's numbers are for one size.`,
          ];
    }),
  );
  const sides = rig.cameras.depth.source === "same" ? (["colour"] as const) : (["colour", "depth"] as const);
  const ofCameras = sides.flatMap((side) => {
    const words = cameraDoubt(rig, side);
    return words ? [`The ${side} camera's numbers: ${words}`] : [];
  });
  return [
    ...ofFiles,
    ...rig.notes.filter((words) => !isOfUnit(words) && !MERE_NOTE.test(words)),
    ...sizes,
    ...ofCameras,
  ];
}

/** Of a folder: what was not read says nothing against what was. */
const MERE_NOTE = /\(left out\)|evenly spread/;

const isOfUnit = (words: string): boolean => /unit .*guess|guess.* unit/i.test(words);
