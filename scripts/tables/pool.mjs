// Cells on several processes. The results do not depend on how many there are: every cell carries its own seeds.
import { fork } from "node:child_process";
import { inRoot } from "../shell.mjs";

const CELLS = inRoot("scripts/tables/worker.mjs");
/** A cell that ends its process so often fails. A process, not a thread: when Node itself breaks, the others go on. */
const MOST_TRIES = 2;

/**
 * Runs all cells; `onResult(id, result, took)` gets each one's as it comes. Resolves when all are done, or, once `signal` is
 * aborted, when those at work have been given up. `program` is what each process runs, `settings` what it is told on its command line.
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
        // After a panic the instance is suspect.
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
