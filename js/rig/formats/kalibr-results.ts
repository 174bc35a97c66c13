/**
 * Kalibr's results-cam.txt: the cameras with their projections and lenses, and the baselines between neighbours.
 *
 * The quaternion x y z w of a baseline is in the convention of Kalibr's library sm_kinematics (JPL), whose rotation is the transpose of
 * Hamilton's for the same numbers.
 */
import { sideOf } from "../assign.js";
import type { RawCamera } from "./cameras.js";
import { Findings } from "./findings.js";
import { type Numbers, numberOf, transposed } from "./numbers.js";
import { ofQuaternion } from "./poses.js";

const HEAD = 5000;
/** Longest part of the text about one camera or baseline. */
const LONGEST = 3000;
const MOST_PARTS = 200;
/** Placeholder pixels for a camera that is refused because of its model. */
const PLACEHOLDER = [100, 100];

export const isKalibrResults = (text: string): boolean =>
  /^[ \t]*(?:cam\d{1,3} \(.{0,200}\):|baseline T_\d{1,3}_\d{1,3}:)\s*$/m.test(text.slice(0, HEAD)) &&
  /^[ \t]*(?:projection|q): *\[/m.test(text);

/** The numbers in brackets behind a name; numpy breaks long lists into lines. */
function listed(part: string, name: string): Numbers | undefined {
  const inner = new RegExp(String.raw`^[ \t]*${name}: *\[([^\]]{1,1000})\]`, "m").exec(part)?.[1];
  const numbers = inner
    ?.trim()
    .split(/[\s,]+/)
    .map(numberOf);
  return numbers?.every((each) => each !== undefined) === true ? numbers : undefined;
}

/** A camera by the class of its geometry, whose name holds the projection and the lens. */
function cameraOf(name: string, part: string): RawCamera {
  const [type = ""] = /[A-Za-z]+(?=CameraGeometry)/.exec(part) ?? [];
  const [fx = NaN, fy = NaN, cx = NaN, cy = NaN, ...more] = listed(part, "projection") ?? [];
  // Other projections begin with further parameters, but their cameras are refused by type.
  const values = { focal: [fx, fy], centre: [cx, cy], distortion: listed(part, "distortion") };
  if (/^Distorted(?:Pinhole)?$|^Pinhole$/.test(type) && more.length === 0) return { name, ...values, model: "radtan" };
  if (type === "EquidistantDistortedPinhole") return { name, ...values, model: "equidistant" };
  const model = type === "" ? "a type that is not given" : type;
  return { name, focal: PLACEHOLDER, centre: PLACEHOLDER, distortion: [1], model };
}

export function readKalibrResults(text: string): Findings {
  const found = new Findings();
  const parts = text.split(/^[ \t]*(?=(?:cam\d{1,3} \(|baseline T_))/m, MOST_PARTS).slice(1);
  for (const part of parts.map((each) => each.slice(0, LONGEST))) {
    const [, name, topic = ""] = /^(cam\d+) \((.*?)\):/.exec(part) ?? [];
    const [, to, from] = /^baseline T_(\d+)_(\d+):/.exec(part) ?? [];
    if (name !== undefined) found.camera(cameraOf(name, part), sideOf(topic.replaceAll("/", " ")));
    const [q, t] = [listed(part, "q"), listed(part, "t")];
    if (to === undefined || q?.length !== 4 || t === undefined) continue;
    const names = { name: `cam${to} from cam${from}`, from: `cam${from}`, to: `cam${to}` };
    found.pose(transposed(ofQuaternion(q, found.warnings), 3), t, names);
  }
  return found;
}
