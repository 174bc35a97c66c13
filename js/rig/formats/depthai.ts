/** The calibration of an OAK camera as depthai's `calib dump` writes it: cameras by socket, each with the way to the next one. */
import type { NamedPose } from "../types.js";
import { Findings, flat, vector } from "./findings.js";
import { isNode, type Node, numberOf } from "./numbers.js";
import { chained } from "./poses.js";

/** Depthai's names of its first sockets and what is usually plugged there. */
const SOCKETS = ["rgb (CAM_A)", "left (CAM_B)", "right (CAM_C)"];
const socketName = (socket: unknown): string => {
  const text = String(socket).slice(0, 40);
  const letter = /^CAM_([A-Z])$/.exec(text)?.[1];
  const index = letter === undefined ? Number(text) : letter.charCodeAt(0) - "A".charCodeAt(0);
  if (!Number.isInteger(index) || index < 0 || index > 25) return text;
  return SOCKETS[index] ?? `CAM_${String.fromCharCode("A".charCodeAt(0) + index)}`;
};
const FISHEYE = 1;
const MODELS: Record<string, string> = { 0: "opencv", 1: "fisheye", 2: "equirectangular", 3: "radial division" };
const METRES = 0.01;

/** The sockets with their cameras: a map of C++ is a list of pairs in JSON, of Python an object. */
function entries(data: unknown): [unknown, Node][] {
  const pairs: unknown[] = Array.isArray(data) ? data : isNode(data) ? Object.entries(data) : [];
  return pairs.flatMap((pair) =>
    Array.isArray(pair) && isNode(pair[1]) ? [[pair[0], pair[1]] as [unknown, Node]] : [],
  );
}

/** Any camera of it has these two, whatever else the file says. */
export const isDepthai = (root: Node): boolean =>
  entries(root.cameraData).some(([, camera]) => "distortionCoeff" in camera && isNode(camera.extrinsics));

export function readDepthai(root: Node): Findings {
  const found = new Findings();
  for (const [socket, camera] of entries(root.cameraData)) {
    const k = flat(camera.intrinsicMatrix, 9);
    const name = socketName(socket);
    const type = numberOf(camera.cameraType) ?? 0;
    const lens = Array.isArray(camera.distortionCoeff) ? (camera.distortionCoeff as number[]) : [];
    if (k !== undefined && k[0] !== 0)
      found.camera(
        {
          ...{ name, focal: [k[0] ?? NaN, k[4] ?? NaN], centre: [k[2] ?? NaN, k[5] ?? NaN], skew: k[1] },
          ...{ distortion: type === FISHEYE ? lens.slice(0, 4) : lens, model: MODELS[type] ?? `type ${type}` },
          ...{ width: numberOf(camera.width), height: numberOf(camera.height) },
        },
        name.startsWith("rgb") ? "colour" : undefined,
      );
    motionOf(found, name, camera.extrinsics);
  }
  toColour(found);
  if (found.cameras.length > 1)
    found.warn(
      "pose-assumed",
      "An OAK's depth map is that of its rectified right (or left) camera, or aligned to the colour camera: its intrinsics and pose are those of the raw camera only if it was not rectified.",
    );
  return found.done("a calibration of depthai");
}

/** The rotation and the shift, in centimetres, carry points of this camera into that of `toCameraSocket`. */
function motionOf(found: Findings, from: string, extrinsics: unknown): void {
  if (!isNode(extrinsics)) return;
  const [r, t] = [flat(extrinsics.rotationMatrix, 9), vector(extrinsics.translation)];
  const to = extrinsics.toCameraSocket;
  if (r === undefined || t === undefined || to === -1 || to === undefined || to === "AUTO") return;
  const target = socketName(to);
  found.pose(
    r,
    t.map((value) => METRES * value),
    { name: `${target} from ${from}`, from, to: target },
  );
}

/** Where a camera leads to the colour camera by another one, the way through it. */
function toColour(found: Findings): void {
  const [colour = ""] = SOCKETS;
  const direct = found.poses.filter(({ to }) => to === colour);
  const byWay: NamedPose[] = found.poses.flatMap((pose) =>
    direct
      .filter(({ from }) => from === pose.to && pose.from !== colour)
      .map((next) => ({
        ...{ name: `${colour} from ${pose.from}`, from: pose.from ?? "", to: colour },
        pose: chained(next.pose, pose.pose),
      })),
  );
  const all = [...direct, ...byWay, ...found.poses.filter((pose) => !direct.includes(pose))];
  found.poses.splice(0, found.poses.length, ...all);
}
