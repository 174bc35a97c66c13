/** What can be taken away, by the names of its buttons. */

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
