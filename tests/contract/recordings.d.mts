import type { CheckFrame, Pose } from "../../pkg/index.js";

export interface Recorded {
  topic: string;
  /** "sensor_msgs/Image", for either generation of ROS. */
  type: string;
  /** Seconds. */
  time: number;
  message?: object;
  bytes?: Uint8Array;
  encoding?: string;
  schemaEncoding?: string;
}
export type Compress = (data: Uint8Array) => { compression: string; compressedData: Uint8Array };

export function definitionOf(type: string, generation: "ros1" | "ros2"): string;
export function encoded(type: string, message: object, generation: "ros1" | "ros2"): Uint8Array;
export function driver(
  frames: readonly CheckFrame[],
  pose: Pose,
  options?: { start?: number; every?: number; late?: number; compress?: boolean },
): Recorded[];
export function mcap(
  messages: readonly Recorded[],
  options?: { generation?: "ros1" | "ros2"; compressChunk?: Compress; chunks?: boolean; cut?: number },
): Promise<Buffer>;
export function lz4Frame(data: Uint8Array): Uint8Array;
export function zstdFrame(data: Uint8Array): Uint8Array;
export function matroska(
  frames: readonly Pick<CheckFrame, "image" | "depth">[],
  calibration: string,
  options?: { groups?: boolean; isOpen?: boolean },
): Buffer;
