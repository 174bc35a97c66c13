// Recordings of a small rig in front of varying scenes, for the tests of recordings.
import { openRecording } from "../../pkg/rig-recordings.js";
import { driver, mcap } from "./recordings.mjs";
import { H, W, distortion, millimetres, rgb, rotation, translation } from "./rig-support.mjs";

export const POSE = { rotation, translation };
/** Intrinsics for images of this size. */
export const K = { fx: 14, fy: 14.5, cx: 8.25, cy: 5.75 };
export const CAMERA = { ...K, distortion };
export const START = 1_700_000_000;

/** A frame whose depths and colours depend on the index. */
export function frame(index = 0) {
  const data = new Uint8Array(4 * W * H).fill(255);
  rgb.forEach((colour, pixel) =>
    data.set(
      colour.map((value) => value / (1 + ((pixel + index) % 3))),
      4 * pixel,
    ),
  );
  const depth = Uint16Array.from(millimetres, (value) => value && value + 200 * index);
  return {
    image: { width: W, height: H, data, camera: CAMERA },
    depth: { width: W, height: H, data: depth, camera: K },
  };
}
export const frames = (count) => Array.from({ length: count }, (_, index) => frame(index));
export const recorded = (options, count = 3) => driver(frames(count), POSE, { compress: false, ...options });

export const opened = (content, name = "a.mcap") => openRecording({ name, content });
export const written = async (messages, options) => opened(await mcap(messages, options));
export const codes = ({ warnings }) => warnings.map(({ code }) => code);

/** A message on a separate topic. */
export const image = (topic, message, type = "sensor_msgs/Image") => ({ topic, type, time: START + 0.2, message });

/** A recording of one frame, with the messages of a topic replaced. */
export const replacing = (topic, ...messages) =>
  written([...recorded({}, 1).filter((each) => each.topic !== topic), ...messages]);
