/** The Lab in front of people: steps do what their names say, map and verdict agree, examples and colours explain themselves. */

import type { Page } from "@playwright/test";
import type { StepReport } from "../../pkg/index.js";
import { expect, test, type Lab } from "./lab";
import { open } from "./figure";
import { answerChecks } from "./rig";
import { heading, openExample, run } from "./rigsteps";

const words = "#score-words";

test("a stage is the whole search, and a step the whole first iteration", async ({ lab, page }) => {
  await lab.visit("size=64");
  await page.getByRole("button", { name: "Stage", exact: true }).click();
  await lab.reaches("paused");
  await expect(page.locator("#message")).toContainText("100 %");
  await expect(lab.iteration).toHaveText("0");
  const searched = await page.locator(words).textContent();
  // Between two stages of the first iteration the run is paused, not ready.
  await page.getByRole("button", { name: "Stage", exact: true }).click();
  await expect(page.locator("#pose-found")).toHaveText("start");
  await lab.reaches("paused");
  await page.getByRole("button", { name: "Reset", exact: true }).click();
  await lab.reaches("ready");
  await page.getByRole("button", { name: "Step", exact: true }).click();
  await expect(lab.iteration).toHaveText("1");
  await lab.reaches("paused");
  await expect(page.locator(words)).toHaveText(searched ?? "");
  await page.locator("#pace").selectOption({ label: "fastest" });
  await page.getByRole("button", { name: "Play", exact: true }).click();
  await lab.reaches("converged");
  // The map is that of the whole search, however the run was advanced, also if it was only played.
  await expect(page.locator(words)).toHaveText(searched ?? "");
  await page.getByRole("button", { name: "Reset", exact: true }).click();
  await lab.reaches("ready");
  await page.getByRole("button", { name: "Play", exact: true }).click();
  await lab.reaches("converged");
  await expect(page.locator(words)).toHaveText(searched ?? "");
  expect(lab.complaints).toEqual([]);
});

test("a search that is being stepped through can be paused", async ({ lab, page }) => {
  await lab.visit("size=128&light=window&beta=40&noise=0.01");
  await page.getByRole("button", { name: "Step", exact: true }).click();
  await page.getByRole("button", { name: "Pause", exact: true }).click();
  await lab.reaches("paused");
  await expect(lab.iteration).toHaveText("0");
});

test("the example that is too hard is too hard for the search as well", async ({ lab, page }) => {
  await lab.visit("size=32");
  await page.locator("#pace").selectOption({ label: "fastest" });
  await page.getByRole("button", { name: "Too hard", exact: true }).click();
  await lab.reaches("lost");
  const map = (await page.locator("#score-canvas").getAttribute("aria-label")) ?? "";
  const [, beta, alpha] = /best one is (-?\d+) degrees .* and (-?\d+) about/.exec(map.replaceAll("−", "-")) ?? [];
  // The true rotation is 70 degrees about the vertical axis. Neighbours on the map are 16 degrees apart.
  expect(Math.hypot(Number(beta) - 70, Number(alpha))).toBeGreaterThan(24);
  expect(await lab.errorDegrees()).toBeGreaterThan(24);
  // Only the words tell how many rotations score alike: many in this scene, few in an easy one.
  const alike = async () => {
    const said = / (none|\d+) within 5 % of the best$/.exec((await page.locator(words).textContent()) ?? "")?.[1];
    return said === "none" ? 0 : Number(said);
  };
  const here = await alike();
  await page.getByRole("button", { name: "Easy bust", exact: true }).click();
  await lab.reaches("converged");
  expect(here).toBeGreaterThan(3 * (await alike()));
});

test("an example says in a line what it shows, without a tooltip", async ({ lab, page }) => {
  await lab.visit("size=32");
  await expect(page.locator("#example")).toBeEmpty();
  for (const name of ["Noise", "Too hard"]) {
    const button = page.getByRole("button", { name, exact: true });
    await button.click();
    await expect(page.locator("#example")).toHaveText(`${name}: ${await button.getAttribute("title")}`);
  }
});

/** Runs this function on every report that the page gets. Must be called before the page opens. */
async function changeReports(page: Page, change: (report: StepReport) => void): Promise<void> {
  await page.addInitScript(`{
    const change = ${change};
    const { set } = Object.getOwnPropertyDescriptor(Worker.prototype, "onmessage");
    Object.defineProperty(Worker.prototype, "onmessage", {
      set(listen) {
        set.call(this, (event) => {
          event.data?.reply?.reports?.forEach(change);
          listen.call(this, event);
        });
      },
    });
  }`);
}

async function playThrough(lab: Lab): Promise<void> {
  await lab.open("size=32");
  await lab.page.locator("#pace").selectOption({ label: "fastest" });
  await lab.page.getByRole("button", { name: "Play", exact: true }).click();
}

