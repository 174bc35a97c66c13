/** The kinds of downloads, by the names of their buttons. */

export const kinds = [
  "pose",
  "matrix",
  "clouds",
  "depthPng",
  "depth",
  "normals",
  "depthNormals",
  "light",
  "picture",
  "report",
  "run",
] as const;
export type Kind = (typeof kinds)[number];
