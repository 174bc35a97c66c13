/**
 * Arranges single files like a folder of a rig, with the code that reads folders: which camera took which pictures, and which poses matter.
 */
import { assigned, ofRig, withoutCarriers, withoutInertial } from "../rig/folder.js";
import { stem } from "../rig/names.js";
import { posesForClouds } from "../rig/turned.js";
import type { CheckFrame, NamedPose, ReaderWarning, RigReading } from "../rig/types.js";

/** A frame whose files were read one by one. */
export interface ReadFrame {
  colour: Extract<RigReading, { kind: "colour" }>;
  depth: Extract<RigReading, { kind: "depth" }>;
}

/** A text that was read, and its number. */
export interface ReadText {
  file: number;
  reading: Extract<RigReading, { kind: "cameras" | "poses" }>;
}

/** The places of the cameras, "file:index", the poses with their files, and the guesses. */
export interface Arranged {
  cameras: { colour?: string; depth?: string };
  poses: (NamedPose & { file?: number })[];
  warnings: ReaderWarning[];
}

/** Codes of warnings that the page's forms show by themselves. */
const GIVEN = new Set(["colour-camera-missing", "depth-camera-missing", "camera-size", "principal-point"]);

/** The cameras and poses that the frames and texts describe together. */
export function arranged(read: ReadFrame[], texts: ReadText[]): Arranged {
  const warnings: ReaderWarning[] = [];
  const frames = read.map(
    ({ colour, depth }): CheckFrame => ({
      name: stem(colour.name),
      image: { ...colour.image },
      depth: { ...depth.depth },
    }),
  );
  const cameras = texts.flatMap(({ file, reading }) =>
    reading.kind === "cameras"
      ? reading.cameras.map((each, at) => ({ ...each, name: each.name ?? stem(reading.name), place: `${file}:${at}` }))
      : [],
  );
  const poses = texts.flatMap(({ file, reading }) =>
    ofRig(reading, stem(reading.name)).map((pose) => ({ ...pose, file })),
  );
  const paths = read.flatMap(({ colour, depth }) => [colour.name, depth.name]);
  const whole = { frames, cameras, poses: withoutInertial(poses, warnings), readings: [], warnings };
  const folder = assigned(whole, { paths, isAligned: false });
  const placeOf = (camera: unknown) => cameras.find((each) => each.camera === camera)?.place;
  const [first] = frames;
  const [colour, depth] = [placeOf(first?.image.camera), placeOf(first?.depth.camera)];
  return {
    cameras: { ...(colour !== undefined && { colour }), ...(depth !== undefined && { depth }) },
    poses: posesForClouds(withoutCarriers(folder.poses, warnings), frames, warnings),
    warnings: warnings.filter(({ code }) => !GIVEN.has(code)),
  };
}
