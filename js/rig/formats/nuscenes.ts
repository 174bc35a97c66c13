/**
 * `calibrated_sensor.json` and `ego_pose.json` of nuScenes and Lyft Level 5, or single records of them: quaternions are w x y z, and poses
 * carry points of a sensor into the vehicle's frame, or of the vehicle into the world.
 */
import type { NamedPose } from "../types.js";
import { ofMatrix } from "./cameras.js";
import { Findings, flat } from "./findings.js";
import { isNode, type Node, numberOf } from "./numbers.js";
import { ofScalarFirst } from "./poses.js";

const isPosed = (value: unknown): value is Node =>
  isNode(value) && flat(value.rotation, 4) !== undefined && flat(value.translation, 3) !== undefined;
const isRecord = (value: unknown): boolean =>
  isPosed(value) && ["camera_intrinsic", "sensor_token", "token", "ego_pose_token"].some((key) => key in value);

/** The records of a table or an object. Those of an object have the names of its members; those of a table have none. */
function records(root: unknown): [name: string, record: unknown][] {
  if (Array.isArray(root)) return root.map((each) => ["", each]);
  return isNode(root) ? [["", root], ...Object.entries(root)] : [];
}

export const isNuscenes = (root: unknown): boolean =>
  records(root)
    .slice(0, 20)
    .some(([, each]) => isRecord(each));

/** The name of a record: its channel if the tables were joined, or else its kind and the beginning of its token. */
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
        ...{ name, ...ofMatrix(k) },
        ...{ width: numberOf(record.width), height: numberOf(record.height) },
      });
    const to = isEgo ? "world" : "ego";
    const turn = ofScalarFirst(flat(record.rotation, 4) ?? [], found.warnings);
    const pose = found.pose(turn, flat(record.translation, 3) ?? [], {
      ...{ name: `${to} from ${name}`, from: name, to },
    });
    if (pose && !isEgo) (k ? cameras : others).push(pose);
  }
  // A file with one camera and one other sensor has the pose between them.
  if (cameras.length === 1 && others.length === 1) found.relate(others[0], cameras[0]);
  return found;
}
