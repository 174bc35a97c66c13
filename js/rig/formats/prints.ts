/** Objects as programs print them: Swift's simd matrices, ROS's messages in Python and as a table, Orbbec's SDK in Python. */
import { badFile } from "../../errors.js";
import { ofMatrix } from "./cameras.js";
import { Findings } from "./findings.js";
import { type Node, type Numbers, numberOf, transposed } from "./numbers.js";
import { ofQuaternion } from "./poses.js";

const MOST = 1000;
const numbersIn = (text: string): Numbers => text.split(/[\s,;[\]()]+/, 64).flatMap((part) => numberOf(part) ?? []);

const SIMD = /simd_(?:float|double)([34])x([34])\(\[?((?:\s*\[[^[\]]{1,200}\],?){3,4})\s*\]?\)/g;

export const isSimd = (text: string): boolean => /^[^{]{0,200}?simd_(?:float|double)[34]x[34]\(/.test(text);

/** print() of a matrix of Apple's simd, column by column: intrinsics of 3x3, or a pose of 4x4 with ARKit's axes. */
export function readSimd(text: string): Findings {
  const found = new Findings();
  for (const [, columns, rows, body = ""] of text.matchAll(SIMD)) {
    const values = numbersIn(body);
    if (columns !== "3" || rows !== "3" || values.length !== 9)
      throw badFile(
        `it has a simd matrix of ${columns}x${rows}; a matrix of intrinsics (3x3) is read, and a pose has to be written as rows of 4x4 with the names of its frames`,
      );
    found.camera({ ...ofMatrix(transposed(values, 3)), name: "camera" });
  }
  return found;
}

const STAMPED = /TransformStamped\(/;
/** The numbers of "Vector3(x=1.0, y=2.0, z=3.0)". */
function members(text: string, name: string, keys: string[]): Numbers {
  const inside = new RegExp(`\\b${name}\\(([^()]{1,300})\\)`).exec(text)?.[1] ?? "";
  return keys.map((key) => numberOf(new RegExp(`\\b${key}\\s*=\\s*([^,\\s]+)`).exec(inside)?.[1]) ?? NaN);
}

export const isStamped = (text: string): boolean => STAMPED.test(text) && /\bQuaternion\(/.test(text);

/** print() of ROS 2's TransformStamped, which carries points of the child frame into the frame of the header. */
export function readStamped(text: string): Findings {
  const found = new Findings();
  for (const part of text.split(STAMPED).slice(1, MOST)) {
    const frame = (key: string) => new RegExp(`\\b${key}\\s*=\\s*['"]([^'"]{1,80})['"]`).exec(part)?.[1];
    const [to, from] = [frame("(?<!child_)frame_id"), frame("child_frame_id")];
    const turn = members(part, "Quaternion", ["x", "y", "z", "w"]);
    if (turn.some(Number.isNaN)) throw badFile("its transform has no quaternion x, y, z, w");
    const names = { ...(from !== undefined && { from }), ...(to !== undefined && { to }) };
    found.pose(ofQuaternion(turn, found.warnings), members(part, "Vector3", ["x", "y", "z"]), names);
  }
  return found;
}

export const isInfoTable = (text: string): boolean => /^%time,.*\bfield\.K0\b/.test(text.slice(0, 4000));

/** `rostopic echo -p` of a CameraInfo: a line of names and a line for each message, which have to agree. */
export function readInfoTable(text: string): Findings {
  const found = new Findings();
  const lines = text.split(/\r?\n/).filter((line) => line.trim() !== "");
  const names = (lines[0] ?? "").split(",");
  const rowOf = (line: string): Node =>
    Object.fromEntries(line.split(",").map((value, at) => [names[at] ?? "", value]));
  const row = rowOf(lines.at(-1) ?? "");
  const list = (name: string) =>
    names.filter((each) => new RegExp(`^field\\.${name}\\d+$`).test(each)).map((each) => numberOf(row[each]) ?? NaN);
  if (lines.length < 2 || list("K").length !== 9) throw badFile("its table has no message with K0 to K8");
  const lensOf = (each: Node) =>
    names
      .filter((name) => /^field\.[DK]\d+$/.test(name))
      .map((name) => each[name])
      .join(" ");
  if (lines.slice(1).some((line) => lensOf(rowOf(line)) !== lensOf(row)))
    throw badFile("its messages have different intrinsics; keep the line of the frames that are checked");
  found.camera({
    ...{ ...ofMatrix(list("K")), name: String(row["field.header.frame_id"] ?? "camera"), distortion: list("D") },
    ...{ model: String(row["field.distortion_model"] ?? "") || undefined },
    ...{ width: numberOf(row["field.width"]), height: numberOf(row["field.height"]) },
  });
  return found;
}
