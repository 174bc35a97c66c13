// Pairs of two pinhole cameras: makes them, runs them from an inaccurate initial pose or from none, and measures the errors.
import { chance, drawGaussian, seedOf } from "./numbers.mjs";
import { meshOf, middleOf, moved, pointAt, seen, shade, times } from "./perspective.mjs";
import { IDENTITY, aboutAxis, aboutY, degreesBetween, offBy, product, transpose, turn } from "./rotations.mjs";
import { judged, optionsOf, withRun } from "./runs.mjs";

/** Distance, in metres, above which neighbouring points of a depth map belong to different parts. */
const JUMP = 0.01;
/** Side of the raster for a surface's mesh, and the smallest jump in depth that the mesh does not bridge, in samples. */
const RASTER = 256;
const RELIEF_JUMP = 12;
/** Limits of a pinhole scene, degrees. */
const MOST_TILT = 50;
const MOST_ROLL = 15;

function direction({ gaussian }) {
  const vector = [gaussian(), gaussian(), gaussian()];
  return times(vector, 1 / Math.hypot(...vector));
}

/** The pose that rotates about a point of the depth camera's frame and takes it to a place, or leaves it in place. */
const about = (middle, rotation, place = middle) => ({
  rotation,
  translation: place.map((value, axis) => value - turn(rotation, middle)[axis]),
});

/** An initial pose that is rotated about the depth camera and shifted; the seed follows from the cell's name. */
function startOff(truth, { degrees, metres }, name) {
  const dice = chance(seedOf(name));
  const rotation = product(truth.rotation, aboutAxis(direction(dice), degrees));
  const shift = times(direction(dice), metres);
  return { scale: 1, rotation, translation: truth.translation.map((value, axis) => value + shift[axis]) };
}

/** Errors of the object's middle and of its rotation, within the image plane and perpendicular to it. */
function offsets(pose, truth, middle) {
  const [x, y, z] = moved(pose, middle).map((value, axis) => 1000 * (value - moved(truth, middle)[axis]));
  const turned = offBy(pose.rotation, truth.rotation);
  const translation = Math.hypot(...pose.translation.map((value, axis) => 1000 * (value - truth.translation[axis])));
  return {
    lateral: Math.hypot(x, y),
    along: Math.abs(z),
    inPlane: Math.abs(turned[2]),
    tilt: Math.hypot(turned[0], turned[1]),
    translation,
  };
}

export function run(cell, api, { image, depth, truth }) {
  const middle = middleOf(depth);
  const start = cell.off ? startOff(truth, cell.off, cell.id) : null;
  const options = optionsOf({ ...cell.options, ...(start ? { start } : {}) }, {});
  return withRun(api, { image, depth }, options, (report, _, milliseconds) => ({
    ...judged(report, truth, milliseconds),
    ...offsets(report.pose, truth, middle),
    told: start && { degrees: degreesBetween(start.rotation, truth.rotation), ...offsets(start, truth, middle) },
    translationOff: report.pose.translation.map((value, axis) => value - truth.translation[axis]),
    translationSigmas: report.uncertainty?.translation ?? null,
  }));
}

/** The depth of a capture as seen from `degrees` further left, about the object's middle. */
function seenFrom(depth, _degrees, truth) {
  const { width, height, data, camera, unit, mask } = depth;
  const points = Array.from(data, (value, index) =>
    value > 0 && mask[index] ? pointAt(camera, [index % width, Math.floor(index / width)], value * unit) : null,
  );
  const back = {
    rotation: transpose(truth.rotation),
    translation: times(turn(transpose(truth.rotation), truth.translation), -1),
  };
  const again = seen(meshOf(width, points, JUMP), camera, { width, height }, back).depth;
  return { width, height, camera, data: again, mask: Uint8Array.from(again, (value) => Number(value > 0)) };
}

export async function measureCapture(cell, api, library) {
  const { image, depth } = library.capture(cell.capture.name, cell.capture.frame);
  const truth = { scale: 1, ...about(middleOf(depth), aboutY(cell.turned)) };
  return run(cell, api, { image, depth: cell.turned === 0 ? depth : seenFrom(depth, cell.turned, truth), truth });
}

