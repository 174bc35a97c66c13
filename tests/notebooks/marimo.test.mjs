// The widgets in marimo, in a real browser.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { createServer } from "node:net";
import { join } from "node:path";
import { test } from "node:test";
import { drawn, folder, opened, serve } from "./servers.mjs";

const APP = `import marimo

app = marimo.App()


@app.cell
def _():
    import marimo as mo
    from bimodal_stereo import sample
    from bimodal_stereo.widget import Figure, Lab

    return Figure, Lab, mo, sample


@app.cell
def _(Figure, mo):
    figure = mo.ui.anywidget(Figure("lambert"))
    figure
    return (figure,)


@app.cell
def _(Lab, mo, sample):
    scene = sample("bust", "colourful", size=48, angles={"beta": 20}, noise=0.01)
    lab = mo.ui.anywidget(Lab(scene.image, scene.depth, start="identity"))
    lab
    return (lab,)


@app.cell
def _(figure, lab, mo):
    mo.md(f"told {lab.value['status']} {len(figure.value['result'].get('numbers', {})) > 0} {figure.value['error']} {lab.value['error']}")
    return


if __name__ == "__main__":
    app.run()
`;

const freePort = () =>
  new Promise((found) => {
    const server = createServer().listen(0, "127.0.0.1", () => {
      const { port } = server.address();
      server.close(() => found(port));
    });
  });

test("both widgets are drawn in marimo, and its cells follow them", async () => {
  const path = folder();
  writeFileSync(join(path, "widgets.py"), APP);
  const port = ["--host", "127.0.0.1", "--port", String(await freePort())];
  const address = await serve("marimo", ["run", "widgets.py", "--headless", "--no-token", ...port], path);
  const page = await opened(address);
  const colours = await drawn(page);
  assert.ok(colours.length >= 5 && colours.every((count) => count > 4), JSON.stringify(colours));
  await page.getByText("told converged True {} {}").waitFor();
});
