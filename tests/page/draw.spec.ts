/** Compares pictures that the module paints with its numbers. */

import { fileURLToPath } from "node:url";
import { expect, test } from "./lab";

const PACKAGE = fileURLToPath(new URL("../../pkg/", import.meta.url));

/** matplotlib's viridis at 0, 1/4 .. 1 (cm.viridis, matplotlib 3.10). */
const VIRIDIS = [
  [68, 1, 84],
  [59, 82, 139],
  [33, 145, 140],
  [94, 201, 98],
  [253, 231, 37],
];

test("layers are painted from the module's memory onto either kind of canvas", async ({ page }) => {
  await page.route("**/pkg/**", (route) => route.fulfill({ path: PACKAGE + route.request().url().split("/pkg/")[1] }));
  await page.goto("./shortest.html");
  const found = await page.evaluate(async () => {
    const {
      default: init,
      Estimator,
      sample,
    } = (await import(new URL("/pkg/index.js", location.href).href)) as typeof import("../../pkg/index.js");
    await init();
    const { image, depth, light } = sample({
      surface: "bust",
      light: "colourful",
      size: 48,
      height: 40,
      angles: { beta: 20 },
    });
    const estimator = new Estimator(image, depth, { light, start: "identity" });
    await estimator.run({ maxIterations: 3 });
    const { width, height } = image;
    const own = Object.assign(document.createElement("canvas"), { width, height }).getContext("2d")!;
    const offscreen = new OffscreenCanvas(width, height).getContext("2d")!;
    const pixels = (context: typeof own | typeof offscreen) => [...context.getImageData(0, 0, width, height).data];

    const numbers = estimator.imageDepth();
    const finite = numbers.filter(Number.isFinite).sort();
    const range = [finite[0]!, finite.at(-1)!] as const;
    estimator.draw(own, "depth", { range });
    estimator.draw(offscreen, "depth", { range });
    const drawn = { own: pixels(own), offscreen: pixels(offscreen) };
    estimator.draw(own, "normals");
    const normals = { drawn: pixels(own), numbers: [...estimator.imageNormals()] };
    const refusals = [
      () => estimator.draw({} as CanvasRenderingContext2D, "depth"),
      () => estimator.draw(own, "deep" as "depth"),
      () => estimator.draw(own, "depth", { range: [1, 1] }),
      () => estimator.draw(own, "depth", { map: "jet" as "magma" }),
    ].map((call) => {
      try {
        return String(call());
      } catch (error) {
        return (error as Error).message;
      }
    });
    // The other layers of the view are painted too.
    const shares = (["residual", "refined", "refinedNormals"] as const).map((layer) => {
      own.clearRect(0, 0, width, height);
      estimator.draw(own, layer, { map: "magma" });
      return pixels(own).filter((value, index) => index % 4 === 3 && value === 255).length / (width * height);
    });
    estimator.free();
    return { numbers: [...numbers], range, drawn, normals, refusals, shares };
  });

  const { numbers, range, drawn, normals, refusals, shares } = found;
  expect(drawn.offscreen).toEqual(drawn.own);
  let compared = 0;
  numbers.forEach((value, index) => {
    const [r, g, b, opacity] = drawn.own.slice(4 * index, 4 * index + 4);
    expect(opacity).toBe(Number.isNaN(value) ? 0 : 255);
    const quarter = (4 * (value - range[0])) / (range[1] - range[0]);
    if (!(Math.abs(quarter - Math.round(quarter)) < 0.008)) return;
    VIRIDIS[Math.round(quarter)]!.forEach((wanted, channel) =>
      expect(Math.abs([r, g, b][channel]! - wanted)).toBeLessThanOrEqual(4),
    );
    compared++;
  });
  expect(compared).toBeGreaterThan(4);
  normals.numbers.forEach((value, index) => {
    const [pixel, axis] = [Math.floor(index / 3), index % 3];
    if (Number.isNaN(value)) return expect(normals.drawn[4 * pixel + 3]).toBe(0);
    expect(
      Math.abs(normals.drawn[4 * pixel + axis]! - 127.5 * (1 + (axis === 0 ? value : -value))),
    ).toBeLessThanOrEqual(1);
  });
  expect(refusals[0]).toContain("context: must be the 2D context of a canvas");
  expect(refusals[1]).toContain("layer");
  expect(refusals[2]).toContain("options.range");
  expect(refusals[3]).toContain("options.map");
  for (const share of shares) expect(share).toBeGreaterThan(0.2);
});

