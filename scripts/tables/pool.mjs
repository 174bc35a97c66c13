// Runs cells in several processes. The results do not depend on their number, because every cell carries its own seeds.
import { fork } from "node:child_process";
import { inRoot } from "../shell.mjs";

const CELLS = inRoot("scripts/tables/worker.mjs");
/**
 * Largest number of tries of a cell, which fails if it has ended its process this many times. Cells run in processes and not in threads,
 * so that the others continue if Node itself crashes.
 */
const MOST_TRIES = 2;

/**
 * Runs all cells; `onResult(id, result, took)` is called as each finishes. Resolves when all are done or, once `signal` is aborted, when
 * the running processes have ended. `program` is the script of each process, `settings` its arguments.
 */
export function runCells(cells, { workers, signal, onResult, program = CELLS, settings = [] }) {
  const waiting = cells.map((cell) => ({ cell, tries: 0 }));
  return new Promise((done) => {
    const children = new Set();
    const finish = () => children.size === 0 && done();

    function start() {
      const child = fork(program, settings, { stdio: ["ignore", "inherit", "inherit", "ipc"] });
      children.add(child);
      let task;
      const next = () => {
        task = signal.aborted ? undefined : waiting.shift();
        if (task) child.send({ cell: task.cell });
        else child.disconnect();
      };
      child.on("message", ({ ready, id, result, took }) => {
        if (!ready) onResult(id, result, took);
        task = undefined;
        // After a panic, the instance may be in an invalid state.
        if (result?.failure?.code === "panic") child.disconnect();
        else next();
      });
      child.on("exit", (code, by) => {
        children.delete(child);
        if (task && !signal.aborted) {
          const lost = { ...task, tries: task.tries + 1 };
          if (lost.tries < MOST_TRIES) waiting.unshift(lost);
          else
            onResult(
              lost.cell.id,
              { failure: { name: "Error", code: "exit", message: `its process ended (${by ?? code})` } },
              0,
            );
        }
        if (waiting.length > 0 && !signal.aborted) start();
        finish();
      });
    }

    signal.addEventListener("abort", () => children.forEach((child) => child.kill("SIGKILL")));
    if (cells.length === 0 || signal.aborted) return done();
    for (let count = 0; count < Math.min(workers, cells.length); count++) start();
  });
}
