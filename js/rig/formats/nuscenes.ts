/**
 * `calibrated_sensor.json` and `ego_pose.json` of nuScenes and Lyft Level 5, or single records of them: quaternions are w x y z, and poses
 * carry points of a sensor into the vehicle's frame, or of the vehicle into the world.
 */
import type { NamedPose } from "../types.js";
import { Findings, flat } from "./findings.js";
import { isNode, type Node, numberOf } from "./numbers.js";
import { ofQuaternion } from "./poses.js";

const isPosed = (value: unknown): value is Node =>
  isNode(value) && flat(value.rotation, 4) !== undefined && flat(value.translation, 3) !== undefined;
const isRecord = (value: unknown): boolean =>
  isPosed(value) && ["camera_intrinsic", "sensor_token", "token", "ego_pose_token"].some((key) => key in value);

/** Records by the names that they have: of a table none, of an object its members'. */
function records(root: unknown): [name: string, record: unknown][] {
  if (Array.isArray(root)) return root.map((each) => ["", each]);
  return isNode(root) ? [["", root], ...Object.entries(root)] : [];
}

export const isNuscenes = (root: unknown): boolean =>
  records(root)
    .slice(0, 20)
    .some(([, each]) => isRecord(each));

/** Of a record: its channel where somebody has joined the tables, or else what it is and the beginning of its token. */
function called(name: string, record: Node): string {
  const channel = record.channel ?? record.sensor_name ?? (name === "" ? undefined : name);
  if (typeof channel === "string") return channel.slice(0, 60);
  const kind = flat(record.camera_intrinsic, 9) ? "camera" : "sensor";
  return `${kind} ${String(record.token ?? record.sensor_token ?? "").slice(0, 8)}`.trim();
}

export function readNuscenes(root: unknown): Findings {
  const found = new Findings();
  const [cameras, others]: [NamedPose[], NamedPose[]] = [[], []];
  for (const [own, record] of records(root)) {
    if (!isPosed(record)) continue;
    const k = flat(record.camera_intrinsic, 9);
    const isEgo = "timestamp" in record && !("sensor_token" in record || "camera_intrinsic" in record);
    const name = isEgo ? "ego" : called(own, record);
    if (k !== undefined)
      found.camera({
        ...{ name, focal: [k[0] ?? NaN, k[4] ?? NaN], centre: [k[2] ?? NaN, k[5] ?? NaN], skew: k[1] },
        ...{ width: numberOf(record.width), height: numberOf(record.height) },
      });
    const [w = NaN, x = NaN, y = NaN, z = NaN] = flat(record.rotation, 4) ?? [];
    const to = isEgo ? "world" : "ego";
    const pose = found.pose(ofQuaternion([x, y, z, w], found.warnings), flat(record.translation, 3) ?? [], {
      ...{ name: `${to} from ${name}`, from: name, to },
    });
    if (pose && !isEgo) (k ? cameras : others).push(pose);
  }
  // With one camera and one other sensor there is no doubt which pair it is.
  if (cameras.length === 1 && others.length === 1) found.relate(others[0], cameras[0]);
  return found.done("a table of nuScenes");
}
