/** For the page: the visitor's files as the pair of a run, by the readers of rigs. No part of the package's contract. */
export { type GivenCamera, type PairCameras, type PictureSize, camerasFor } from "./cameras.js";
export { type Pair, type Parts, pairOf } from "./pair.js";
export { readPart } from "./read.js";
