/** The example: frames of a rig whose calibration is known, made here, and a calibration that is off by a known amount. */

import type { CheckFrame, RigCamera } from "../../pkg/index.js";
import type { NamedPose } from "./files";
import { fromEuler, poseOf } from "./poses";

export interface Example {
  frames: CheckFrame[];
  poses: NamedPose[];
}

const [WIDTH, HEIGHT] = [160, 120];
const colour: RigCamera = { fx: 150, fy: 150, cx: 79.5, cy: 59.5 };
const depth: RigCamera = { fx: 140, fy: 140, cx: 79.5, cy: 59.5 };
const truth = poseOf(fromEuler(0.4, -0.6, 0.3, "xyz"), [0.05, 0.002, -0.003]);
const told = poseOf(fromEuler(0.4, 1.4, 0.3, "xyz"), [0.05, 0.002, -0.003]);

/** A draped sheet before a wall 0.3 m behind it: distance at a place, metres. */
function surface(x: number, y: number, turn: number): number {
  const sheet = 1 + 0.03 * Math.sin(14 * x + turn) * Math.cos(11 * y - turn) + 0.02 * Math.sin(23 * x - 17 * y);
  return Math.abs(x - 0.05 * Math.sin(turn)) < 0.24 && Math.abs(y - 0.02) < 0.19 ? sheet : 1.3 + 0.05 * x;
}

/** Where a ray of the depth camera, or of the colour camera moved by the truth, meets the surface. */
function meet(origin: readonly number[], ray: readonly number[], turn: number): [number, number, number] {
  for (let far = 0.8; far < 1.6; far += 0.004) {
    const [x = 0, y = 0, z = 0] = origin.map((value, i) => value + far * (ray[i] ?? 0));
    if (z >= surface(x, y, turn)) return [x, y, z];
  }
  return [NaN, NaN, NaN];
}

function frame(turn: number, name: string): CheckFrame {
  const data = new Uint16Array(WIDTH * HEIGHT);
  const pixels = new Uint8ClampedArray(4 * WIDTH * HEIGHT).fill(255);
  const r = truth.rotation;
  const back = (v: readonly number[]) => [0, 1, 2].map((k) => (r[k] ?? 0) * (v[0] ?? 0) + (r[k + 3] ?? 0) * (v[1] ?? 0) + (r[k + 6] ?? 0) * (v[2] ?? 0));
  const eye = back(truth.translation).map((value) => -value);
  for (let i = 0; i < WIDTH * HEIGHT; i++) {
    const [column, row] = [i % WIDTH, Math.floor(i / WIDTH)];
    const [, , z] = meet([0, 0, 0], [(column - depth.cx) / depth.fx, (row - depth.cy) / depth.fy, 1], turn);
    data[i] = Number.isNaN(z) ? 0 : Math.round(1000 * z);
    const [x, y] = meet(eye, back([(column - colour.cx) / colour.fx, (row - colour.cy) / colour.fy, 1]), turn);
    const step = 0.004;
    const slope = (surface(x + step, y, turn) - surface(x - step, y, turn) + 0.6 * (surface(x, y + step, turn) - surface(x, y - step, turn))) / (2 * step);
    const light = Math.max(20, 150 - 90 * Math.max(-1.2, Math.min(1.2, slope)));
    for (let c = 0; c < 3; c++) pixels[4 * i + c] = light * ([1, 0.96, 0.9][c] ?? 1);
  }
  return {
    name,
    image: { width: WIDTH, height: HEIGHT, data: pixels, camera: colour },
    depth: { width: WIDTH, height: HEIGHT, data, unit: 0.001, camera: depth },
  };
}

export async function loadExample(): Promise<Example> {
  return { frames: [frame(0, "frame 1"), frame(1.5, "frame 2"), frame(3, "frame 3")], poses: [{ name: "made 2° off", pose: told, from: "depth", to: "colour" }] };
}
