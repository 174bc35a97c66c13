import type { Recorded } from "./recordings.mjs";

export function bridge(
  views: readonly (readonly Recorded[])[],
  options?: { port?: number; generation?: "ros1" | "ros2" },
): Promise<{
  address: string;
  port: number;
  listening(): string[];
  turn(view: number): void;
  close(): Promise<void>;
}>;
