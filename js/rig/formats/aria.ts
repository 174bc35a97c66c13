/** The calibration in recordings of Project Aria's glasses: cameras in the frame of the device, quaternions as [w, [x, y, z]]. */
import { Findings, flat } from "./findings.js";
import { isNode, type Node, type Numbers, nodesOf, numberOf } from "./numbers.js";
import { ofScalarFirst } from "./poses.js";

const cameras = (root: Node): Node[] => nodesOf(root.CameraCalibrations);
const projection = (camera: Node): Node => (isNode(camera.Projection) ? camera.Projection : {});

export const isAria = (root: Node): boolean => cameras(root).some((camera) => "Params" in projection(camera));

/** The parameters of a model: focal lengths, then the principal point, then the lens. Unsupported models have one focal length. */
function lensOf(name: string, p: Numbers) {
  if (name === "Linear") return { focal: p.slice(0, 2), centre: p.slice(2, 4), model: "pinhole", distortion: [] };
  if (name === "KannalaBrandtK3")
    return { focal: p.slice(0, 2), centre: p.slice(2, 4), model: "fisheye", distortion: p.slice(4, 8) };
  return { focal: p.slice(0, 1), centre: p.slice(1, 3), model: name, distortion: [1] };
}

export function readAria(root: Node): Findings {
  const found = new Findings();
  for (const camera of cameras(root)) {
    const name = String(camera.Label ?? "camera").slice(0, 60);
    const { Name, Params } = projection(camera);
    const params = Array.isArray(Params) ? Params.map((value) => numberOf(value) ?? NaN) : [];
    found.camera({
      ...{ name, ...lensOf(String(Name), params) },
      ...{ width: numberOf(camera.ImageWidth), height: numberOf(camera.ImageHeight) },
    });
    const place = isNode(camera.T_Device_Camera) ? camera.T_Device_Camera : {};
    const q = flat(place.UnitQuaternion, 4);
    const t = flat(place.Translation, 3);
    if (q === undefined || t === undefined) continue;
    found.pose(ofScalarFirst(q, found.warnings), t, { name: `device from ${name}`, from: name, to: "device" });
  }
  return found;
}
