/**
 * The protocols of `npm run tables` for the page: the same cells, measured by the same modules. This file only declares types.
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

/** A measured cell, with the members that all kinds of cells share. */
export interface Result extends Row {
  status?: StepReport["status"];
  message?: string;
  degrees?: number;
  milliseconds?: number;
}

/** Finished cells with their results. */
export type Done = readonly { cell: Cell; result: Result }[];

/** A result without the requested number counts as "no", as in the protocol. */
const judgement = (judge: (result: never) => boolean) => judge as (result: Result) => boolean;
export const isFound = judgement(counts.isFound);
export const isFlagged = judgement(counts.isFlagged);
export const isConfidentlyWrong = judgement(counts.isConfidentlyWrong);

export interface Table {
  name: string;
  title: string;
  notes?: readonly string[];
}

/** One aim of the project beside the value from the rows; `ok` is null if nothing can be said. */
export interface Aim {
  what: string;
  measured: number | null;
  sense: "<=" | ">=";
  limit: number;
  rows: number;
  ok: boolean | null;
}

/** Names of the package's own scenes; third-party surfaces and lights are not part of the page. */
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
