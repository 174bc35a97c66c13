/** Check a rig: files, calibrations, verdict. If only the page is tested, the test answers in place of the check. */

import { LONG, expect, test } from "./lab";
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { encode } from "fast-png";
import { answerChecks, colourPng, depthPng, matrixFile } from "./rig";
import { heading, open, openExample, openFrames, openPair, put, run, step } from "./rigsteps";
import { atWidths, innerWidth, narrowest } from "./widths";

test("the place opens by its link and by its address, and the Lab has loaded nothing of it", async ({ lab, page }) => {
  const asked: string[] = [];
  page.on("request", (request) => asked.push(new URL(request.url()).pathname));
  await lab.open();
  const ofTheLab = [...asked];
  await page.getByRole("link", { name: "Check a rig" }).click();
  await expect(heading(page, "1. Files and cameras")).toBeVisible();
  await expect(page).toHaveTitle("Check a rig, bimodal-stereo");
  await expect(page.getByRole("button", { name: "Play" })).toBeHidden();
  await page.getByRole("button", { name: "Load an example" }).click();
  await expect(page.locator(".rig-frame").first()).toBeVisible();
  // The Lab had not loaded any of the check's files.
  const later = asked.slice(ofTheLab.length).filter((path) => /\.(js|css|wasm)$/.test(path));
  expect(later.length).toBeGreaterThan(1);
  for (const path of later) if (!path.endsWith(".wasm")) expect(ofTheLab).not.toContain(path);
  expect(ofTheLab.filter((path) => /rig|calibration/i.test(path))).toEqual([]);
  await open(page);
  await expect(page.getByRole("link", { name: "Check a rig" })).toHaveAttribute("aria-current", "page");
});

test("the example loads with one press: frames, cameras and a calibration", async ({ lab, page }) => {
  await openExample(page);
  for (const side of ["Colour", "Depth"])
    await expect(page.getByRole("group", { name: `${side} camera` }).locator(".rig-camera-numbers")).toHaveText(
      /^fx [\d.]+, .*px; /,
    );
  await page.getByRole("button", { name: "Next: your calibration" }).click();
  await expect(page.locator(".rig-candidate")).toHaveCount(2);
  await expect(page.locator(".rig-words").first()).toHaveText(
    /^The depth camera sits [\d.]+ mm .+ the colour camera, rotated by [\d.]+°\.$/,
  );
  expect(lab.complaints).toEqual([]);
});

