// A rig of the reader's own: a folder of frames with their cameras, and a file with its extrinsics.
import { readFileSync, readdirSync } from "node:fs";
import { basename, join } from "node:path";
import { Failure } from "../shell.mjs";
import { rigSight } from "./read.mjs";

export async function folderOf({ readRigFile, readRigFolder }, folder, calibration) {
  const named = readdirSync(folder, { recursive: true, withFileTypes: true }).filter((entry) => entry.isFile());
  const files = named.map((entry) => ({
    name: entry.name,
    bytes: new Uint8Array(readFileSync(join(entry.parentPath ?? entry.path, entry.name))),
  }));
  const { frames, warnings } = await readRigFolder(files, {});
  const { poses = [] } = await readRigFile({
    name: basename(calibration),
    bytes: new Uint8Array(readFileSync(calibration)),
  });
  if (frames.length === 0)
    throw new Failure(
      `${folder} holds no pair of a colour image and a depth map. ${warnings.map(({ message }) => message).join(" ")}`,
    );
  if (poses.length === 0) throw new Failure(`${calibration} holds no extrinsics.`);
  const blind = frames.find(({ image, depth }) => !image.camera || !(depth.camera || depth.points));
  if (blind) throw new Failure(`${blind.name}: both cameras' intrinsics are needed.`);
  const bent = ({ camera }) => camera && (camera.model === "fisheye" || camera.distortion?.length > 5);
  if (frames.some(({ image, depth }) => bent(image) || bent(depth)))
    throw new Failure("Only Brown's lens with up to five coefficients is turned here.");
  return frames.map((frame) => rigSight(frame, poses[0].pose));
}
