// Common mistakes in the files of a rig, and whether the first sentence of a check names them.
import { IDENTITY, aboutAxis, offBy, product, transpose, turn } from "../../protocols/rotations.mjs";
import { project, ray } from "../captures/lens.mjs";
import { chance, inverse, moved, percent, poseOf, quantile, wrong } from "./draws.mjs";
import { registered, resized, rotated } from "./mistakes.mjs";

/** Rotation from optical axes to x forward, y left, z up. */
const BODY = [0, 0, 1, -1, 0, 0, 0, -1, 0];
const DEGREE = Math.PI / 180;
/** The largest error that passes, pixels of an image 640 wide. */
const PASSES = 3.5;

/** A mistake that affects only the pose: `change` applies it to a rotation and a translation. */
const ofPose = (change) => (rig) => ({ ...rig, pose: poseOf(...change(rig.pose)) });
/** A mistake in how the colour images or depth maps are stored or described. */
const ofView = (view, change) => (rig) => ({
  ...rig,
  frames: rig.frames.map((frame) => ({ ...frame, [view]: change(frame[view]) })),
});
const withRotation = (change) => ofPose(({ rotation, translation }) => [change(rotation), translation]);
const times = (factor) => ofPose(({ rotation, translation }) => [rotation, translation.map((value) => factor * value)]);

/** Rotation vector of a rotation, rad, and the rotation of a vector. */
const vectorOf = (rotation) => offBy(rotation, IDENTITY).map((degrees) => degrees * DEGREE);
function rotationOf(vector) {
  const angle = Math.hypot(...vector);
  if (angle === 0) return IDENTITY;
  return aboutAxis(
    vector.map((value) => value / angle),
    angle / DEGREE,
  );
}
function quaternionOf(rotation) {
  const vector = vectorOf(rotation);
  const angle = Math.hypot(...vector);
  const share = angle > 0 ? Math.sin(angle / 2) / angle : 0.5;
  return [...vector.map((value) => share * value), Math.cos(angle / 2)];
}
function ofQuaternion([x, y, z, w]) {
  const sine = Math.hypot(x, y, z);
  const angle = 2 * Math.atan2(sine, w);
  return rotationOf([x, y, z].map((value) => (sine > 0 ? (value / sine) * angle : 0)));
}

const image = (change) => ofView("image", change);
const depth = (change) => ofView("depth", change);
const OTHER_SIZES = {
  "640x480": [1280, 960],
  "960x540": [1920, 1080],
  "512x424": [640, 480],
  other: [320, 240],
};
const otherSize = (view) => resized(view, OTHER_SIZES[`${view.width}x${view.height}`] ?? OTHER_SIZES.other, 0);
/** The height is kept, and the sides are cut off or added, as in the narrow stream of a wide sensor. */
const otherShape = (view) => resized(view, view.width * 3 === view.height * 4 ? [1920, 1080] : [640, 480], 1);
const lengths = ({ data, ...view }) => ({
  ...view,
  data: Float32Array.from(data, (value, index) => {
    const [x, y] = ray(view.camera, [index % view.width, Math.floor(index / view.width)]);
    return value * Math.hypot(x, y, 1);
  }),
  unit: unitOf({ data, ...view }),
});
const unitOf = ({ unit, data }) => unit ?? (data instanceof Uint16Array ? 0.001 : 1);
const inUnit = (factor) => depth((view) => ({ ...view, unit: factor * unitOf(view) }));
const turned = (quarters) => (view) => rotated(view, quarters, false);
const mirrored = (view) => rotated(view, 0, true);

