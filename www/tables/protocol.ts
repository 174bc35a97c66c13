/**
 * The protocols of `npm run tables` as the page knows them: the same cells, measured by the same modules. Nothing of them is
 * repeated here but the shape of what they hand over.
 */

import { aims as judge } from "../../protocols/aims.mjs";
import { sceneOf as scene } from "../../protocols/anywhere.mjs";
import * as counts from "../../protocols/counts.mjs";
import { TABLES, rowsOf as rows } from "../../protocols/index.mjs";
import { paperDegrees } from "../../protocols/rotations.mjs";
import { kit } from "../../protocols/scenes.mjs";
import type { Options, SampleRequest, StepReport } from "../../pkg/index.js";

export { median, worst } from "../../protocols/numbers.mjs";
export { paperDegrees };

/** A cell's description, and a row of its measurements. */
export type Row = Record<string, unknown>;

export interface Cell {
  id: string;
  kind: string;
  row: Row;
  scene?: Omit<SampleRequest, "surface" | "light"> & { surface: string; light: string };
  options: Pick<Options, "registration" | "shading" | "lambda"> & {
    light: "known" | "estimate";
    start: "search" | "identity" | "truth";
    scale: "free" | number;
  };
  exposure?: number;
  alternations?: number;
}

/** A measured cell. Only what every kind of them has is named. */
export interface Result extends Row {
  status?: StepReport["status"];
  message?: string;
  degrees?: number;
  milliseconds?: number;
}

/** Cells that have come to an end, each with its result. */
export type Done = readonly { cell: Cell; result: Result }[];

/** If a result lacks the requested number, the protocol's answer is no. */
const judgement = (judge: (result: never) => boolean) => judge as (result: Result) => boolean;
export const isFound = judgement(counts.isFound);
export const isFlagged = judgement(counts.isFlagged);
export const isConfidentlyWrong = judgement(counts.isConfidentlyWrong);

export interface Table {
  name: string;
  title: string;
  notes?: readonly string[];
}

/** One aim of the project beside what the rows came to; `ok` is null where nothing can be said. */
export interface Aim {
  what: string;
  measured: number | null;
  sense: "<=" | ">=";
  limit: number;
  rows: number;
  ok: boolean | null;
}

/** Names stand for the package's own scenes: third-party surfaces and lights are not part of the page. */
export const library = { surface: (name: string) => name, light: (name: string) => name };

const own = kit(false);

export const tables: readonly Table[] = TABLES;

const definition = (name: string) => {
  const table = TABLES.find((each: Table) => each.name === name);
  if (!table) throw new Error(`There is no table "${name}".`);
  return table;
};

export const tableNamed = (name: string): Table => definition(name);

/** All cells of a table. */
export const cellsOf = (name: string): Cell[] => definition(name).cells(own, false) as Cell[];

/** The rows as the command writes them: a list, or one summary with counts. */
export const rowsOf = (name: string, results: Done): Row[] | Row => rows(definition(name), results) as Row[] | Row;

export const aimsOf = (name: string, results: Done): Aim[] => judge({ [name]: rowsOf(name, results) }) as Aim[];

export const sceneOf = (cell: Cell): Cell["scene"] => scene(cell, library) as Cell["scene"];
