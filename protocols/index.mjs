// All tables and figures. Pure definitions: the importing program (the command, a page) brings the package and the data.
import { ablation, exposure, random } from "./anywhere.mjs";
import { cameras } from "./cameras.mjs";
import { conditions } from "./conditions.mjs";
import { honesty } from "./honesty.mjs";
import { painted } from "./painted.mjs";
import { parts } from "./parts.mjs";
import { pinhole, rgbd } from "./perspectives.mjs";
import { perturbation } from "./perturbation.mjs";
import { figure6, table1, table2A, table2B } from "./poses.mjs";
import { albedo, figure7, photographs, table3 } from "./reals.mjs";
import { sensors } from "./sensors.mjs";
import { soft } from "./soft.mjs";
import { statue } from "./statue.mjs";
import { stress } from "./stress.mjs";
import { figure4, figure5, refinement } from "./shapes.mjs";
import { unseen } from "./unseen.mjs";

/** In the order of printing. */
export const TABLES = [
  ...[table1, table2A, table2B, table3, figure4, figure5, figure6, figure7],
  ...[
    refinement,
    sensors,
    photographs,
    conditions,
    unseen,
    albedo,
    rgbd,
    statue,
    pinhole,
    parts,
    random,
    cameras,
    painted,
    soft,
    stress,
    honesty,
    exposure,
    perturbation,
    ablation,
  ],
];

/** The rows of a table for the JSON: the cell's own keys, which measured values may not overwrite, and the measured values. */
export const rowsOf = (table, results) =>
  table.rows ? table.rows(results) : results.map(({ cell, result }) => ({ ...cell.row, ...result, ...cell.row }));
