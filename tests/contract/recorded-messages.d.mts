import type { RigSample } from "../../pkg/index.js";

export function smallFrames(): Promise<Pick<RigSample, "image" | "depth" | "pose">[]>;