/** The report's pose, rotated about z by each of these angles, as its alternatives. */
async function turnRivals(page: Page, angles: string): Promise<void> {
  await changeReports(
    page,
    Object.assign(() => {}, {
      toString: () => `(report) => {
        const [a, b, c, d, e, f, ...rest] = report.pose.rotation;
        report.rivals = [${angles}].map((degrees) => {
          const [cos, sin] = [Math.cos((degrees * Math.PI) / 180), Math.sin((degrees * Math.PI) / 180)];
          const rows = [cos * a - sin * d, cos * b - sin * e, cos * c - sin * f, sin * a + cos * d, sin * b + cos * e];
          return { ...report.pose, rotation: [...rows, sin * c + cos * f, ...rest] };
        });
      }`,
    }),
  );
}

test("a pose that is nearly the best one is no alternative to it", async ({ lab, page }) => {
  await turnRivals(page, "1, 4, 40");
  await playThrough(lab);
  await expect(page.locator("#rivals").getByRole("button")).toHaveText([
    "best pose",
    "alternative, 4° away",
    "alternative, 40° away",
  ]);
});

test("as many alternatives can be chosen as the words count", async ({ lab, page }) => {
  await turnRivals(page, "10, 20, 30, 40, 50");
  await playThrough(lab);
  await expect(page.locator("#rivals").getByRole("button", { name: /^alternative, / })).toHaveCount(5);
  // The errors of the best pose and of the alternative stand side by side, with the same decimals.
  await page.getByRole("button", { name: "alternative, 10° away" }).click();
  await expect(page.locator("#pose-error")).toHaveText(/^\d+\.\d\d° from the true rotation \(best pose: \d+\.\d\d°\)$/);
});

test("a pose that is right although the run does not trust it is said to be right", async ({ lab, page }) => {
  await changeReports(page, (report) => {
    if (report.status === "converged") report.status = "lost";
  });
  await playThrough(lab);
  await lab.reaches("lost");
  expect(await lab.errorDegrees()).toBeLessThan(1);
  await expect(page.locator("#next")).toContainText("The pose is nevertheless right.");
});

test("the legend of the surfaces is that of their colours", async ({ lab, page }) => {
  await lab.open("size=32");
  const legend = page.locator("#clouds-legend");
  await expect(legend.getByText("depth map in the estimated pose")).toBeVisible();
  await page.locator("#clouds-texture").selectOption("normals");
  await expect(legend).toContainText("right red, up green");
  await expect(legend.getByText("depth map in the estimated pose")).toBeHidden();
  await page.locator("#clouds-texture").selectOption("residual");
  await expect(legend.locator(".bar")).toBeVisible();
  await page.locator("#clouds-texture").selectOption("picture");
  await expect(legend).toContainText("colours of the picture; grey: depth map");
  await page.locator("#clouds-texture").selectOption("view");
  await expect(legend.locator(".bar")).toHaveCount(0);
  await expect(legend.getByText("depth map in the estimated pose")).toBeVisible();
});

test("all that a verdict says can be read without scrolling in its panel", async ({ lab, page }) => {
  await lab.open("size=32");
  const cut = await page.locator("#panel").evaluate((panel) => {
    const next = panel.querySelector("#next");
    if (next) next.textContent = "Only a tenth of the depth pixels have a counterpart in the image. ".repeat(20);
    return panel.scrollHeight - panel.clientHeight;
  });
  expect(cut).toBeLessThanOrEqual(0);
});

test("Export says that it has saved, or that there is nothing", async ({ lab, page }) => {
  await lab.open("size=32");
  const exporting = page.locator("#export");
  const saved = page.waitForEvent("download");
  await exporting.click();
  await saved;
  await expect(exporting).toHaveText("Saved");
  const said = page.locator("#exported");
  await expect(said).toHaveText("Saved bimodal-stereo-report.json: settings, poses and all iterations of this run.");
  await expect(exporting).toHaveText("Export");
  await open(page, "at=grey");
  await expect(said).toBeEmpty();
  await exporting.click();
  await expect(said).toHaveText("Saved bimodal-stereo-lesson-grey.json: settings and numbers of this figure.");
  await page.getByRole("link", { name: "Exercises", exact: true }).click();
  await exporting.click();
  await expect(exporting).toHaveText("Nothing to export");
});

