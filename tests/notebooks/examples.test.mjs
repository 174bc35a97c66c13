// The notebooks of examples/notebooks, executed as Jupyter does it.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { copyFileSync, readFileSync } from "node:fs";
import { basename, join } from "node:path";
import { test } from "node:test";
import { inRoot, matching } from "../../scripts/shell.mjs";
import { environment, folder, program } from "./servers.mjs";

/** The text that each notebook has to show in the end. */
const SAYS = {
  "shape-from-shading.ipynb": [/^converged beta (19|20)\.\d+, true 20\.00/m, /between the pictures: [\d.]+e-0[5-9]$/m],
  "calibration.ipynb": [/^consistent - /m, /^dropped +off +2\.\d+ degrees/m, /^factory +consistent/m],
};

const NOTEBOOKS = matching(["examples/notebooks"], /\.ipynb$/);

/** The text of all outputs: of streams, and of the cells' last values. */
const texts = ({ cells }) =>
  cells
    .flatMap(({ outputs = [] }) => outputs)
    .map(({ text, data }) => [text ?? data?.["text/plain"] ?? ""].flat().join(""))
    .join("\n");

for (const path of NOTEBOOKS)
  test(`${basename(path)} runs from top to bottom`, () => {
    const place = folder();
    copyFileSync(inRoot(path), join(place, "book.ipynb"));
    const args = ["execute", "--inplace", "--timeout=300", "book.ipynb"];
    const { status, stderr } = spawnSync(program("jupyter"), args, {
      cwd: place,
      env: environment(place),
      encoding: "utf8",
    });
    assert.equal(status, 0, stderr);
    const book = JSON.parse(readFileSync(join(place, "book.ipynb"), "utf8"));
    const said = texts(book);
    for (const words of SAYS[basename(path)]) assert.match(said, words);
    const widgets = JSON.stringify(book.cells).split("application/vnd.jupyter.widget-view+json").length - 1;
    assert.equal(widgets, said.includes("bimodal_stereo.widget.") ? 6 : 0);
  });

test("no notebook is without a line of what it says, and none is kept with its outputs", () => {
  assert.deepEqual(NOTEBOOKS.map((path) => basename(path)).sort(), Object.keys(SAYS).sort());
  for (const path of NOTEBOOKS)
    for (const { cell_type, outputs, execution_count } of JSON.parse(readFileSync(inRoot(path), "utf8")).cells)
      if (cell_type === "code") assert.deepEqual([outputs, execution_count], [[], null], path);
});
