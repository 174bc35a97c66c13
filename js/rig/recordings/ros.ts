/** Messages of ROS as shots, cameras and transforms, the same for every container and for a live connection. */
import { badFile } from "../../errors.js";
import { pictureColour } from "../colour.js";
import { cloudDepth, pictureDepth } from "../depth.js";
import type { Cloud, Picture } from "../formats/picture.js";
import { pointsDepth } from "../scan.js";
import type { ReadOptions } from "../types.js";
import { turned } from "./axes.js";
import { compressed, compressedDepth, isCompressedDepth } from "./compressed.js";
import { type Message, bytesIn, frameOf, numberIn, stampOf, textIn } from "./messages.js";
import { type Stored, isKnown, pixels } from "./pixels.js";
import { cloudOf, isScan, scanOf } from "./points.js";
import type { Content, Shot, ShotOptions, TrackKind } from "./source.js";

/** What a type's messages are: "sensor_msgs/Image" in ROS 1, "sensor_msgs/msg/Image" in ROS 2. */
export function kindOfType(type: string): TrackKind {
  switch (type.replace("/msg/", "/")) {
    case "sensor_msgs/Image":
    case "sensor_msgs/CompressedImage":
      return "picture";
    case "sensor_msgs/PointCloud2":
      return "cloud";
    case "sensor_msgs/CameraInfo":
      return "camera";
    case "tf2_msgs/TFMessage":
    case "tf/tfMessage":
      return "transforms";
    default:
      return "other";
  }
}

/** ROS's own rule (REP 118): integers are millimetres, floats are metres. */
const unitOf = (picture: Picture): number => (picture.data instanceof Float32Array ? 1 : 0.001);

/** A picture as what it is wanted for. */
export function ofPicture(picture: Picture, { as, unit }: ReadOptions): Content {
  if (as !== "depth") return pictureColour(picture);
  if (picture.data instanceof Uint8Array)
    throw badFile(`its pictures are of 8 bits (${picture.format}), which is no depth`);
  return pictureDepth(picture, { unit: unit ?? picture.unit ?? unitOf(picture) });
}

const storedOf = (message: Message): Stored => ({
  width: numberIn(message, "width"),
  height: numberIn(message, "height"),
  step: numberIn(message, "step"),
  encoding: textIn(message, "encoding"),
  isBigEndian: numberIn(message, "is_bigendian") === 1,
  data: bytesIn(message, "data"),
});

/** The format in a compressed picture's message, in few words: "16UC1; compressedDepth png" is "compressedDepth". */
function formatOf(message: Message): string {
  const format = textIn(message, "format");
  if (isCompressedDepth(format)) return "compressedDepth";
  return /jpe?g|png|webp/i.exec(format)?.[0].toLowerCase() ?? format;
}

function ofCompressed(message: Message, options: ReadOptions): Promise<Content> | Content {
  const [format, data] = [textIn(message, "format"), bytesIn(message, "data")];
  if (isCompressedDepth(format)) return ofPicture(compressedDepth(format, data), options);
  return compressed(data, format).then((picture) => ofPicture(picture, options));
}

function ofCloud(cloud: Cloud, { turn, ...options }: ShotOptions): Content {
  return cloudDepth(turn ? { ...cloud, points: turned(cloud.points, turn) } : cloud, options);
}

const head = (track: string, logged: number, message: Message) => ({
  track,
  logged,
  taken: stampOf(message),
  frame: frameOf(message),
  bytes: bytesIn(message, "data").length,
});

/** A message of pictures or clouds; `unit` is that of its depths where the recording says so. */
export function shotOf(track: string, type: string, logged: number, message: Message, unit?: number): Shot {
  const common = head(track, logged, message);
  const withUnit = (options: ReadOptions) => (unit === undefined ? options : { unit, ...options });
  const size = { width: numberIn(message, "width"), height: numberIn(message, "height") };
  // A scan keeps its own axes: the check takes them from the extrinsics.
  if (kindOfType(type) === "cloud" && isScan(message))
    return {
      ...common,
      encoding: "scan",
      read: async ({ turn: _, ...options }) => pointsDepth(scanOf(message), options),
    };
  if (kindOfType(type) === "cloud")
    return { ...common, ...size, encoding: "points", read: async (options) => ofCloud(cloudOf(message), options) };
  if (type.endsWith("CompressedImage"))
    return { ...common, encoding: formatOf(message), read: async (options) => ofCompressed(message, options) };
  const stored = storedOf(message);
  return {
    ...common,
    ...size,
    encoding: stored.encoding,
    read: async (options) => ofPicture(pixels(stored), withUnit(options)),
  };
}

/** Why pictures of this encoding are not read. */
export const unreadEncoding = (encoding: string): string | undefined =>
  isKnown(encoding) || /^(?:jpe?g|png|webp|compressedDepth|points|scan)$/i.test(encoding)
    ? undefined
    : `its pictures are stored as "${encoding.slice(0, 40)}", which is not read here`;
