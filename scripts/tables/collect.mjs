// Turns tables into rows. Takes the result of each cell from the journal, or runs the cell once if the journal lacks it.
import { inRoot, say } from "../shell.mjs";
import { openJournal } from "./journal.mjs";
import { hasData, statues } from "./library.mjs";
import { runCells } from "./pool.mjs";
import { rowsOf } from "../../protocols/index.mjs";
import { kit } from "../../protocols/scenes.mjs";

/** Milliseconds between two reports of progress. */
const PROGRESS_EVERY = 10_000;

function clock(seconds) {
  if (seconds < 90) return `${Math.round(seconds)} s`;
  return seconds < 5400 ? `${Math.round(seconds / 60)} min` : `${(seconds / 3600).toFixed(1)} h`;
}

/** Cells of all tables by their id; tables share some cells. */
function cellsOf(tables, quick) {
  const things = kit(hasData(), statues());
  const lists = new Map(tables.map((table) => [table, table.cells(things, quick)]));
  const cells = new Map([...lists.values()].flat().map((cell) => [cell.id, cell]));
  return { lists, cells: [...cells.values()] };
}

/** The first Ctrl-C ends the run cleanly, the second at once. */
function interruption() {
  const abort = new AbortController();
  const stop = () => abort.abort();
  process.once("SIGINT", stop).once("SIGTERM", stop);
  return { signal: abort.signal, done: () => process.off("SIGINT", stop).off("SIGTERM", stop) };
}

/** `wasm` is a file to measure in place of the package's own. */
export async function collect(tables, { quick, workers, wasm }) {
  const { lists, cells } = cellsOf(tables, quick);
  const journal = openJournal(wasm);
  const results = new Map(cells.map((cell) => [cell.id, journal.find(cell)]));
  const waiting = cells.filter((cell) => results.get(cell.id) === undefined);
  const kept = cells.length - waiting.length;
  say(`${cells.length} cells${kept > 0 ? `, ${kept} of them known from ${journal.path}` : ""}; ${workers} processes`);

  const { signal, done } = interruption();
  const byId = new Map(waiting.map((cell) => [cell.id, cell]));
  const start = performance.now();
  let [finished, said] = [0, start];
  await runCells(waiting, {
    workers,
    signal,
    settings: wasm ? [inRoot(wasm)] : [],
    onResult(id, result) {
      results.set(id, result);
      journal.keep(byId.get(id), result);
      finished++;
      const now = performance.now();
      if (now - said < PROGRESS_EVERY) return;
      said = now;
      const left = ((now - start) / finished / 1000) * (waiting.length - finished);
      say(
        `${finished} of ${waiting.length} cells, ${clock((now - start) / 1000)} gone, about ${clock(left)} to go (${id})`,
      );
    },
  });
  done();

  const good = (cell) => results.get(cell.id) && !results.get(cell.id).failure;
  const rows = (table) =>
    rowsOf(
      table,
      lists
        .get(table)
        .filter(good)
        .map((cell) => ({ cell, result: results.get(cell.id) })),
    );
  return {
    json: Object.fromEntries(tables.map((table) => [table.name, rows(table)])),
    failures: cells
      .filter((cell) => results.get(cell.id)?.failure)
      .map((cell) => ({ id: cell.id, ...results.get(cell.id) })),
    complete: cells.every((cell) => results.get(cell.id) !== undefined),
  };
}
