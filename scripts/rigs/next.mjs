// Tests whether the frame that a check proposes sharpens the calibration as much as predicted. The frame is rendered and added.
import { percent, quantile } from "./draws.mjs";

/** Largest factor between the predicted and the measured gain. */
const WITHIN = 1.5;
const AXES = ["rx", "ry", "rz", "tx", "ty", "tz"];

/** Sigma of an unknown about `middle`, from a covariance about the centre of another report, radians or metres. */
function sigmaOf({ covariance, middle: own }, axis, middle) {
  const k = AXES.indexOf(axis);
  const [x, y, z] = own.map((value, index) => middle[index] - value);
  // A rotation w about one centre moves the other one by w x arm.
  const arm = [
    [0, z, -y],
    [-z, 0, x],
    [y, -x, 0],
  ];
  const row = [0, 1, 2, 3, 4, 5].map((j) => (j < 3 && k >= 3 ? arm[k - 3][j] : Number(j === k)));
  const at = (i, j) => covariance[6 * i + j];
  return Math.sqrt(row.reduce((sum, a, i) => sum + row.reduce((inner, b, j) => inner + a * b * at(i, j), 0), 0));
}

/** A rig's proposal with its predicted and its measured gain. The gain is the sigma with one frame divided by that with two. */
export async function proposed({ checkCalibration, sampleRig }, { kind, seed }) {
  const { pose, ...first } = await sampleRig({ kind, seed });
  const one = await checkCalibration([first], { true: pose });
  if (!one.next) return { kind, seed };
  const { axis, motion, sigma, expected, pose: moved } = one.next;
  const { pose: _, ...second } = await sampleRig({ kind, seed, motion: moved });
  const two = await checkCalibration([first, second], { true: pose });
  const [before, after] = [one, two].map((report) => sigmaOf(report, axis, one.middle));
  return { ...{ kind, seed, axis, motion, sigma, expected }, predicted: sigma / expected, measured: before / after };
}

export function printProposed(rows) {
  const some = rows.filter(({ axis }) => axis);
  console.log("\nrig           unknown  next frame   predicted gain  measured gain");
  for (const { kind, seed, axis, motion, predicted, measured } of some)
    console.log(
      `${`${kind} ${seed}`.padEnd(14)}${axis.padEnd(9)}${motion.padEnd(13)}${predicted.toFixed(2).padEnd(16)}${measured.toFixed(2)}`,
    );
  const ratios = some.map(({ predicted, measured }) => predicted / measured);
  const good = ratios.filter((ratio) => ratio <= WITHIN && ratio >= 1 / WITHIN).length;
  console.log(
    `Predicted over measured: median ${quantile(ratios, 0.5).toFixed(2)}; within a factor of ${WITHIN} in ${good} of ${rows.length} (${percent(good, rows.length)}; aim: 80 %).`,
  );
  console.log(
    `The measured gain is above one in ${percent(some.filter(({ measured }) => measured > 1).length, rows.length)}.`,
  );
}
