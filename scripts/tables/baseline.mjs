// Open3D's results on the scenes of Table 2B, written by scripts/reference/open3d.py.
import { inRoot, readIfThere } from "../shell.mjs";

const FIXTURE = "scripts/reference/open3d.csv";

/** Degrees for a row of Table 2B; undefined if the baseline has none, because it needs the light. */
export function baseline() {
  const lines = (readIfThere(inRoot(FIXTURE)) ?? "").split("\n").filter((line) => /^\d/.test(line));
  const degrees = new Map(
    lines.map((line) => [line.slice(0, line.lastIndexOf(",")), Number(line.slice(line.lastIndexOf(",") + 1))]),
  );
  return ({ beta, overlap, size, light, lightName }) =>
    light === "known" ? degrees.get([beta, overlap, size, lightName].join(",")) : undefined;
}
