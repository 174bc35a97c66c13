/** mrcal's .cameramodel: a Python dictionary of one camera, with its pose in the reference frame of the calibration. */
import { badFile } from "../../errors.js";
import { Findings, flat } from "./findings.js";
import type { Node, Numbers } from "./numbers.js";
import { ofVector } from "./poses.js";

export const isMrcal = (root: Node): boolean => typeof root.lensmodel === "string" && Array.isArray(root.intrinsics);
/** The dictionary is not JSON, because it has comments, single quotes and trailing commas. */
export const looksLikeMrcal = (text: string): boolean => /["']lensmodel["']\s*:/.test(text.slice(0, 20_000));

export function readMrcal(root: Node): Findings {
  const found = new Findings();
  const model = String(root.lensmodel).replace(/^LENSMODEL_/, "");
  const count = model === "PINHOLE" ? 0 : /^OPENCV(4|5|8|12)$/.exec(model)?.[1];
  if (count === undefined)
    throw badFile(
      `it is mrcal's cameramodel of the lens ${String(root.lensmodel).slice(0, 60)}, which is not supported; fit LENSMODEL_OPENCV8 to it with mrcal-convert-lensmodel`,
    );
  const values = root.intrinsics as Numbers;
  if (values.length !== 4 + Number(count) || !values.every((value) => typeof value === "number"))
    throw badFile(
      `it is mrcal's cameramodel of ${model}, which needs ${4 + Number(count)} intrinsics, but has ${values.length}`,
    );
  const size = flat(root.imagersize, 2);
  found.camera({
    ...{ focal: values.slice(0, 2), centre: values.slice(2, 4), distortion: values.slice(4) },
    ...{ width: size?.[0], height: size?.[1] },
  });
  // A rotation vector and a translation in metres that carry points of the reference frame into the camera; "extrinsics" until mrcal 2.5.
  const six = flat(root.rt_cam_ref ?? root.extrinsics, 6);
  if (six)
    found.pose(ofVector(six.slice(0, 3)), six.slice(3), {
      name: "camera from reference",
      from: "reference",
      to: "camera",
    });
  return found;
}
