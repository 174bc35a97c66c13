/**
 * Autoware's sensor_kit_calibration.yaml and sensors_calibration.yaml: x y z roll pitch yaw of each child frame in its parent, in metres and
 * radians, about fixed axes as in URDF.
 */
import { endsOf } from "./filename.js";
import { Findings } from "./findings.js";
import { isNode, type Node, numberOf, numbersAt } from "./numbers.js";
import { ofYawPitchRoll } from "./poses.js";
import { toCameras } from "./urdf.js";

const PLACE = ["x", "y", "z"];
const TURN = ["yaw", "pitch", "roll"];
const KEYS = [...PLACE, ...TURN];

const isPlace = (value: unknown): value is Node =>
  isNode(value) &&
  KEYS.every((key) => numberOf(value[key]) !== undefined) &&
  !Object.keys(value).some((key) => /unit|deg/i.test(key));

/** Whether all children of a parent frame have this form. */
export const isAutoware = (root: Node): boolean =>
  Object.values(root).some((each) => {
    if (!isNode(each)) return false;
    const names = Object.keys(each);
    // A name that contains two frames names a pose, not a frame.
    return names.length > 0 && names.every((name) => isPlace(each[name]) && endsOf(name) === undefined);
  });

export function readAutoware(root: Node): Findings {
  const found = new Findings();
  for (const [to, children] of Object.entries(root)) {
    if (!isNode(children)) continue;
    for (const [from, place] of Object.entries(children)) {
      if (!isPlace(place)) continue;
      const turn = numbersAt(place, TURN);
      const isDegrees = turn.some((angle) => Math.abs(angle) > 2 * Math.PI);
      if (isDegrees) found.warn("pose-assumed", `The angles of ${from} are larger than 2 pi and were read as degrees.`);
      const radians = isDegrees ? turn.map((angle) => (angle * Math.PI) / 180) : turn;
      found.pose(ofYawPitchRoll(radians), numbersAt(place, PLACE), {
        name: `${to} from ${from}`,
        from,
        to,
      });
    }
  }
  toCameras(found);
  return found;
}