/** Mistakes and the readings that name them. With symmetric intrinsics, a rotated picture is the same as a rotated camera. */
export const CONFUSIONS = {
  inverse: [(rig) => ({ ...rig, pose: inverse(rig.pose) }), ["inverse"]],
  "rotation transposed": [withRotation(transpose), ["transposed-rotation"]],
  "place of the colour camera": [
    ofPose(({ rotation, translation }) => [rotation, inverse(poseOf(rotation, translation)).translation]),
    ["camera-centre"],
  ],
  "w x y z read as x y z w": [
    withRotation((rotation) => {
      const [x, y, z, w] = quaternionOf(rotation);
      return ofQuaternion([w, x, y, z]);
    }),
    ["scalar-first"],
  ],
  "x y z w read as w x y z": [
    withRotation((rotation) => {
      const [x, y, z, w] = quaternionOf(rotation);
      return ofQuaternion([y, z, w, x]);
    }),
    ["scalar-last"],
  ],
  "both frames with body axes": [
    ofPose(({ rotation, translation }) => [product(product(BODY, rotation), transpose(BODY)), turn(BODY, translation)]),
    ["body-frames"],
  ],
  "depth frame with body axes": [withRotation((rotation) => product(rotation, transpose(BODY))), ["body-depth"]],
  "colour frame with body axes": [
    ofPose(({ rotation, translation }) => [product(BODY, rotation), turn(BODY, translation)]),
    ["body-colour"],
  ],
  "translation in millimetres": [times(1000), ["millimetres"]],
  "translation in metres read as millimetres": [times(0.001), ["metres"]],
  "radians read as degrees": [
    withRotation((rotation) => rotationOf(vectorOf(rotation).map((value) => value * DEGREE))),
    ["radians"],
  ],
  "degrees read as radians": [
    withRotation((rotation) => rotationOf(vectorOf(rotation).map((value) => value / DEGREE))),
    ["degrees"],
  ],
  "depth registered to colour": [
    (rig) => {
      const frames = rig.frames.map((frame) => registered(frame, rig.pose));
      return { ...rig, frames, truth: { frames, pose: poseOf(IDENTITY, [0, 0, 0]) } };
    },
    ["registered"],
  ],
  "image mirrored": [image(mirrored), ["image-mirrored"]],
  "image turned by 90 degrees": [image(turned(1)), ["image-quarter-turn", "quarter-turn"]],
  "image turned by 180 degrees": [image(turned(2)), ["image-half-turn", "half-turn"]],
  "image turned by 270 degrees": [image(turned(3)), ["image-quarter-back", "quarter-back"]],
  "depth map mirrored": [depth(mirrored), ["depth-mirrored"]],
  "depth map turned by 90 degrees": [depth(turned(1)), ["depth-quarter-turn"]],
  "depth map turned by 180 degrees": [depth(turned(2)), ["depth-half-turn"]],
  "depth map turned by 270 degrees": [depth(turned(3)), ["depth-quarter-back"]],
  "colour intrinsics of another size": [image(otherSize), ["image-resized"]],
  "colour intrinsics of another shape": [image(otherShape), ["image-resized", "image-cropped"]],
  "depth intrinsics of another size": [depth(otherSize), ["depth-resized"]],
  "depths along the rays": [depth(lengths), ["ray-length"]],
  "depth in millimetres read as metres": [inUnit(1000), ["depth-millimetres", "unit"]],
  "depth in metres read as millimetres": [inUnit(0.001), ["depth-metres", "unit"]],
};

/**
 * The projections of some points of the depth map into the image under a pose. `numbers` are the indices of their pixels before any
 * rotation of the map.
 */
function pixels({ image, depth }, pose, numbers) {
  return numbers.map((index) => {
    const at = depth.from ? depth.from.indexOf(index) : index;
    const z = depth.data[at] * unitOf(depth);
    if (!(z > 0)) return undefined;
    const [x, y] = ray(depth.camera, [at % depth.width, Math.floor(at / depth.width)]);
    const point = moved(pose, [x * z, y * z, z]);
    return point[2] > 0 ? project(image.camera, point) : [Infinity, Infinity];
  });
}

/** The median shift, in image pixels, by which a mistake moves some points of the scene. */
function motion(right, wrong) {
  const STRIDE = 997;
  const truth = wrong.truth ?? right;
  const [one, other] = [truth.frames[0], wrong.frames[0]];
  const count = one.depth.data.length;
  const numbers = Array.from({ length: Math.floor(count / STRIDE) }, (_, k) => k * STRIDE);
  const [from, to] = [pixels(one, truth.pose, numbers), pixels(other, wrong.pose, numbers)];
  const place = other.image.place ?? ((pixel) => pixel);
  const distances = from.flatMap((pixel, k) => {
    if (!pixel || !to[k]) return [];
    const told = place(pixel);
    const distance = Math.hypot(told[0] - to[k][0], told[1] - to[k][1]);
    return [Number.isNaN(distance) ? Infinity : distance];
  });
  return quantile(distances, 0.5);
}

const limit = ({ frames: [{ image }] }) => PASSES * Math.max(1, image.width / 640);

