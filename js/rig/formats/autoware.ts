/**
 * Autoware's sensor_kit_calibration.yaml and sensors_calibration.yaml: of each child frame its x y z roll pitch yaw in the parent's, in
 * metres and rad, about fixed axes as in URDF.
 */
import { endsOf } from "./filename.js";
import { Findings } from "./findings.js";
import { isNode, type Node, numberOf } from "./numbers.js";
import { ofYawPitchRoll } from "./poses.js";
import { toCameras } from "./urdf.js";

const PLACE = ["x", "y", "z"];
const TURN = ["yaw", "pitch", "roll"];
const KEYS = [...PLACE, ...TURN];

const isPlace = (value: unknown): value is Node =>
  isNode(value) &&
  KEYS.every((key) => numberOf(value[key]) !== undefined) &&
  !Object.keys(value).some((key) => /unit|deg/i.test(key));

/** Parents that name children, or children that stand alone. */
export const isAutoware = (root: Node): boolean =>
  Object.values(root).some((each) => {
    if (!isNode(each)) return false;
    const names = Object.keys(each);
    // A name of two frames is that of a pose, and not of a frame.
    return names.length > 0 && names.every((name) => isPlace(each[name]) && endsOf(name) === undefined);
  });

export function readAutoware(root: Node): Findings {
  const found = new Findings();
  for (const [to, children] of Object.entries(root)) {
    if (!isNode(children)) continue;
    for (const [from, place] of Object.entries(children)) {
      if (!isPlace(place)) continue;
      const numbers = (keys: string[]) => keys.map((key) => numberOf(place[key]) ?? NaN);
      const turn = numbers(TURN);
      if (turn.some((angle) => Math.abs(angle) > 2 * Math.PI))
        found.warn("pose-assumed", `The angles of ${from} are larger than a turn; they were read as degrees.`);
      const isDegrees = turn.some((angle) => Math.abs(angle) > 2 * Math.PI);
      found.pose(ofYawPitchRoll(isDegrees ? turn.map((angle) => (angle * Math.PI) / 180) : turn), numbers(PLACE), {
        name: `${to} from ${from}`,
        from,
        to,
      });
    }
  }
  toCameras(found);
  return found.done("a sensor kit's calibration of Autoware");
}
