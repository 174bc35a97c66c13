/** For the page: the visitor's files as the input of a run. Not part of the package's contract. */
export { type Arranged, type ReadFrame, type ReadText, arranged } from "./arrange.js";
export { type GivenCamera, type PairCameras, type PictureSize, camerasFor } from "./cameras.js";
export { type Pair, type Parts, pairOf } from "./pair.js";
export { readPart } from "./read.js";
