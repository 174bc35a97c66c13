/** Cameras, poses and strange files in plain words. */
import { type BimodalError, badFile } from "../errors.js";
import type { NamedCamera, NamedPose } from "./types.js";

const digits = (value: number): string => Number(value.toPrecision(5)).toString();
/** How many are described one by one. */
const FEW = 4;

function lens({ camera: { model, distortion } }: NamedCamera): string {
  if (model === "fisheye") return "fisheye";
  return distortion === undefined ? "no distortion" : `Brown's distortion with ${distortion.length} numbers`;
}

function ofCamera(each: NamedCamera): string {
  const { fx, fy, cx, cy } = each.camera;
  const size = each.width === undefined ? "" : `${each.width}x${each.height}, `;
  return `${each.name === undefined ? "" : `${each.name}: `}${size}fx ${digits(fx)} fy ${digits(fy)} cx ${digits(cx)} cy ${digits(cy)}, ${lens(each)}`;
}

/** The turn of a rotation, degrees. */
const turn = (r: number[]): number =>
  (Math.acos(Math.min(1, Math.max(-1, ((r[0] ?? 0) + (r[4] ?? 0) + (r[8] ?? 0) - 1) / 2))) * 180) / Math.PI;

function ofPose({ name, from, to, pose }: NamedPose): string {
  const called =
    from !== undefined && to !== undefined ? `from ${from} to ${to}: ` : name === undefined ? "" : `${name}: `;
  return `${called}${turn(pose.rotation).toFixed(2)} degrees, ${(1000 * Math.hypot(...pose.translation)).toFixed(1)} mm`;
}

function listed<T>(all: T[], one: string, many: string, say: (each: T) => string): string[] {
  if (all.length === 0) return [];
  const head = all.length === 1 ? one : `${all.length} ${many}`;
  return [`${head} (${all.slice(0, FEW).map(say).join("; ")}${all.length > FEW ? "; .." : ""})`];
}

export const inWords = (cameras: NamedCamera[], poses: NamedPose[]): string =>
  [...listed(cameras, "a camera", "cameras", ofCamera), ...listed(poses, "a pose", "poses", ofPose)].join(", ");

/** First bytes of formats that are not read, what to do about them, and whether they are pictures, which a browser may read. */
const STRANGE: [pattern: RegExp, advice: string, isPicture?: true][] = [
  [/^GIF8/, "a GIF; save it as PNG", true],
  [/^BM/, "a BMP; save it as PNG", true],
  [/^PK\x03\x04/, "a ZIP archive (.npz is one); unpack it first"],
  [/^\x1f\x8b/, "compressed by gzip; unpack it first"],
  [/^\x89HDF/, "HDF5; save the array as .npy"],
  [/^MATLAB/, "a .mat file of MATLAB; save the array as .npy or 16-bit PNG"],
  [/^.{4}ftyp(?:heic|heix|mif1|avif)/s, "HEIC or AVIF; save it as PNG or JPEG", true],
  [/^(?:.{4}ftyp|RIFF.{4}AVI )/s, "a video; save its frames as PNG"],
  [
    /^#ROSBAG|^\x89MCAP/,
    "a recording of ROS (MCAP, or a bag); drop it on the page's check of a rig, or read it with openRecording of bimodal-stereo/rig-recordings",
  ],
  [
    /^SQLite format/,
    "a recording of ROS 2 in SQLite (.db3); `ros2 bag convert` writes it as MCAP (storage_id: mcap), which is read",
  ],
  [/^%PDF/, "a PDF"],
  [/^\x80[\x02-\x05]/, "a pickle of Python, which may run code; save the array by numpy.save"],
  [/^\xff\x4f\xff\x51|^.{4}jP {2}/s, "JPEG 2000; save it as PNG", true],
];

/** The error about a file of a format that is not read, with what it seems to be. */
export function strange(bytes: Uint8Array): BimodalError {
  const head = String.fromCharCode(...bytes.subarray(0, 16));
  const [, advice, isPicture] = STRANGE.find(([pattern]) => pattern.test(head)) ?? [];
  if (advice === undefined) return badFile("its format is not known here");
  return badFile(`it is ${advice}`, undefined, isPicture && { problem: "picture" });
}