test("steps go back, by their buttons and by the browser's, and nothing is lost", async ({ lab, page }) => {
  await openFrames(page);
  await expect(step(page, "Verdict")).toBeEnabled();
  await step(page, "Your calibration").click();
  await expect(page).toHaveURL(/#rig&step=calibration$/);
  await expect(heading(page, "2. Your calibration")).toBeFocused();
  await page.getByRole("button", { name: "Back" }).click();
  await expect(heading(page, "1. Files and cameras")).toBeVisible();
  await step(page, "Verdict").click();
  await page.goBack();
  await expect(page.locator(".rig-frame")).toHaveCount(3);
  await page.getByRole("link", { name: "Lab" }).click();
  await lab.reaches("ready");
  await page.getByRole("link", { name: "Check a rig" }).click();
  await expect(page.locator(".rig-frame")).toHaveCount(3);
  // A step without content leads to the first step.
  await page.getByRole("button", { name: "Start over" }).click();
  await expect(page.getByText("stay in this browser")).toBeHidden();
  await page.goto("about:blank");
  await page.goto("./#rig&step=verdict");
  await expect(heading(page, "1. Files and cameras")).toBeVisible();
  await expect(step(page, "Verdict")).toBeDisabled();
});

test("calibrations from a file, pasted and typed in; inverted twice they are what they were", async ({ lab, page }) => {
  await openPair(page);
  await page.getByRole("button", { name: "Next: your calibration" }).click();
  await expect(page.getByText("No calibration given")).toBeVisible();
  await page.locator("#rig .rig-step:not([hidden]) input[type=file]").setInputFiles(matrixFile("factory.txt", 0.025));
  const words = page.locator(".rig-words");
  await expect(words).toHaveText("The depth camera sits 25.0 mm to the right of the colour camera, rotated by 0.00°.");
  await page.getByRole("button", { name: "Invert factory" }).click();
  await expect(words).toContainText("25.0 mm to the left of");
  await expect(page.locator(".rig-candidate")).toContainText("inverted");
  await page.getByRole("button", { name: "Invert factory" }).click();
  await expect(words).toContainText("25.0 mm to the right of");

  await page.getByLabel("Or paste it in any of these formats").fill("1 0 0 0\n0 1 0 0.01\n0 0 1 0\n0 0 0 1");
  await page.getByRole("button", { name: "Add what I pasted" }).click();
  await expect(words.nth(1)).toContainText("10.0 mm below");
  await expect(page.locator(".rig-candidate .rig-notes li")).toHaveCount(0);
  // A guessed unit is shown beside its calibration.
  await page.getByLabel("Or paste it in any of these formats").fill("1 0 0 25\n0 1 0 0\n0 0 1 0\n0 0 0 1");
  await page.getByRole("button", { name: "Add what I pasted" }).click();
  await expect(page.locator(".rig-candidate").nth(2)).toContainText("was guessed to be in millimetres");
  await page
    .locator(".rig-candidate")
    .nth(2)
    .getByRole("button", { name: /^Remove/ })
    .click();
  await page.getByLabel("Or paste it in any of these formats").fill("what is this");
  await page.getByRole("button", { name: "Add what I pasted" }).click();
  await expect(page.locator(".rig-step:not([hidden]) .rig-error[role=alert]").first()).toContainText("pasted text");
  const mounted = {
    from: "camera",
    to: "base_link",
    matrix: [
      [1, 0, 0, 0],
      [0, 1, 0, 0],
      [0, 0, 1, 1],
      [0, 0, 0, 1],
    ],
  };
  await page.getByLabel("Or paste it in any of these formats").fill(JSON.stringify(mounted));
  await page.getByRole("button", { name: "Add what I pasted" }).click();
  await expect(page.locator(".rig-step:not([hidden]) .rig-error[role=alert]").first()).toContainText("a robot");

  for (const [label, value] of [
    ["x, m", "0"],
    ["y, m", "0"],
    ["z, m", "-0,1"],
    ["qx", "0"],
    ["qy", "0"],
    ["qz", "1"],
  ] as const)
    await page.getByLabel(label, { exact: true }).fill(value);
  await page.getByRole("button", { name: "Add these numbers" }).click();
  await expect(page.getByText("Some numbers are missing.").last()).toBeVisible();
  await page.getByLabel("qw", { exact: true }).fill("1");
  await page.getByRole("button", { name: "Add these numbers" }).click();
  await expect(words.nth(2)).toHaveText("The depth camera sits 100.0 mm behind the colour camera, rotated by 90.00°.");
  await page.locator(".rig-candidate").nth(2).getByRole("button", { name: "Put first" }).click();
  await expect(words.first()).toContainText("100.0 mm behind");
  expect(lab.complaints).toEqual([]);
});

test("a verdict comes with its numbers, curves, shares and advice", async ({ lab, page }) => {
  await answerChecks(page, "off");
  await openExample(page);
  await run(page);
  await expect(page.locator(".rig-word")).toHaveText("Off");
  await expect(page.locator(".rig-word")).toBeFocused();
  await expect(page.locator(".rig-run").getByRole("status")).toHaveText("The check is done. Verdict: Off.");
  await expect(page.getByRole("button", { name: "Cancel" })).toBeHidden();
  await expect(page.locator(".rig-next")).toContainText("Save the calibration found here");
  await expect(page.getByLabel("Calibration", { exact: true })).toHaveValue("");
  await expect(page.locator(".rig-calibrations")).toContainText("2.04°");
  await expect(page.locator(".rig-calibrations")).toContainText("1.2 mm");
  await expect(page.locator(".rig-calibrations")).toContainText("10.70 px");
  await expect(page.locator(".rig-curves figure")).toHaveCount(6);
  await expect(page.locator(".rig-curves")).toContainText(/Minimum at −?\d+\.\d+°; ± \d+\.\d+° \(95 %\)/);
  await expect(page.getByRole("row", { name: /frame 1 50 %/ })).toBeVisible();
  // The curve about y covers a narrow interval, and its minimum over all cues lies outside. Along z the minimum lies inside.
  const curve = (title: string) => page.locator(".rig-curves figure", { hasText: title });
  await expect(curve("Rotation about y")).toContainText(/“.+” at 2\.04°/);
  await expect(curve("Rotation about y")).toContainText("the minimum lies outside this interval");
  await expect(curve("Shift along z")).not.toContainText("outside this interval");
  await expect(page.locator(".rig-placement")).toHaveText(
    /^Best fit: The depth camera sits 50\.0 mm to the right of, 3\.0 mm behind and 2\.0 mm below the colour camera, rotated by 0\.00°\. It puts 87 % of the depth points onto the image\. “.+” puts it \d+\.\d mm from there, rotated by \d+\.\d\d°\.$/,
  );
  expect(lab.complaints).toEqual([]);
});

test("a fit that shows little of the depth map is not offered for use", async ({ lab, page }) => {
  await answerChecks(page, "undecided", 0.08);
  await openExample(page);
  await run(page);
  await expect(page.locator(".rig-verdict")).toContainText("It puts 8 % of the depth points onto the image.");
  await expect(page.getByText("Check that image and depth map show the same scene").first()).toBeVisible();
  await expect(page.getByText("Save the calibration found here")).toHaveCount(0);
  expect(await page.getByLabel("Calibration", { exact: true }).locator("option").allTextContents()).not.toContain(
    "found",
  );
  expect(lab.complaints).toEqual([]);
});

test("the overlay moves between the calibration in question and the one found", async ({ lab, page }) => {
  await answerChecks(page, "off");
  await openFrames(page);
  await run(page);
  const layer = page.locator(".rig-overlay-layer");
  const print = () =>
    layer.evaluate((canvas: HTMLCanvasElement) =>
      canvas
        .getContext("2d")
        ?.getImageData(0, 0, canvas.width, canvas.height)
        .data.reduce((sum, value) => (sum * 31 + value) % 1_000_003, 7),
    );
  const slider = page.getByRole("slider", { name: "Calibration shown" });
  await expect(layer).toHaveAttribute("aria-label", /frame 1, calibration: given/);
  const before = await print();
  await page.locator(".rig-stops").getByRole("button", { name: "found" }).click();
  await expect(slider).toHaveAttribute("aria-valuetext", "found");
  await expect.poll(print).not.toBe(before);
  await slider.press("ArrowLeft");
  await expect(slider).toHaveAttribute("aria-valuetext", /^95 % of the way from .+ to found$/);
  // The picture has its full resolution: one canvas pixel for each image pixel.
  expect(await layer.evaluate((canvas: HTMLCanvasElement) => [canvas.width, canvas.height])).toEqual(
    await page
      .locator(".rig-overlay-picture > canvas")
      .first()
      .evaluate((canvas: HTMLCanvasElement) => [canvas.width, canvas.height]),
  );
  expect(lab.complaints).toEqual([]);
});

test("without a calibration there is an estimate only, and what was guessed is said", async ({ lab, page }) => {
  await answerChecks(page, "consistent");
  await openPair(page);
  await run(page);
  await expect(page.locator(".rig-word")).toHaveText("Estimated");
  await expect(page.locator(".rig-verdict")).toContainText("Guessed: the unit of depth_0001.png.");
  await page.getByRole("button", { name: "Back" }).click();
  await page.getByLabel("Or paste it in any of these formats").fill("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1");
  await page.getByRole("button", { name: "Add what I pasted" }).click();
  await step(page, "Verdict").click();
  await expect(page.getByText("have changed since this verdict")).toBeVisible();
  await page.getByRole("button", { name: "Run again" }).click();
  await expect(page.locator(".rig-word")).toHaveText("Undecided, see warnings");
  // After a right calibration, the existing choice is kept.
  await expect(page.getByLabel("Calibration", { exact: true })).toHaveValue("pasted");
  const download = page.waitForEvent("download");
  await page.getByRole("button", { name: "Save report (HTML)" }).click();
  const report = readFileSync(await (await download).path(), "utf8");
  expect(report).toContain("Guessed: the unit of depth_0001.png.");
  // Hashes identify the files later.
  expect(report).toContain(createHash("sha256").update(colourPng()).digest("hex"));
  await expect(page.getByText("have changed since this verdict")).toBeHidden();
  await expect(page.locator(".rig-history li")).toHaveCount(2);
  expect(lab.complaints).toEqual([]);
});

test("depth maps that are registered to their images are checked with the identity, by one press", async ({
  lab,
  page,
}) => {
  await answerChecks(page, "consistent");
  await openPair(page);
  await page.getByRole("button", { name: "Next: your calibration" }).click();
  await page.getByRole("button", { name: "Add the identity" }).click();
  await expect(page.locator(".rig-words")).toHaveText("The two cameras coincide: no offset, no rotation.");
  await expect(page.getByRole("button", { name: "Add the identity" })).toBeHidden();
  await expect(page.getByRole("button", { name: "Run the check" }).locator("visible=true")).toBeEnabled();
  expect(lab.complaints).toEqual([]);
});

test("clouds need no depth camera, and one that is given is not doubted", async ({ lab, page }) => {
  await open(page);
  const points = Array.from({ length: 160 * 120 }, (_, i) => `${(i % 160) - 80} ${Math.floor(i / 160) - 60} 1000`);
  const header = `ply\nformat ascii 1.0\nobj_info num_cols 160\nobj_info num_rows 120\nelement vertex ${points.length}\nproperty float x\nproperty float y\nproperty float z\nend_header\n`;
  const camera = { width: 640, height: 480, fx: 500, fy: 500, cx: 319.5, cy: 239.5 };
  await put(page, [
    { name: "color_0001.png", mimeType: "image/png", buffer: colourPng() },
    {
      name: "depth_0001.ply",
      mimeType: "application/octet-stream",
      buffer: Buffer.from(`${header}${points.join("\n")}\n`),
    },
    { name: "depth_camera.json", mimeType: "application/json", buffer: Buffer.from(JSON.stringify({ depth: camera })) },
  ]);
  await expect(page.locator(".rig-frame")).toHaveCount(1);
  const depth = page.getByRole("group", { name: "Depth camera" });
  await expect(depth).toContainText("Not needed: the depth maps are clouds");
  await expect(depth).not.toContainText("these are for");
  await expect(page.locator(".rig-missing")).not.toContainText("depth camera");
  expect(lab.complaints).toEqual([]);
});

test("what is chosen to be written stays chosen when the check runs again", async ({ lab, page }) => {
  await answerChecks(page, "consistent");
  await openFrames(page);
  await run(page);
  const out = page.locator(".rig-card", { hasText: "Export" });
  const [which, format] = [out.getByLabel("Calibration"), out.getByLabel("Format")];
  // After a right calibration, the existing choice is kept until the visitor changes it.
  await expect(which).not.toHaveValue("");
  await which.selectOption("found");
  await format.selectOption("kalibr");
  const status = page.locator(".rig-run").getByRole("status");
  await expect(status).toHaveText(/^The check is done/);
  await page.getByRole("button", { name: "Run again" }).click();
  await expect(status).toHaveText(/^The check is done/);
  await expect(format).toHaveValue("kalibr");
  await expect(which).toHaveValue("");
  expect(lab.complaints).toEqual([]);
});

test("a removed calibration can be taken back where it was, until it is there again", async ({ lab, page }) => {
  await openPair(page);
  await page.getByRole("button", { name: "Next: your calibration" }).click();
  const give = () =>
    page.locator("#rig .rig-step:not([hidden]) input[type=file]").setInputFiles(matrixFile("factory.txt", 0.025));
  const undo = page.getByRole("button", { name: /^Undo/ });
  await give();
  await page.getByRole("button", { name: "Remove factory" }).click();
  await expect(undo).toHaveText("Undo removing factory");
  await step(page, "Files and cameras").click();
  await expect(undo).toBeHidden();
  await step(page, "Your calibration").click();
  await expect(undo).toBeVisible();
  await give();
  await expect(page.locator(".rig-candidate")).toHaveCount(1);
  await expect(undo).toBeHidden();
  expect(lab.complaints).toEqual([]);
});

test("a check can be cancelled, and run again", async ({ lab, page }) => {
  await answerChecks(page, "never");
  await openFrames(page);
  await run(page);
  const status = page.locator(".rig-run").getByRole("status");
  await expect(status).toHaveText("aligning depth edges");
  await expect(page.getByRole("progressbar")).toHaveJSProperty("value", 0.4);
  await page.getByRole("button", { name: "Cancel" }).click();
  await expect(status).toHaveText("Cancelled. Files and calibrations are kept.");
  await expect(page.getByRole("button", { name: "Cancel" })).toBeHidden();
  await expect(page.getByRole("button", { name: "Run the check" }).last()).toBeFocused();
  await page.getByRole("button", { name: "Run the check" }).last().click();
  await expect(status).toHaveText("aligning depth edges");
  // Leaving the place also cancels the check, even with an immediate return.
  await page.getByRole("link", { name: "Tables" }).click();
  await page.goBack();
  await expect(status).toHaveText("Cancelled. Files and calibrations are kept.");
  expect(lab.complaints).toEqual([]);
});

test(
  "a worker that hears nothing is replaced, and the new one has read all files again",
  LONG,
  async ({ lab, page }) => {
    await answerChecks(page, "dead");
    await openPair(page);
    await run(page);
    const status = page.locator(".rig-run").getByRole("status");
    await expect(status).toHaveText("aligning depth edges");
    await page.getByRole("button", { name: "Cancel" }).click();
    await expect(status).toHaveText("Cancelled. Files and calibrations are kept.");
    await step(page, "Files and cameras").click();
    const dialog = page.getByRole("dialog");
    // The old worker got the request, and the new one answers it.
    await page.getByRole("button", { name: "Restrict what is used" }).click();
    await expect(dialog).toBeVisible();
    expect(
      await dialog
        .locator("canvas")
        .first()
        .evaluate((canvas: HTMLCanvasElement) => canvas.getContext("2d")?.getImageData(80, 60, 1, 1).data[0]),
    ).toBeGreaterThan(150);
    expect(lab.complaints).toEqual([]);
  },
);

test("starting over ends the check that runs, and undone it brings everything back", async ({ lab, page }) => {
  await answerChecks(page, "never");
  await openFrames(page);
  await run(page);
  await expect(page.locator(".rig-run").getByRole("status")).toHaveText("aligning depth edges");
  await step(page, "Files and cameras").click();
  await page.getByRole("button", { name: "Start over" }).click();
  await expect(page.locator(".rig-frame")).toHaveCount(0);
  await expect(step(page, "Verdict")).toBeDisabled();
  await page.getByRole("button", { name: "Undo starting over" }).click();
  await expect(page.locator(".rig-frame")).toHaveCount(3);
  await expect(page.getByRole("group", { name: "Depth camera" }).locator(".rig-camera-numbers")).toHaveText(/^fx/);
  await step(page, "Verdict").click();
  await expect(page.locator(".rig-run").getByRole("status")).toHaveText("Cancelled. Files and calibrations are kept.");
  await step(page, "Your calibration").click();
  await expect(page.locator(".rig-candidate")).toHaveCount(2);
  expect(lab.complaints).toEqual([]);
});

test("what a reader warned of caps the verdict, and is what to do next", async ({ lab, page }) => {
  await answerChecks(page, "consistent");
  await open(page);
  // 8-bit grey levels of a colour picture as depths, and a second frame of another size.
  const grey = Buffer.from(
    encode({
      width: 160,
      height: 120,
      channels: 1,
      data: Uint8Array.from({ length: 160 * 120 }, (_, i) => 100 + (i % 100)),
    }),
  );
  await put(page, [
    { name: "color_0001.png", mimeType: "image/png", buffer: colourPng() },
    { name: "depth_0001.png", mimeType: "image/png", buffer: grey },
  ]);
  await expect(page.locator(".rig-frame")).toHaveCount(1);
  await put(page, [
    { name: "color_0002.png", mimeType: "image/png", buffer: colourPng(80, 60) },
    { name: "depth_0002.png", mimeType: "image/png", buffer: depthPng(80, 60) },
  ]);
  await expect(page.locator(".rig-frame")).toHaveCount(2);
  const colour = page.getByRole("group", { name: "Colour camera" });
  const depth = page.getByRole("group", { name: "Depth camera" });
  await depth.getByLabel("Source of its parameters").selectOption("same");
  await expect(page.locator(".rig-missing")).toContainText(
    "the colour camera's parameters, which the depth camera shares",
  );
  await colour.getByLabel("Source of its parameters").selectOption("typed");
  for (const [label, value] of [
    ["fx, px", "150"],
    ["fy, px", "150"],
    ["cx, px", "20"],
    ["cy, px", "60"],
  ] as const)
    await colour.getByLabel(label).fill(value);
  await page.getByRole("button", { name: "Next: your calibration" }).click();
  await page.getByLabel("Or paste it in any of these formats").fill("1 0 0 0.02\n0 1 0 0\n0 0 1 0\n0 0 0 1");
  await page.getByRole("button", { name: "Add what I pasted" }).click();
  await page.getByRole("button", { name: "Run the check" }).locator("visible=true").click();
  await expect(page.locator(".rig-word")).toHaveText("Undecided, see warnings");
  const card = page.locator(".rig-verdict");
  await expect(card).toContainText("depth_0001.png: Depths of 8 bits");
  await expect(card).toContainText("frame 2: its depth map is 80×60 px, not 160×120 px");
  await expect(card).toContainText(
    "The colour camera's parameters: the principal point is far from the centre of the 160×120 px",
  );
  await expect(page.locator(".rig-next")).toContainText("with 16 bits");
  expect(lab.complaints).toEqual([]);
});

test("nothing of it sticks out from 320 to 2560 px, and targets are large enough", async ({ lab, page }) => {
  await answerChecks(page, "undecided");
  await page.setViewportSize(narrowest);
  await openFrames(page);
  const controls = page.locator("#rig :is(button, select, summary, textarea, .rig-button, input[type=text])");
  const small = () =>
    controls.evaluateAll((all) =>
      all
        .filter((each) => each.checkVisibility() && each.getBoundingClientRect().height < 43.5)
        .map((each) => each.textContent ?? ""),
    );
  const isFine = (step: string) =>
    atWidths(page, [320, 390, 1280, 2560], async (width) => {
      expect(await innerWidth(page), `${step} at ${width} px`).toBeLessThanOrEqual(width);
      expect(await small(), `${step} at ${width} px`).toEqual([]);
    });
  await isFine("files");
  await page.getByRole("button", { name: "Next: your calibration" }).click();
  await isFine("calibrations");
  await page.getByRole("button", { name: "Run the check" }).click();
  await expect(page.locator(".rig-word")).toHaveText("Undecided");
  await expect(page.locator(".rig-curves figure")).toHaveCount(6);
  await isFine("verdict");
  expect(lab.complaints).toEqual([]);
});