/** The frames as the package takes them. */
const bare = ({ frames }) =>
  frames.map((frame) => ({ ...frame, image: withoutPlaces(frame.image), depth: withoutPlaces(frame.depth) }));
const withoutPlaces = ({ place: _, from: __, ...view }) => view;

/** The mistake that the first sentence of a report names: a reading, or the unit of the depths. */
const named = ({ reading, code, warnings }) =>
  reading ?? (code === "doubtful" && warnings[0].code === "unusual-depths" ? "unit" : undefined);

/** The reading that names each mistake, on each rig. Mistakes that move the scene by less than the largest passing error are left out. */
export async function confused(rigs, names, { check, progress }) {
  const rows = [];
  for (const rig of rigs) {
    for (const name of names) {
      const [change, readings] = CONFUSIONS[name];
      const wrong = change(rig);
      const pixels = motion(rig, wrong);
      if (!(pixels > limit(rig))) {
        rows.push({ rig: rig.name, name, pixels, isSmall: true });
        continue;
      }
      const report = await check(bare(wrong), { told: wrong.pose });
      const said = named(report);
      rows.push({
        ...{ rig: rig.name, name, pixels, said, isNamed: readings.includes(said) },
        ...{ verdict: report.verdict, code: report.code, reason: report.reason },
      });
    }
    progress(rig.name);
  }
  return rows;
}

export function printConfused(rows) {
  console.log("\nmistake                                        named   too small   otherwise");
  for (const name of new Set(rows.map((row) => row.name))) {
    const own = rows.filter((row) => row.name === name);
    const some = own.filter(({ isSmall }) => !isSmall);
    const others = some.filter(({ isNamed }) => !isNamed).map(({ rig, said, code }) => `${rig}: ${said ?? code}`);
    const count = `${some.length - others.length} of ${some.length}`;
    console.log(
      `${name.padEnd(45)}  ${count.padEnd(8)}${String(own.length - some.length).padEnd(10)}  ${others.join("; ")}`,
    );
  }
  const some = rows.filter(({ isSmall }) => !isSmall);
  const named = some.filter(({ isNamed }) => isNamed).length;
  console.log(`Named in the first sentence: ${named} of ${some.length} (${percent(named, some.length)}; aim: 90 %).`);
}

/** The mistake that a check names for right rigs. */
export async function right(rigs, { check, progress }) {
  const rows = [];
  for (const rig of rigs) {
    const report = await check(rig.frames, { told: rig.pose });
    rows.push({ rig: rig.name, verdict: report.verdict, code: report.code, said: named(report) });
    progress(rig.name);
  }
  return rows;
}

export function printRight(rows) {
  const misnamed = rows.filter(({ said }) => said);
  console.log(`\nMistakes named for right rigs: ${misnamed.length} of ${rows.length} (aim: at most 1 %).`);
  for (const { rig, said, code } of misnamed) console.log(`  ${rig}: ${said} (${code})`);
}

/** Smallest and largest errors of candidates that are off, but not misread. Errors are drawn evenly on a logarithmic scale. */
const OFF = { degrees: [1, 10], millimetres: [10, 100] };

/** The reading that a check names for candidates that are merely off. */
export async function merelyOff(rigs, { check, progress }) {
  const rows = [];
  for (const [index, rig] of rigs.entries()) {
    const { uniform, direction } = chance(7000 + index);
    const [degrees, millimetres] = [OFF.degrees, OFF.millimetres].map(
      ([least, most]) => least * (most / least) ** uniform(),
    );
    const told = wrong(rig.pose, { degrees, millimetres }, direction);
    const report = await check(rig.frames, { told });
    rows.push({
      ...{ rig: rig.name, degrees, millimetres, verdict: report.verdict, code: report.code, said: named(report) },
      reason: report.reason,
    });
    progress(rig.name);
  }
  return rows;
}

export function printOff(rows) {
  const misnamed = rows.filter(({ said }) => said);
  const off = rows.filter(({ verdict }) => verdict === "off").length;
  console.log(`\nCandidates that are merely off: ${rows.length}, called off ${percent(off, rows.length)};`);
  console.log(`called misread ${misnamed.length} (${percent(misnamed.length, rows.length)}; aim: below 2 %).`);
  for (const { rig, said, degrees, millimetres } of misnamed)
    console.log(`  ${rig}, ${degrees.toFixed(1)} degrees and ${millimetres.toFixed(0)} mm off: ${said}`);
}
