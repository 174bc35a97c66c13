/**
 * The table of files that are read: what each product writes, what the readers take from it, what they guess, and how to export it.
 *
 * `node scripts/files.mjs` makes docs/guide/files.md from it; tests/contract/files-page.test.mjs reads the sample of every row. No shipped
 * file imports it.
 */
import { DATASETS } from "./datasets.js";
import { DEVICES } from "./devices.js";
import { FOLDERS, RECORDINGS } from "./folders.js";
import { COLOURS, DEPTHS, MASKS } from "./pictures.js";
import { PRINTS } from "./prints.js";
import type { Group } from "./row.js";
import { SCANS } from "./scans.js";
import { TOOLS } from "./tools.js";

export type { Group, Reads, Row } from "./row.js";

export const CATALOGUE: readonly Group[] = [
  { title: "Calibrations and cameras", rows: [...DEVICES, ...TOOLS, ...PRINTS, ...DATASETS] },
  { title: "Depth maps", rows: DEPTHS },
  { title: "Colour images", rows: COLOURS },
  { title: "Masks", rows: MASKS },
  { title: "LiDAR scans", rows: SCANS },
  { title: "Folders and datasets", rows: FOLDERS },
  { title: "Recordings and live robots", rows: RECORDINGS },
];
