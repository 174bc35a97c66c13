/**
 * The tree of coordinate frames in /tf_static and /tf: each transform carries points of a child frame into its parent,
 * P_parent = R P_child + t, and the motion between two frames leads through their common ancestor.
 *
 * Joints move: where a transform between the two cameras changes, the latest one is used, with a warning.
 */
import { chained, inverseOf, motion, ofQuaternion, poseOf } from "../formats/poses.js";
import type { NamedPose, Pose } from "../types.js";
import { type ReaderWarning, warning } from "../warnings.js";
import { type Message, frameOf, inner, isMessage, numberIn, textIn } from "./messages.js";

interface Edge {
  parent: string;
  /** The first pose recorded, and the last one. */
  first: Pose;
  pose: Pose;
  /** The largest change from the first, radians and metres. */
  turned: number;
  shifted: number;
}

/** Largest number of frames in a chain; a longer chain is circular. */
const LONGEST = 100;
/** Largest change of a fixed transform, from the rounding of its numbers: radians and metres. */
const STILL = { turn: 2e-3, shift: 5e-4 };

/** Whether a topic holds transforms that do not change. */
export const isStatic = (topic: string): boolean => /static/i.test(topic);

const clean = (frame: string): string => frame.replace(/^\/+/, "");

export function poseOfTransform(message: Message, warnings: ReaderWarning[]): Pose {
  const [t, q] = [inner(message, "translation"), inner(message, "rotation")];
  const turn = ["x", "y", "z", "w"].map((name) => numberIn(q, name));
  const shift = ["x", "y", "z"].map((name) => numberIn(t, name));
  return motion(ofQuaternion(turn, warnings), shift, {}, warnings, false).pose;
}

function apart(a: Pose, b: Pose): { turn: number; shift: number } {
  const trace = a.rotation.reduce((sum, value, index) => sum + value * (b.rotation[index] ?? 0), 0);
  return {
    turn: Math.acos(Math.min(1, Math.max(-1, (trace - 1) / 2))),
    shift: Math.hypot(...a.translation.map((value, index) => value - (b.translation[index] ?? 0))),
  };
}

export class Transforms {
  readonly #edges = new Map<string, Edge>();
  readonly #warnings: ReaderWarning[] = [];

  /** The transforms of one message of tf2_msgs/TFMessage or tf/tfMessage. */
  add(message: Message): void {
    for (const each of Array.isArray(message.transforms) ? message.transforms.filter(isMessage) : []) {
      const [child, parent] = [clean(textIn(each, "child_frame_id")), frameOf(each)];
      if (child === "" || parent === "" || child === parent) continue;
      this.#set(child, parent, poseOfTransform(inner(each, "transform"), this.#warnings));
    }
  }

  #set(child: string, parent: string, pose: Pose): void {
    const known = this.#edges.get(child);
    const first = known?.parent === parent ? known.first : pose;
    const { turn, shift } = apart(first, pose);
    this.#edges.set(child, {
      parent,
      first,
      pose,
      turned: Math.max(known?.turned ?? 0, turn),
      shifted: Math.max(known?.shifted ?? 0, shift),
    });
  }

  /** A frame and its ancestors. Each has the motion into it and those transforms on the way that change over time. */
  #upward(frame: string): Map<string, { pose: Pose; moving: string[] }> {
    const found = new Map<string, { pose: Pose; moving: string[] }>();
    let pose = poseOf([1, 0, 0, 0, 1, 0, 0, 0, 1], [0, 0, 0]);
    let moving: string[] = [];
    for (let at = frame; found.size < LONGEST && !found.has(at); ) {
      found.set(at, { pose, moving });
      const edge = this.#edges.get(at);
      if (edge === undefined) break;
      pose = chained(edge.pose, pose);
      if (edge.turned > STILL.turn || edge.shifted > STILL.shift) moving = [...moving, `${edge.parent} to ${at}`];
      at = edge.parent;
    }
    return found;
  }

  /** The motion that carries points of one frame into another; undefined without a common ancestor. */
  between(from: string, to: string): { pose: NamedPose; warnings: ReaderWarning[] } | undefined {
    const [a, b] = [this.#upward(clean(from)), this.#upward(clean(to))];
    const common = [...a.keys()].find((frame) => b.has(frame));
    const [up, down] = [a.get(common ?? ""), b.get(common ?? "")];
    if (common === undefined || up === undefined || down === undefined) return undefined;
    const moving = [...up.moving, ...down.moving];
    const warnings = [...this.#warnings];
    if (moving.length > 0)
      warnings.push(
        warning(
          "transform-moves",
          `The transform between the cameras changes during the recording (${moving.join(", ")}); the latest one is used. Record while the joints rest.`,
          { transforms: moving },
        ),
      );
    return { pose: { name: "tf", pose: chained(inverseOf(down.pose), up.pose), from, to }, warnings };
  }
}
