/** Messages between the page of tables and its worker. */

import type { Fault } from "../engine/protocol";
import type { Cell, Result } from "./protocol";

export interface Task {
  cell: Cell;
}

export type CellAnswer =
  /** The progress of the cell, in words, and that of its search, in percent. */
  { id: string; progress: string; share: string } | { id: string; result: Result } | { id: string; fault: Fault };
