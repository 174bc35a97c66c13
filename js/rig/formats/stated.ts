/** The lens models that the members of objects state. */
import { lensNamed } from "./lenses.js";
import { member } from "./names.js";
import { type Node, matrixOf, numberOf } from "./numbers.js";

/** Largest number of letters of a name. */
const LONGEST = 80;

/** Members that name the lens of a camera and nothing else. */
const LENS_KEYS = ["distortionmodel", "distortiontype", "lensmodel", "lenstype", "projectionmodel", "projectiontype"];
/** Members that may name the camera's product instead of its lens. */
const MODEL_KEYS = ["model", "cameramodel", "cammodel", "modeltype", "cameratype", "camtype"];
const KIND_KEYS = ["lens", "type", "name"];

const textsAt = (node: Node, keys: string[]): string[] =>
  keys.flatMap((key) => {
    const value = member(node, key);
    return typeof value === "string" && value.trim() !== "" ? value.slice(0, LONGEST) : [];
  });

const first = (node: Node, key: string): number => {
  const value = member(node, key);
  return numberOf(value) ?? matrixOf(value)?.values[0] ?? 0;
};

/** Parameters that only lenses other than Brown's and Kannala-Brandt's have, as a name of the table. */
function parametersOf(node: Node): string | undefined {
  if (first(node, "xi") !== 0 || first(node, "xi1") !== 0) return first(node, "alpha") === 0 ? "xi" : "xi alpha";
  if (member(node, "mirrorparameters", "mirrorparameter") !== undefined) return "mirror_parameters";
  const isBoth = ["alpha", "beta"].every((key) => first(node, key) !== 0);
  return isBoth ? "alpha beta" : undefined;
}

/** A lens model that an object states. */
export interface Stated {
  model: string;
  /** Whether the name cannot be that of a product. */
  isLens: boolean;
}

/** The lens model of an object with a camera. If one of several is not supported, that one counts, such as "omni" beside "radtan". */
export function modelIn(node: Node): Stated | undefined {
  const isFisheye =
    Number(member(node, "fisheyemodel")) === 1 || member(node, "fisheye", "isfisheye", "usefisheye") === true;
  if (isFisheye) return { model: "fisheye", isLens: true };
  const [lenses, models, kinds] = [LENS_KEYS, MODEL_KEYS, KIND_KEYS].map((keys) => textsAt(node, keys));
  const known = [...(kinds ?? [])].filter((name) => lensNamed(name).family !== undefined);
  const said = [...(lenses ?? []), ...known, ...(models ?? [])];
  const model = said.find((name) => lensNamed(name).family === "other") ?? parametersOf(node) ?? said[0];
  if (model === undefined) return undefined;
  return { model, isLens: lenses?.includes(model) === true || lensNamed(model).family !== undefined };
}

/** The lens model that an object without a camera states for the cameras around it, such as ORB-SLAM's "Camera.type". */
export function sharedModelIn(node: Node): string | undefined {
  const names = textsAt(node, [...LENS_KEYS, ...MODEL_KEYS.slice(1)]);
  return names.find((name) => lensNamed(name).family !== undefined) ?? (first(node, "xi") !== 0 ? "xi" : undefined);
}
