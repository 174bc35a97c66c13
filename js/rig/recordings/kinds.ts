/** Recognises containers of recordings by their first bytes. */
import { wrong } from "../../check.js";

export type Container = "mcap" | "bag" | "matroska";

const FIRST: [Container, RegExp][] = [
  ["mcap", /^\x89MCAP0\r\n/],
  ["bag", /^#ROSBAG V2/],
  ["matroska", /^\x1a\x45\xdf\xa3/],
];
/** Number of bytes that identify a container. */
export const HEAD = 16;

export const containerOf = (head: Uint8Array): Container | undefined =>
  FIRST.find(([, pattern]) => pattern.test(String.fromCharCode(...head.subarray(0, HEAD))))?.[0];

/** Whether a file that begins with these bytes is a recording that this package reads. */
export function isRecording(head: Uint8Array): boolean {
  if (!(head instanceof Uint8Array)) throw wrong("head", "a Uint8Array", head);
  return containerOf(head) !== undefined;
}
