/**
 * MATLAB's camera and stereo parameters as JSON (jsonencode(toStruct(params))), and the scripts that Bouguet's toolbox saves.
 *
 * MATLAB counts pixels from 1, multiplies row vectors by its matrices (so they are transposed here), and gives sizes as rows by columns.
 * Bouguet's toolbox counts pixels from 0. Poses of calibration boards are not extrinsics.
 */
import { badFile } from "../../errors.js";
import { ofMatrix } from "./cameras.js";
import { Findings, flat } from "./findings.js";
import { lengthOf } from "./names.js";
import { isNode, type Node, type Numbers, numberOf, transposed } from "./numbers.js";
import { ofVector } from "./poses.js";

const listOf = (value: unknown): Numbers => {
  const values = Array.isArray(value) ? value.flat(2) : [value];
  return values.every((each) => typeof each === "number") ? values : [];
};
/** MATLAB's default unit, metres. */
const MILLIMETRE = 1e-3;

const isCamera = (value: unknown): value is Node =>
  isNode(value) &&
  "RadialDistortion" in value &&
  ("IntrinsicMatrix" in value || "FocalLength" in value || "K" in value);
const isStereo = (root: Node): boolean => isCamera(root.CameraParameters1) && isCamera(root.CameraParameters2);
/** The parameters, with or without an object around them that has the variable's name. */
const inner = (root: Node): Node => {
  const values = Object.values(root);
  const [only] = values;
  return values.length === 1 && isNode(only) && (isCamera(only) || isStereo(only)) ? only : root;
};

export const isMatlab = (root: Node): boolean =>
  isCamera(inner(root)) || isStereo(inner(root)) || ("MappingCoefficients" in root && "DistortionCenter" in root);

function camera(found: Findings, node: Node, name: string): void {
  const matrix = flat(node.IntrinsicMatrix, 9);
  const k = flat(node.K, 9) ?? (matrix && transposed(matrix, 3));
  const own = k ? ofMatrix(k) : { focal: listOf(node.FocalLength), centre: listOf(node.PrincipalPoint) };
  const [k1 = 0, k2 = 0, k3 = 0] = listOf(node.RadialDistortion);
  const [p1 = 0, p2 = 0] = listOf(node.TangentialDistortion);
  const [height, width] = listOf(node.ImageSize);
  found.camera({
    ...{ ...own, name, centre: own.centre.map((value) => value - 1) },
    ...{ distortion: [k1, k2, p1, p2, k3], width, height },
  });
}

export function readMatlab(whole: Node): Findings {
  const found = new Findings();
  const root = inner(whole);
  if ("MappingCoefficients" in root)
    throw badFile(
      "it is a fisheye of MATLAB (MappingCoefficients, Scaramuzza's model), which is not supported; undistort the images with undistortFisheyeImage and give their intrinsics",
    );
  if (!isStereo(root)) {
    camera(found, root, "camera");
    return found;
  }
  const first = root.CameraParameters1 as Node;
  camera(found, first, "1");
  camera(found, root.CameraParameters2 as Node, "2");
  const unit = lengthOf(String(first.WorldUnits ?? root.WorldUnits ?? "mm")) ?? MILLIMETRE;
  const names = { name: "2 from 1", from: "1", to: "2" };
  const newer = isNode(root.PoseCamera2) ? root.PoseCamera2 : {};
  const rows = flat(root.RotationOfCamera2, 9);
  const [r, t] = rows
    ? [transposed(rows, 3), listOf(root.TranslationOfCamera2)]
    : [flat(newer.R, 9), listOf(newer.Translation)];
  if (r)
    found.pose(
      r,
      t.map((value) => value * unit),
      names,
    );
  return found;
}

const ENTRY = /^[ \t]*([A-Za-z]\w{0,40})[ \t]*=[ \t]*(?:\[([^\]%]{0,600})\]|([^;[\n%]{1,60}))[ \t]*;/gm;

export const isBouguet = (text: string): boolean =>
  /^[ \t]*fc(?:_left)?[ \t]*=[ \t]*\[/m.test(text) && /^[ \t]*cc(?:_left)?[ \t]*=[ \t]*\[/m.test(text);

/** `Calib_Results.m` and `Calib_Results_stereo.m`. */
export function readBouguet(text: string): Findings {
  const found = new Findings();
  const entries = new Map<string, Numbers>();
  for (const [, key = "", list, single = ""] of text.replace(/%.*$|\.\.\.[ \t]*$/gm, "").matchAll(ENTRY)) {
    const numbers = (list ?? single)
      .trim()
      .split(/[\s;,]+/, 20)
      .map(numberOf);
    if (numbers.every((each) => each !== undefined)) entries.set(key, numbers);
  }
  const [width, height] = [entries.get("nx")?.[0], entries.get("ny")?.[0]];
  for (const suffix of ["", "_left", "_right"]) {
    const [focal, centre] = [entries.get(`fc${suffix}`), entries.get(`cc${suffix}`)];
    if (focal === undefined || centre === undefined) continue;
    found.camera({
      ...{
        name: suffix === "" ? "camera" : suffix.slice(1),
        focal,
        centre,
        distortion: entries.get(`kc${suffix}`) ?? [],
      },
      ...{ skew: (entries.get(`alpha_c${suffix}`)?.[0] ?? 0) * (focal[0] ?? 0), width, height },
    });
  }
  const [om, t] = [entries.get("om"), entries.get("T")];
  if (om?.length === 3 && t?.length === 3) {
    // The toolbox expects the board's squares in millimetres. A baseline below two is therefore in metres.
    const unit = Math.hypot(...t) > 2 ? 1e-3 : 1;
    found.pose(
      ofVector(om),
      t.map((value) => value * unit),
      { name: "right from left", from: "left", to: "right" },
    );
    found.warn(
      "translation-unit-guessed",
      `The translation has the unit of the board's squares, which was guessed to be ${unit === 1 ? "metres" : "millimetres"}.`,
    );
  }
  if ([...entries.keys()].some((key) => /^(?:omc|Tc)_\d+$/.test(key)))
    found.warn(
      "pose-left-out",
      "The poses of the calibration board are not extrinsics between two cameras and were left out.",
    );
  return found;
}
