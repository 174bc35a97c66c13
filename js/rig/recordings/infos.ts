/**
 * sensor_msgs/CameraInfo: the intrinsics of the images beside it, with binning and region of interest. K and D belong to the raw image, P to
 * the rectified one.
 */
import { cameraOf } from "../formats/cameras.js";
import type { NamedCamera } from "../types.js";
import { type ReaderWarning, warning } from "../warnings.js";
import { type Message, inner, numberIn, numbersIn, textIn } from "./messages.js";

/** A topic without the name of its transport. */
export const baseOf = (topic: string): string =>
  topic.replace(/\/(?:compressed|compressedDepth|ffmpeg|theora|zstd)$/i, "");
const parentOf = (topic: string): string => topic.slice(0, Math.max(0, topic.lastIndexOf("/")));
const lastOf = (topic: string): string => topic.slice(topic.lastIndexOf("/") + 1);

/** Whether the name of a topic says that its images are rectified. */
export const isRectified = (topic: string): boolean => /rect/i.test(lastOf(baseOf(topic)));

/** How closely topics of intrinsics and of images belong together by name: 2 side by side, 1 of the same sensor, else 0. */
export function belongs(info: string, pictures: string): number {
  const parent = parentOf(baseOf(pictures));
  // image_transport puts both topics side by side; librealsense records image/data and info/camera_info.
  if (parentOf(info) === parent) return 2;
  return parentOf(parentOf(info)) === parentOf(parent) && lastOf(parent) === "image"
    ? 2
    : parentOf(parent) === parentOf(info)
      ? 1
      : 0;
}

interface Size {
  width: number;
  height: number;
}

/** The intrinsics of an image with binning or a region of interest, from those of the full sensor. */
function binned(message: Message, numbers: number[], size: Size | undefined): { numbers: number[]; size?: Size } {
  const [fx = NaN, fy = NaN, cx = NaN, cy = NaN] = numbers;
  const full = { width: numberIn(message, "width"), height: numberIn(message, "height") };
  const roi = inner(message, "roi");
  const [x, y] = [numberIn(roi, "x_offset") || 0, numberIn(roi, "y_offset") || 0];
  const region = { width: numberIn(roi, "width") || full.width, height: numberIn(roi, "height") || full.height };
  const [bx, by] = [Math.max(1, numberIn(message, "binning_x") || 1), Math.max(1, numberIn(message, "binning_y") || 1)];
  const cut = { width: Math.floor(region.width / bx), height: Math.floor(region.height / by) };
  const isCut = bx > 1 || by > 1 || x > 0 || y > 0 || region.width !== full.width || region.height !== full.height;
  // Some drivers state the region although their intrinsics already belong to it. The size of the image decides.
  if (!isCut || size === undefined || size.width !== cut.width || size.height !== cut.height)
    return { numbers, ...(full.width > 0 && full.height > 0 && { size: full }) };
  return {
    numbers: [fx / bx, fy / by, (cx - x + 0.5) / bx - 0.5, (cy - y + 0.5) / by - 0.5],
    size: cut,
  };
}

/** The camera of a topic's images, whose size decides whether binning and region apply. */
export function cameraOfInfo(
  message: Message,
  topic: string,
  size: Size | undefined,
  warnings: ReaderWarning[],
): NamedCamera | undefined {
  const k = numbersIn(message, "k", "K");
  const p = numbersIn(message, "p", "P");
  const isSet = (values: number[], count: number) => values.length === count && (values[0] ?? 0) > 0;
  // Drivers without a calibration publish zeros.
  if (!isSet(k, 9) && !isSet(p, 12)) return undefined;
  const rectified = (isRectified(topic) && isSet(p, 12)) || !isSet(k, 9);
  const at = (values: number[], index: number) => values[index] ?? 0;
  const focal = rectified ? [at(p, 0), at(p, 5), at(p, 2), at(p, 6)] : [at(k, 0), at(k, 4), at(k, 2), at(k, 5)];
  const { numbers, size: of } = binned(message, focal, size);
  if (isRectified(topic) && !rectified)
    warnings.push(
      warning(
        "lens-approximated",
        `${topic} is rectified, but its camera_info has no P: K was used, without distortion.`,
      ),
    );
  const bent = rectified || isRectified(topic) ? [] : numbersIn(message, "d", "D");
  return cameraOf(
    {
      name: topic,
      focal: numbers.slice(0, 2),
      centre: numbers.slice(2, 4),
      skew: rectified ? 0 : at(k, 1),
      ...(bent.length > 0 && { model: textIn(message, "distortion_model"), distortion: bent }),
      ...(of && { width: of.width, height: of.height }),
    },
    warnings,
  );
}
