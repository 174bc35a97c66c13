/** The readers of files of points, which are loaded with the first such file. */
export { pointsDepth } from "../points.js";
export { readBin } from "./bin.js";
export { readLas } from "./las.js";
export { readPcd } from "./pcd.js";
export { readPly } from "./ply.js";
export { readXyz } from "./xyz.js";
