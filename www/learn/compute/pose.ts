/** Finding the pose: the residual reveals a wrong pose, registration and search find the right one. */

import type { Estimator, Options, Sample } from "../../../pkg/index.js";
import type { CloudPanel, Drawing, Values } from "../protocol";
import { pictureOf, plot, scalarOf } from "./draw";
import { cloudsOf } from "./clouds";
import { aboutY, degreesBetween, meanOf, product, turned } from "./measure";
import { after, afterStages, numberOf, scene, watched } from "./scenes";
import { statusOf, wordsOf, type Status } from "./status";

const SIZE = 64;
/** The true pose. */
const BETA = 20;
const OFFSETS = [-40, -30, -20, -14, -8, -4, 0, 4, 8, 14, 20, 30, 40];
const ENDS = [Math.min(...OFFSETS), Math.max(...OFFSETS)] as const;
/** The upper end of the residual's axis: above the whole curve under each light, so that it does not move while the curve is computed. */
const MOST_RESIDUAL: Readonly<Record<string, number>> = { colourful: 0.7, window: 0.5, overcast: 0.2 };
/** Stages of an iteration up to the light, whose fit leaves the residual, and up to the image's surface. */
const [TO_LIGHT, TO_SURFACE] = [1, 3];

export const picture = (values: Values): Sample =>
  scene({ surface: "bust", light: String(values.light), size: SIZE, angles: { beta: BETA }, noise: 0.01 });

/** The curves as far as they are known, which depend on the light alone. */
const curves = new WeakMap<Sample, number[]>();

const middles = new WeakMap<Sample, number[]>();
/** The middle of the depth map's points in the camera's frame, under the true pose. */
function middleOf(made: Sample): number[] {
  const known = middles.get(made);
  if (known) return known;
  const points = afterStages(
    made,
    { light: made.light, start: made.pose, scale: 1, registration: "fixed" },
    0,
    (estimator) => estimator.points("depth"),
  );
  const middle = [0, 1, 2].map((axis) => meanOf(points, (at) => at % 3 === axis));
  middles.set(made, middle);
  return middle;
}

/** The options of a run that starts from the true pose turned about the object's middle. */
function startedOff(made: Sample, degrees: number, registration: "fixed" | "joint" | "icp"): Options {
  const middle = middleOf(made);
  const turn = aboutY(degrees);
  const arm = made.pose.translation.map((value, axis) => value - (middle[axis] ?? 0));
  const translation = turned(turn, arm).map((value, axis) => value + (middle[axis] ?? 0));
  return {
    light: made.light,
    start: { rotation: product(turn, made.pose.rotation), translation },
    scale: 1,
    registration,
    shading: "pixel",
  };
}

interface State {
  panel: CloudPanel;
  residual: Float32Array;
  rotation: readonly number[];
  correspondence: Int32Array;
  normals: Float32Array;
  explained: number;
  status: Status;
}

const stateOf = (estimator: Estimator, status: Status): State => {
  const residual = estimator.residual();
  return {
    panel: cloudsOf(estimator),
    residual,
    rotation: estimator.report.pose.rotation,
    correspondence: estimator.correspondence(),
    normals: estimator.depthNormals(),
    explained: estimator.report.residual,
    status,
  };
};

/** The state under a pose that is off by this angle, after one pass up to the image's surface. */
export const held = (made: Sample, offset: number): State =>
  afterStages(made, startedOff(made, offset, "fixed"), TO_SURFACE, (estimator) => stateOf(estimator, statusOf("held")));

/** The state after passes of the loop that moves the depth map onto the image's surface, from a pose that is off by this angle. */
export const passed = (made: Sample, offset: number, passes: number): State =>
  after(made, startedOff(made, offset, "icp"), passes, (estimator) => stateOf(estimator, statusOf("held")));

export function* pose(values: Values): Generator<Drawing> {
  const made = picture(values);
  const offset = numberOf(values, "offset");
  const curve = curves.get(made) ?? [];
  curves.set(made, curve);
  let state = held(made, offset);
  const draw = (): Drawing => drawing(values, made, state, curve);
  yield draw();
  const run = String(values.run);
  if (run !== "hold") {
    const options: Options = run === "search" ? { scale: 1 } : startedOff(made, offset, "joint");
    for (const { estimator, status } of watched(made, options)) {
      state = stateOf(estimator, status);
      yield draw();
    }
  }
  for (const each of OFFSETS.slice(curve.length / 2)) {
    curve.push(
      each,
      afterStages(made, startedOff(made, each, "fixed"), TO_LIGHT, (estimator) => estimator.report.residual),
    );
    yield draw();
  }
}

function drawing(values: Values, made: Sample, state: State, curve: number[]): Drawing {
  const grid = made.image;
  const error = degreesBetween(state.rotation, made.pose.rotation);
  const offset = numberOf(values, "offset");
  // A run may leave the axis of the curve, and then only the size of its error is drawn, on the side where it began.
  const at = String(values.run) === "hold" ? offset : error * (offset < 0 ? -1 : 1);
  const panels: Drawing["panels"] = [
    pictureOf({ key: "picture", title: "The picture", alt: "A bust." }, grid, made.image.data as Float32Array),
    state.panel,
    scalarOf(
      {
        key: "residual",
        title: "Unexplained colour",
        alt: "Residual of every pixel under this pose: dark where the colours are explained.",
        legend: "dark: explained; bright: off by 0.5 and more",
      },
      grid,
      state.residual,
      { min: 0, max: 0.5 },
      "magma",
    ),
  ];
  panels.push(
    plot(
      {
        key: "curve",
        title: "Residual against the error of the pose",
        alt: "The residual is smallest where the pose is right.",
      },
      "error, °",
      "residual",
      [{ name: "residual", ink: "pose", points: [...curve], dots: true }],
      {
        domain: ENDS,
        hasAngles: true,
        range: [0, MOST_RESIDUAL[String(values.light)] ?? 1],
        ...(Math.abs(at) <= ENDS[1] ? { at } : {}),
      },
    ),
  );
  return { panels, numbers: { error, residual: meanOf([state.explained]) }, ...wordsOf(state.status) };
}
