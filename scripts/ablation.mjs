// npm run ablation: measures the contribution of each part of the method with builds in which that part is switched off.
//   --only a,b       only these parts (scripts/ablation/parts.mjs), next to the whole method
//   --quick          two photographs, a render with varying albedo and one with a single albedo
//   --known          prints what has been measured so far, "-" for missing cells; builds and runs nothing
//   --json FILE      the rows as JSON
//   --docs           the table into the marked region of docs/lab/results.md
//   --workers N      processes; the results do not depend on it
// Each part takes a build of one or two minutes and about forty runs. An interrupted command continues where it stopped: builds are
// kept in target/ablation, rows in the journal of the tables.
import { writeFileSync } from "node:fs";
import { resolve } from "node:path";
import { parseArgs } from "node:util";
import { sets, table } from "./ablation/cells.mjs";
import { ALL, PARTS } from "./ablation/parts.mjs";
import { markdown, text } from "./ablation/print.mjs";
import { built, variant } from "./ablation/variant.mjs";
import { build } from "./build.mjs";
import { fill } from "./docs.mjs";
import { setup } from "./setup.mjs";
import { Failure, say, script, seconds } from "./shell.mjs";
import { collect } from "./tables/collect.mjs";
import { openJournal } from "./tables/journal.mjs";
import { hasData } from "./tables/library.mjs";
import { rowsOf } from "../protocols/index.mjs";
import { kit } from "../protocols/scenes.mjs";

function parsed() {
  const [flag, string] = [{ type: "boolean" }, { type: "string" }];
  const options = {
    only: string,
    quick: flag,
    known: flag,
    json: string,
    docs: flag,
    workers: { ...string, default: "1" },
  };
  let given;
  try {
    given = parseArgs({ options }).values;
  } catch (error) {
    throw new Failure(error.message);
  }
  const wanted = given.only?.split(",").filter(Boolean) ?? PARTS.map(({ name }) => name);
  const unknown = wanted.find((name) => !PARTS.some((part) => part.name === name));
  if (unknown)
    throw new Failure(`There is no part "${unknown}"; there are ${PARTS.map(({ name }) => name).join(", ")}.`);
  const workers = Number(given.workers);
  if (!(Number.isInteger(workers) && workers > 0))
    throw new Failure(`--workers must be a whole number above zero, not "${given.workers}".`);
  if (given.docs && given.quick) throw new Failure("--docs needs all cells: leave out --quick.");
  return { ...given, workers, parts: PARTS.filter(({ name }) => wanted.includes(name)) };
}

/** The rows of a variant. A cell that fails without the part is reported and has no row. */
async function measured(part, chosen, { quick = false, workers }) {
  say(`without ${part.what} (${part.name})`);
  const { wasm, gzipped } = await variant(part);
  const { json, failures, complete } = await collect([table(chosen)], { quick, workers, wasm });
  if (!complete) throw new Failure("Interrupted. The results so far are kept, and the next run continues from there.");
  for (const { id, failure } of failures)
    say(`${part.name}, ${id}: ${failure.code ?? failure.name}: ${failure.message}`);
  if (part === ALL && failures.length > 0) throw new Failure("With all parts no cell may fail.");
  return { part: part.name, what: part.what, gzipped, rows: json.parts };
}

/** The journal's rows of a variant; empty if the variant is not built or has not run. */
function known(part, chosen) {
  const found = built(part);
  if (!found) return [];
  const [one, journal] = [table(chosen), openJournal(found.wasm)];
  const results = one
    .cells(kit(hasData()))
    .map((cell) => ({ cell, result: journal.find(cell) }))
    .filter(({ result }) => result);
  return results.length > 0
    ? [{ part: part.name, what: part.what, gzipped: found.gzipped, rows: rowsOf(one, results) }]
    : [];
}

async function all(given, chosen) {
  const parts = [ALL, ...given.parts];
  if (given.known) return parts.flatMap((part) => known(part, chosen));
  await setup();
  await build();
  const variants = [];
  for (const part of parts) variants.push(await measured(part, chosen, given));
  return variants;
}

await script(async () => {
  const given = parsed();
  const start = performance.now();
  const chosen = sets(given.quick, hasData());
  const variants = await all(given, chosen);
  if (variants[0]?.part !== ALL.name)
    throw new Failure("There are no results of the method with all parts: run it without --known.");
  console.log(`\n${text(chosen, variants).join("\n")}\n`);
  if (given.json) {
    writeFileSync(
      resolve(given.json),
      `${JSON.stringify({ variants, quick: Boolean(given.quick), data: hasData() }, null, 1)}\n`,
    );
    say(`wrote ${given.json}`);
  }
  if (given.docs) fill("docs/lab/results.md", "ablation", markdown(chosen, variants));
  say(`${variants.length - 1} parts in ${seconds(start)}`);
});
