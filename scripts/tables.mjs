// npm run tables: every table and figure of the paper beside this project's results, from the built package.
//   --quick          a subset, at most a few minutes
//   --only a,b       only these tables
//   --json FILE      the rows as JSON
//   --docs           the aims and their verdicts into the marked region of docs/accuracy.md
//   --workers N      processes; the results do not depend on it
// The environment variable BIMODAL_STATUE names a folder of pairs for the table `statue`, laid out like those beside the project.
import { writeFileSync } from "node:fs";
import { availableParallelism } from "node:os";
import { resolve } from "node:path";
import { parseArgs } from "node:util";
import { build } from "./build.mjs";
import { fill, tablesLines } from "./docs.mjs";
import { setup } from "./setup.mjs";
import { Failure, say, script, seconds } from "./shell.mjs";
import { collect } from "./tables/collect.mjs";
import { show, showAims } from "./tables/print.mjs";
import { baseline } from "./tables/baseline.mjs";
import { DATA_FOLDER, hasData } from "./tables/library.mjs";
import { aims } from "../protocols/aims.mjs";
import { TABLES } from "../protocols/index.mjs";

function chosen(names) {
  const wanted = names?.split(",").filter(Boolean);
  const unknown = wanted?.find((name) => !TABLES.some((table) => table.name === name));
  if (unknown)
    throw new Failure(`There is no table "${unknown}"; there are ${TABLES.map(({ name }) => name).join(", ")}.`);
  return wanted ? TABLES.filter(({ name }) => wanted.includes(name)) : TABLES;
}

function parsed() {
  const options = {
    quick: { type: "boolean" },
    docs: { type: "boolean" },
    only: { type: "string" },
    json: { type: "string" },
    workers: { type: "string" },
  };
  try {
    const { quick = false, docs = false, only, json, workers } = parseArgs({ options }).values;
    const count = workers === undefined ? Math.min(2, availableParallelism()) : Number(workers);
    if (!(Number.isInteger(count) && count > 0))
      throw new Error(`--workers must be a whole number above zero, not "${workers}"`);
    if (docs && only !== undefined) throw new Error("--docs is of all tables: leave --only out");
    return { quick, docs, tables: chosen(only), json, workers: count };
  } catch (error) {
    throw error instanceof Failure ? error : new Failure(error.message);
  }
}

await script(async () => {
  const { quick, docs, tables, json: file, workers } = parsed();
  const start = performance.now();
  await setup();
  await build();
  if (!hasData())
    say(
      `no data in ${DATA_FOLDER}: the built-in surfaces and lights stand in, real pairs and photographs are left out`,
    );
  const { json, failures, complete } = await collect(tables, { quick, workers });
  if (!complete) throw new Failure("Broken off; what was done is kept, and the next run goes on from there.");

  // The baseline's figures are for the paper's bust.
  const open3d = hasData() ? baseline() : undefined;
  console.log();
  for (const table of tables) console.log(show(table, json[table.name], open3d).join("\n"));
  const list = aims(json);
  if (list.length > 0) console.log(`${showAims(list).join("\n")}\n`);
  if (file) {
    writeFileSync(resolve(file), `${JSON.stringify({ ...json, aims: list, quick, data: hasData() }, null, 1)}\n`);
    say(`wrote ${file}`);
  }
  if (docs && failures.length === 0)
    fill("docs/accuracy.md", "tables", tablesLines({ aims: list, quick, data: hasData() }));
  say(`${tables.length} tables in ${seconds(start)}`);
  if (failures.length > 0) {
    const lines = failures
      .slice(0, 20)
      .map(({ id, failure }) => `  ${id}: ${failure.code ?? failure.name}: ${failure.message}`);
    throw new Failure(`${failures.length} cells failed:\n${lines.join("\n")}${failures.length > 20 ? "\n  ..." : ""}`);
  }
});
