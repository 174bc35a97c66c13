/** The calibration of an OAK camera as depthai's `calib dump` writes it: cameras by socket, each with its pose to another one. */
import { ofMatrix } from "./cameras.js";
import { Findings, flat, vector } from "./findings.js";
import { linked } from "./frames.js";
import { isNode, type Node, numberOf } from "./numbers.js";

/** Depthai's first sockets with the cameras that are usually connected to them. */
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
/** Metres per unit of its translations. */
const CENTIMETRE = 0.01;

/** The sockets with their cameras: C++ writes its map as a list of pairs, Python as an object. */
function entries(data: unknown): [unknown, Node][] {
  const pairs: unknown[] = Array.isArray(data) ? data : isNode(data) ? Object.entries(data) : [];
  return pairs.flatMap((pair) =>
    Array.isArray(pair) && isNode(pair[1]) ? [[pair[0], pair[1]] as [unknown, Node]] : [],
  );
}

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
          ...{ name, ...ofMatrix(k) },
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
      "The intrinsics and poses are those of the raw cameras. An OAK's depth map belongs to its rectified right (or left) camera, or is aligned to the colour camera: check which one yours is.",
    );
  return found;
}

/** The rotation and the translation, in centimetres, carry points of this camera into that of `toCameraSocket`. */
function motionOf(found: Findings, from: string, extrinsics: unknown): void {
  if (!isNode(extrinsics)) return;
  const [r, t] = [flat(extrinsics.rotationMatrix, 9), vector(extrinsics.translation)];
  const to = extrinsics.toCameraSocket;
  if (r === undefined || t === undefined || to === -1 || to === undefined || to === "AUTO") return;
  const target = socketName(to);
  found.pose(
    r,
    t.map((value) => CENTIMETRE * value),
    { name: `${target} from ${from}`, from, to: target },
  );
}

/** Moves the poses into the colour camera to the front, including those that lead through another camera. */
function toColour(found: Findings): void {
  const [colour = ""] = SOCKETS;
  const direct = found.poses.filter(({ to }) => to === colour);
  const others = found.poses.filter(({ to }) => to !== colour);
  const indirect = others.flatMap(({ from = "" }) => linked(found.poses, from, colour) ?? []);
  found.poses.splice(0, found.poses.length, ...direct, ...indirect, ...others);
}
