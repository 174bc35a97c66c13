// The members of the public contract that the scenes must use. Each must occur in several scenes, or the list of scenes is incomplete.

/** Number of scenes in which each member must occur. */
const LEAST = 3;

const under = (path, ...names) => names.map((name) => `${path}${name}`);

/** Every method that can determine a run's pose. */
export const ENGINES = [
  "photometric registration",
  "local contrast",
  "silhouettes",
  "surfaces",
  "initial pose kept",
  "held pose",
];

/** Members and values as `namesOf` spells them. Defaults are not listed, because every scene that leaves them out uses them. */
const MEMBERS = [
  ...under("sample.surface", ": bust", ": vase", ": ripples", ".heights"),
  ...under("sample.light", ": colourful", ": window", ": overcast", " of 27 numbers"),
  ...under("sample.", "size", "height", "protocol: grid", "angles.alpha", "angles.beta", "angles.gamma"),
  ...under("sample.", "scale", "overlap", "noise", "depthNoise", "holes", "seed"),
  ...under("image.", "width", "height", "mask", "camera.fx", "camera.distortion", "transfer: srgb", "transfer: linear"),
  ...under("image.data: ", "Uint8Array", "Uint8ClampedArray", "Uint16Array", "Float32Array"),
  ...under("depth.", "width", "height", "mask", "camera.fx", "camera.distortion", "unit", "points", "normals"),
  ...under("depth.data: ", "Float32Array", "Uint16Array"),
  ...under("options.light", " of 27 numbers"),
  ...under("options.startTolerance.", "degrees", "distance"),
  ...under("options.start", ": identity", ".scale", ".rotation", ".translation", ".angles"),
  ...under("options.", "scale", "registration: icp", "registration: fixed", "shading: pixel"),
  ...under("options.lambda.", "prior", "unit", "light", "refinement"),
  ...under(
    "options.",
    "annealing",
    "stopDegrees",
    "tolerance",
    "correspondenceDistance",
    "maxIterations",
    "seed",
    "trim",
    "workers",
  ),
  ...under("driven by ", "run", "step", "stage", "time", "stop", "reset"),
  ...under("albedo.", "seed", "stripes"),
  ...under("ended by ", ...ENGINES),
];

/** "path.to.member", with the value of a word, the type of an array, the length of a light. */
function namesOf(path, value) {
  if (typeof value === "string") return [path, `${path}: ${value}`];
  if (ArrayBuffer.isView(value) || Array.isArray(value)) {
    return [path, `${path}: ${value.constructor.name}`, `${path} of ${value.length} numbers`];
  }
  if (typeof value !== "object") return [path];
  return [path, ...Object.entries(value).flatMap(([key, member]) => namesOf(`${path}.${key}`, member))];
}

/** The members that a scene uses. */
export function usesOf({ request = {}, image, depth, albedo = {} }, options, way, endedBy) {
  const used = Object.entries({ sample: request, image, depth, options, albedo }).flatMap(([path, value]) =>
    namesOf(path, value),
  );
  const driven = `driven by ${typeof way === "string" ? way : Object.keys(way)[0]}`;
  const all = new Set([...used, driven, `ended by ${endedBy}`]);
  return MEMBERS.filter((member) => all.has(member));
}

/** Members that too few scenes use, with their number. */
export function neglected(uses) {
  const counts = MEMBERS.map((member) => ({ member, count: uses.filter((used) => used.includes(member)).length }));
  return counts.filter(({ count }) => count < LEAST);
}