test("the shortest page shows normals and depth", async ({ page }) => {
  await page.goto("./shortest.html");
  await expect(page.locator("#out")).toContainText("converged");
  for (const id of ["normals", "depth"]) {
    const colours = await page.locator(`#${id}`).evaluate((canvas: HTMLCanvasElement) => {
      const { data } = canvas.getContext("2d")!.getImageData(0, 0, canvas.width, canvas.height);
      return new Set(new Uint32Array(data.buffer)).size;
    });
    expect(colours).toBeGreaterThan(50);
  }
});

test("the Lab's pictures are the module's own, pixel by pixel", async ({ lab, page }) => {
  await page.route("**/pkg/**", (route) => route.fulfill({ path: PACKAGE + route.request().url().split("/pkg/")[1] }));
  await lab.open("size=64&beta=20");
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  for (const [name, value] of [
    ["Depth: lowest", "-9"],
    ["Depth: highest", "7.5"],
    ["Refined depth: lowest", "30"],
    ["Refined depth: highest", "60"],
    ["Colour residual: highest", "0.25"],
  ] as const) {
    await page.getByLabel(`${name} value shown`, { exact: true }).fill(value);
    await page.keyboard.press("Enter");
  }
  const differences = () =>
    page.evaluate(async () => {
      const {
        default: init,
        Estimator,
        sample,
      } = (await import(new URL("/pkg/index.js", location.href).href)) as typeof import("../../pkg/index.js");
      await init();
      const { image, depth, light } = sample({ surface: "bust", light: "colourful", size: 64, angles: { beta: 20 } });
      const estimator = new Estimator(image, depth, {
        light,
        start: "identity",
        registration: "icp",
        shading: "pixel",
      });
      estimator.step();
      const layers = [
        ["Normals", image, "normals", {}],
        ["Depth", image, "depth", { range: [-9, 7.5] }],
        ["Refined depth", depth, "refined", { range: [30, 60] }],
        ["Refined normals", depth, "refinedNormals", {}],
        ["Colour residual", image, "residual", { range: [0, 0.25], map: "magma" }],
      ] as const;
      const found = layers.map(([title, { width, height, mask }, layer, options]) => {
        const context = Object.assign(document.createElement("canvas"), { width, height }).getContext("2d")!;
        estimator.draw(context, layer, options);
        // The Lab crops to the object with a margin of two pixels.
        const inside = Array.from(mask ?? []).flatMap((value, i) =>
          value ? [[i % width, Math.floor(i / width)] as const] : [],
        );
        const [left, top] = [0, 1].map((axis) => Math.max(0, Math.min(...inside.map((pixel) => pixel[axis]!)) - 2)) as [
          number,
          number,
        ];
        const shown = document.querySelector<HTMLCanvasElement>(`canvas[aria-label^="${title}:"]`)!;
        const mine = context.getImageData(left, top, shown.width, shown.height).data;
        const theirs = shown.getContext("2d")!.getImageData(0, 0, shown.width, shown.height).data;
        return [
          title,
          mine.filter((value, i) => value !== theirs[i]).length,
          new Set(new Uint32Array(mine.buffer)).size > 20,
        ] as const;
      });
      estimator.free();
      return found;
    });
  await expect
    .poll(differences)
    .toEqual(
      ["Normals", "Depth", "Refined depth", "Refined normals", "Colour residual"].map((title) => [title, 0, true]),
    );
});

test("the page's own colours, for what the module has no layer for, are the module's", async ({ lab }) => {
  // Before the first step, the refined depth (painted by the module) equals the given one (painted by the page), on the same scale.
  await lab.open("size=64");
  const [given, refined] = await Promise.all(
    ["Given depth", "Refined depth"].map((title) =>
      lab.page
        .locator(`canvas[aria-label^="${title}:"]`)
        .evaluate((canvas: HTMLCanvasElement) => [
          ...canvas.getContext("2d")!.getImageData(0, 0, canvas.width, canvas.height).data,
        ]),
    ),
  );
  const both = given!.flatMap((value, i) => (given![i | 3] && refined![i | 3] ? [Math.abs(value - refined![i]!)] : []));
  expect(both.length).toBeGreaterThan(4000);
  both.sort((a, b) => a - b);
  expect(both[Math.floor(0.98 * both.length)]).toBeLessThanOrEqual(6);
});
