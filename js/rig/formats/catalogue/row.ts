/** One row of the table of files that are read, from which docs/guide/files.md is made and against which the readers are tested. */
import type { Container } from "../../recordings/kinds.js";
import type { ReaderCode } from "../../warnings.js";
import type { RasterKind } from "../headerless.js";

/** What a file is read as; "refused" if the error says what to do instead. */
export type Reads = "colour" | "depth" | "mask" | "cameras" | "poses" | "folder" | "recording" | "robot" | "refused";

export interface Row {
  /** The program, device or dataset that writes the file. */
  product: string;
  /** The file's name and format. */
  file: string;
  /** The modules of js/rig that read only this product's files, by their names without ending. */
  modules: readonly string[];
  /** The kind of pixels or points, the container of a recording, or the words with which readings of such a text begin. */
  reader: RasterKind | Container | (string & {});
  /** The key of the small file that the test reads (tests/contract/product-*.mjs). */
  sample: string;
  /** What the sample is read as. */
  reads: Reads;
  /** The codes of the warnings that the sample gives. */
  warnings: readonly ReaderCode[];
  /** The numbers that are taken from the file. */
  taken: string;
  /** The reader's decisions where the file leaves something open. */
  guessed: string;
  /** How to get the file from the product. */
  exported: string;
}

export interface Group {
  title: string;
  rows: readonly Row[];
}

/** Used if no command or menu of the product could be verified. */
export const SEE_PRODUCT = "See the product's documentation.";
/** The text of the column if nothing is guessed. */
export const NOTHING = "Nothing.";