test("Export says on an empty rig that there is nothing, and what is saved later is not its own", async ({
  lab,
  page,
}) => {
  await answerChecks(page, "off");
  await page.goto("./#rig");
  const exporting = page.locator("#export");
  await expect(heading(page, "1. Files and cameras")).toBeVisible();
  await exporting.click();
  await expect(exporting).toHaveText("Nothing to export");
  await expect(exporting).toHaveText("Export");
  await openExample(page);
  await run(page);
  const saved = page.waitForEvent("download");
  await page.getByRole("button", { name: "Save numbers (JSON)" }).click();
  await saved;
  await expect(exporting).toHaveText("Export");
  await expect(page.locator("#exported")).toBeEmpty();
  // With a verdict the same button saves it.
  const exported = page.waitForEvent("download");
  await exporting.click();
  await exported;
  await expect(exporting).toHaveText("Saved");
  expect(lab.complaints).toEqual([]);
});

test("the address has what is shown, and nothing that was not followed", async ({ lab, page }) => {
  await lab.visit("size=100000&a=b&beta=30");
  await expect(page).toHaveURL(/#beta=30$/);
  await lab.visit("a=b");
  await expect(page).toHaveURL(/\/$/);
});

test("a stand plays by itself again after some silence, wherever the last visitor has gone", async ({ lab, page }) => {
  await page.goto("./?kiosk=2#size=32&light=window");
  await lab.reaches("ready");
  await page.getByRole("link", { name: "Tables", exact: true }).click();
  await expect(page.locator("#tables")).toBeVisible();
  await expect(page.locator("#lab")).toBeVisible();
  await expect(page.locator("#status")).toHaveAttribute("data-state", /^(playing|converged|ambiguous|lost)$/);
  await expect(page).toHaveURL(/\?kiosk=2#/);
  expect(lab.complaints).toEqual([]);
});

test("a stand shows a lesson as it was at first, whatever the last visitor has set", async ({ lab, page }) => {
  await page.goto("./?kiosk=3#learn&at=grey");
  const turn = page.locator('.learn-figure input[name="turn"]');
  await expect(turn).toHaveValue("60");
  await turn.press("ArrowRight");
  await expect(turn).toHaveValue("61");
  await page.getByRole("link", { name: "Three colours", exact: true }).click();
  await expect(page.getByRole("heading", { name: "Three colours" })).toBeVisible();
  await expect(turn).toHaveValue("60");
  await expect(page).toHaveURL(/\?kiosk=3#learn&at=grey$/);
  expect(lab.complaints).toEqual([]);
});

test("the light can be dragged on a laptop's first screen, whatever the verdict says", async ({ lab, page }) => {
  await page.setViewportSize({ width: 1280, height: 720 });
  await lab.visit("size=32");
  await page.locator("#pace").selectOption({ label: "fastest" });
  await page.getByRole("button", { name: "Too hard", exact: true }).click();
  await lab.reaches("lost");
  const [light, bar] = await Promise.all(
    [page.getByRole("img", { name: /^A ball under the true light/ }), page.locator("#bar")].map((box) =>
      box.boundingBox(),
    ),
  );
  expect((light?.y ?? Infinity) + (light?.height ?? 0)).toBeLessThanOrEqual(bar?.y ?? 0);
});

test("the card of a pixel covers neither the status nor the buttons at the top", async ({ lab, page }) => {
  await lab.open("size=32");
  const canvas = await page.locator('canvas[aria-label^="Colour:"]').boundingBox();
  if (!canvas) throw new Error("There is no picture.");
  await page.mouse.move(canvas.x + canvas.width / 2, canvas.y + canvas.height / 2);
  const card = await page.locator("#probe").boundingBox();
  const top = await page.locator("header.top").boundingBox();
  expect(card?.y).toBeGreaterThan((top?.y ?? 0) + (top?.height ?? 0));
});

test("the pose has an explanation beside its title", async ({ lab, page }) => {
  await lab.open("size=32");
  await page.getByRole("button", { name: 'What is "Pose"?' }).click();
  const said = page.locator("#explanation");
  await expect(said).toContainText("does not determine the translation along z");
  await expect(said).toContainText("even a depth map that is only rotated about the object has a translation");
});

test("with forced colours the current place, a pressed example and the legend's dots are still marked", async ({
  lab,
  page,
}) => {
  await page.emulateMedia({ forcedColors: "active" });
  await lab.visit("size=32");
  await page.getByRole("button", { name: "Noise", exact: true }).click();
  await expect(page.locator("#presets button[aria-pressed=true]")).toHaveText("Noise");
  await page.locator("#play").focus();
  const outline = (selector: string) =>
    page.locator(selector).evaluate((element) => getComputedStyle(element).outlineStyle);
  expect(await outline("#presets button[aria-pressed=true]")).toBe("solid");
  expect(await outline(".top nav a[aria-current]")).toBe("solid");
  expect(await outline("#presets button[aria-pressed=false] >> nth=0")).toBe("none");
  const dots = await page
    .locator("#clouds-legend .key")
    .evaluateAll((keys) => keys.map((key) => getComputedStyle(key, "::before").backgroundColor));
  const behind = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  expect(new Set([...dots, behind]).size).toBe(3);
});
