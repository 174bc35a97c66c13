/** The command that repeats a check of the page in a shell: the files by their names, and typed values as separate files. */

import type { Pinhole, Pose } from "../../pkg/index.js";
import type { ShellCheck } from "../../pkg/rig/write/report/index.js";
import type { Rig } from "./rig";
import type { Run, Side } from "./state";

/** Pairs that the command takes by default. */
const FRAMES = 20;

/** All digits, since this is the pose that was checked. */
const matrixOf = ({ rotation: r, translation: t }: Pose): string =>
  [...[0, 1, 2].map((i) => [...r.slice(3 * i, 3 * i + 3), t[i]].join(" ")), "0 0 0 1"].join("\n");

const isSame = (a: Pose, b: Pose): boolean =>
  JSON.stringify([a.rotation, a.translation]) === JSON.stringify([b.rotation, b.translation]);

/** The file that holds exactly this pose and no other pose. */
function fileOf(rig: Rig, name: string, pose: Pose): string | undefined {
  const candidate = rig.candidates.find((each) => each.name === name);
  const item = rig.item(candidate?.file);
  const [only, ...others] = item?.summary?.poses ?? [];
  return item?.blob && only && others.length === 0 && isSame(only.pose, pose) ? item.name : undefined;
}

/** A camera in the form that the JSON readers know. */
const cameraOf = ({ model, ...camera }: Pinhole, size: object | undefined): object => ({
  ...camera,
  ...(camera.distortion ? { distortion: Array.from(camera.distortion) } : {}),
  ...(model === "fisheye" ? { distortion_model: "fisheye" } : {}),
  ...size,
});

/**
 * The names of the files that gave the cameras, which the command reads as the page does. If a camera was typed in, the text of both
 * cameras as they were used.
 */
function camerasOf(rig: Rig, { plans: [plan] }: Run): { names: string[]; text?: string } {
  const sides: Side[] = ["colour", "depth"];
  const items = sides.map((side) => rig.item(Number.parseInt(rig.cameras[side].source, 10)));
  const isRead = sides.every((side, k) => !rig.cameras[side].chosen && (rig.cameras[side].source === "" || items[k]));
  if (isRead) return { names: [...new Set(items.flatMap((item) => (item?.blob ? [item.name] : [])))] };
  const { colourCamera, depthCamera } = plan ?? {};
  const cameras = {
    ...(colourCamera ? { color: cameraOf(colourCamera, rig.sizeOf("colour")) } : {}),
    ...(depthCamera ? { depth: cameraOf(depthCamera, rig.sizeOf("depth")) } : {}),
  };
  return { names: [], text: JSON.stringify(cameras) };
}

/** The arguments of the command that repeats the check. It has to be typed in the folder that holds the files. */
export function shellOf(rig: Rig, run: Run): ShellCheck {
  const cameras = camerasOf(rig, run);
  const calibrations = Object.entries(run.candidates).map(([name, pose], k) => {
    const file = fileOf(rig, name, pose);
    return file === undefined ? { name: `calibration-${k + 1}.txt`, text: matrixOf(pose) } : { name: file };
  });
  const units = new Set(run.plans.map(({ depth }) => rig.item(depth)?.unit));
  const [unit] = units;
  return {
    folder: ".",
    calibrations: calibrations.map(({ name }) => name),
    // A calibration that contains cameras is already in the command, so it is not named twice.
    cameras: [
      ...cameras.names.filter((name) => !calibrations.some((each) => each.name === name)),
      ...(cameras.text === undefined ? [] : ["cameras.json"]),
    ],
    ...(unit !== undefined && units.size === 1 ? { unit } : {}),
    ...(run.plans.length > FRAMES ? { frames: run.plans.length } : {}),
    ...(run.cues.length > 0 ? { cues: run.cues } : {}),
    written: [
      ...calibrations.flatMap(({ name, text }) => (text === undefined ? [] : [{ name, text }])),
      ...(cameras.text === undefined ? [] : [{ name: "cameras.json", text: cameras.text }]),
    ],
  };
}

/** Whether the run has restrictions that the command cannot repeat. */
export const isRestricted = ({ plans }: Run): boolean => plans.some(({ paint, range }) => paint || range);
