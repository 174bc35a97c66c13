// The widgets in JupyterLab, in a real browser.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { drawn, folder, opened, serve } from "./servers.mjs";

const CELLS = [
  `from bimodal_stereo import sample
from bimodal_stereo.widget import Figure, Lab
figure = Figure("lambert")
figure`,
  `scene = sample("bust", "colourful", size=48, angles={"beta": 20}, noise=0.01)
lab = Lab(scene.image, scene.depth, start="identity")
lab`,
  `print("told", lab.status, round(lab.report.pose.angles.beta), len(figure.result["numbers"]) > 0, figure.error, lab.error)
figure.lesson = "pixel"`,
  `print("told", figure.state)`,
];

function notebook() {
  const cells = CELLS.map((source, at) => ({
    ...{ cell_type: "code", id: `cell-${at}`, metadata: {}, source, outputs: [], execution_count: null },
  }));
  const kernelspec = { name: "python3", display_name: "Python 3", language: "python" };
  return JSON.stringify({ cells, metadata: { kernelspec }, nbformat: 4, nbformat_minor: 5 });
}

test("both widgets are drawn in JupyterLab, and the kernel follows them", async () => {
  const path = folder();
  writeFileSync(join(path, "widgets.ipynb"), notebook());
  const open = ["--no-browser", "--allow-root", "--ip=127.0.0.1", "--IdentityProvider.token="];
  const options = ["--LabApp.expose_app_in_browser=True", "--LabApp.news_url=", "--ServerApp.port_retries=500"];
  const address = await serve("jupyter", ["lab", ...open, ...options], path);
  const page = await opened(`${address}/lab/tree/widgets.ipynb`);
  const run = (index) =>
    page.evaluate(async (index) => {
      const { content, context } = window.jupyterapp.shell.currentWidget;
      await context.sessionContext.ready;
      content.activeCellIndex = index;
      await window.jupyterapp.commands.execute("notebook:run-cell");
    }, index);
  await page
    .locator(".jp-Notebook .jp-CodeCell")
    .nth(CELLS.length - 1)
    .waitFor();
  await page.waitForFunction(() => window.jupyterapp?.shell.currentWidget?.context);
  await run(0);
  await run(1);
  const colours = await drawn(page);
  assert.ok(colours.length >= 5 && colours.every((count) => count > 4), JSON.stringify(colours));
  await run(2);
  await page.getByText("told converged 20 True {} {}").waitFor();
  // The browser follows the kernel, and the kernel the reader.
  const slider = page.locator("bimodal-figure input[type=range]").first();
  await page.waitForFunction(() => document.querySelector("bimodal-figure").lesson === "pixel");
  await page.locator("bimodal-figure").getByRole("region", { name: "pixel" }).waitFor();
  await slider.press("ArrowRight");
  await page.waitForFunction(() => document.querySelector("bimodal-figure").state !== "");
  await run(3);
  const state = await page.evaluate(() => document.querySelector("bimodal-figure").state);
  await page.getByText(`told ${state}`).waitFor();
});