/** A pair of a statue's colour image and depth map, whose true pose the library has. */
export async function measureStatue(cell, api, library) {
  const { view, ...pair } = library.statue(cell.pair);
  return { view, ...(await run(cell, api, pair)) };
}

/** A surface's mesh in metres, `height` high, with its middle at the origin. */
function meshOfSurface(api, library, surface, height) {
  const { depth } = api.sample({
    surface: library.surface(surface),
    light: "colourful",
    size: RASTER,
    angles: { beta: 0 },
  });
  const metres = height / RASTER;
  const points = Array.from(depth.data, (z, index) => {
    const place = [(index % RASTER) - (RASTER - 1) / 2, Math.floor(index / RASTER) - (RASTER - 1) / 2, z];
    return Number.isFinite(z) && z > 0 ? times(place, metres) : null;
  });
  const inside = points.filter(Boolean);
  const middle = [0, 1, 2].map((axis) => inside.reduce((sum, point) => sum + point[axis], 0) / inside.length);
  const centred = points.map((point) => point && point.map((value, axis) => value - middle[axis]));
  return meshOf(RASTER, centred, RELIEF_JUMP * metres);
}

/** Two cameras as the files state them: one of them, at random, has a focal length that is wrong by a share in the given range. */
function misstated(camera, [least, most], dice) {
  const factor = 1 + (dice.below(2) === 1 ? 1 : -1) * dice.uniform(least, most);
  const other = { ...camera, fx: factor * camera.fx, fy: factor * camera.fy };
  return dice.below(2) === 1 ? [other, camera] : [camera, other];
}

/** A rendered pair and its pose. With `nearer`, the depth camera is nearer by a factor in that range. */
export function drawPair(cell, api, library, dice) {
  const { size, height, distance, noise, depthNoise, kit, nearer } = cell;
  const mesh = meshOfSurface(api, library, kit.surfaces[dice.below(kit.surfaces.length)], height);
  const light = library.gaussian
    ? drawGaussian(library.gaussian, dice)
    : api.sample({ surface: "bust", light: kit.naturals[dice.below(kit.naturals.length)], size: 16 }).light;
  const angle = dice.uniform(0, 2 * Math.PI);
  const tilt = aboutAxis([Math.cos(angle), Math.sin(angle), 0], dice.uniform(0, MOST_TILT));
  const rotation = product(tilt, aboutAxis([0, 0, 1], dice.uniform(-MOST_ROLL, MOST_ROLL)));
  const focal = (size.height * distance) / height;
  const camera = { fx: focal, fy: focal, cx: (size.width - 1) / 2, cy: (size.height - 1) / 2 };
  const place = [0, 0, distance];
  const view = seen(mesh, camera, size, { rotation: IDENTITY, translation: place });
  const placeOfDepth = nearer ? [0, 0, distance / dice.uniform(...nearer)] : place;
  const other = seen(mesh, camera, size, { rotation: transpose(rotation), translation: placeOfDepth });
  const isSeen = (index) => view.depth[index] > 0 && view.normals[3 * index + 2] < 0;
  const colours = new Float32Array(3 * view.depth.length);
  for (let index = 0; index < view.depth.length; index++) {
    if (!isSeen(index)) continue;
    const log = shade(light, [...view.normals.subarray(3 * index, 3 * index + 3)]);
    colours.set(
      log.map((value) => Math.exp(value + noise * dice.gaussian())),
      3 * index,
    );
  }
  const mask = Uint8Array.from(view.depth, (_, index) => Number(isSeen(index)));
  const data = other.depth.map((z) => z + depthNoise * dice.gaussian());
  const [said, saidOfDepth] = cell.focalOff ? misstated(camera, cell.focalOff, dice) : [camera, camera];
  return {
    image: { ...size, data: colours, mask, camera: said },
    depth: { ...size, data, camera: saidOfDepth, mask: Uint8Array.from(other.depth, (z) => Number(z > 0)) },
    truth: { scale: 1, ...about(placeOfDepth, rotation, place) },
  };
}

export const measurePinhole = (cell, api, library) => run(cell, api, drawPair(cell, api, library, chance(cell.seed)));
