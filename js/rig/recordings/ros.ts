/** ROS messages as shots, for every container and for a live connection. */
import { badFile, reasonOf } from "../../errors.js";
import { pictureColour } from "../colour.js";
import { cloudDepth, pictureDepth } from "../depth.js";
import type { Cloud, Picture } from "../formats/picture.js";
import { pointsDepth } from "../points.js";
import type { ReadOptions } from "../types.js";
import { turned } from "./axes.js";
import { compressed, compressedDepth, isCompressedDepth } from "./compressed.js";
import { type Message, bytesIn, frameOf, numberIn, stampOf, textIn } from "./messages.js";
import { type Stored, isKnown, pixels } from "./pixels.js";
import { cloudOf, isScan, scanOf } from "./points.js";
import type { Content, Shot, ShotOptions, TrackKind } from "./source.js";

/** The kind of data in messages of a type. ROS 1 writes "sensor_msgs/Image", ROS 2 "sensor_msgs/msg/Image". */
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

/** Metres per stored unit by the rule of ROS (REP 118): integers are millimetres, floats are metres. */
const unitOf = (picture: Picture): number => (picture.data instanceof Float32Array ? 1 : 0.001);

/** A picture as a colour image or a depth map. */
export function ofPicture(picture: Picture, { as, unit }: ReadOptions): Content {
  if (as !== "depth") return pictureColour(picture);
  if (picture.data instanceof Uint8Array)
    throw badFile(`its images have 8 bits (${picture.format}), too few for depth; choose another topic`);
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

/** The format of a compressed image in one word: "compressedDepth" of "16UC1; compressedDepth png". */
function formatOf(message: Message): string {
  const format = textIn(message, "format");
  if (isCompressedDepth(format)) return "compressedDepth";
  return /jpe?g|png|webp/i.exec(format)?.[0].toLowerCase() ?? format;
}

async function ofCompressed(message: Message, options: ReadOptions): Promise<Content> {
  const [format, data] = [textIn(message, "format"), bytesIn(message, "data")];
  const read = isCompressedDepth(format)
    ? compressedDepth
    : (name: string, bytes: Uint8Array) => compressed(bytes, name);
  return ofPicture(await read(format, data), options);
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

/** A message of an image or a cloud as a shot; `unit` is the unit of its depths, where the recording states it. */
export function shotOf(track: string, type: string, logged: number, message: Message, unit?: number): Shot {
  const common = head(track, logged, message);
  const withUnit = (options: ReadOptions) => (unit === undefined ? options : { unit, ...options });
  const size = { width: numberIn(message, "width"), height: numberIn(message, "height") };
  // A scan keeps its axes, because the extrinsics refer to that frame.
  const isCloud = kindOfType(type) === "cloud";
  if (isCloud && isScan(message))
    return {
      ...common,
      encoding: "scan",
      read: async ({ turn: _, ...options }) => pointsDepth(scanOf(message), options),
    };
  if (isCloud)
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

/** Why a topic whose first message failed is not read. */
export const unreadFirst = (error: unknown): string => `its first message cannot be read (${reasonOf(error)})`;

/** Why images of this encoding are not read; undefined if they are. */
export const unreadEncoding = (encoding: string): string | undefined =>
  isKnown(encoding) || /^(?:jpe?g|png|webp|compressedDepth|points|scan)$/i.test(encoding)
    ? undefined
    : `its images are stored as "${encoding.slice(0, 40)}", which is not supported`;
