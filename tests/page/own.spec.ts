/** The visitor's own files: dropped anywhere, recognised, and shown at once. */

import { readFile } from "node:fs/promises";
import { encode } from "fast-png";
import { LONG, expect, test } from "./lab";
import { Messages } from "./messages";
import { own, put, slot } from "./ownfiles";
import {
  SIDE,
  cameraJson,
  cloudPly,
  colourPng,
  columnNpy,
  depthPfm,
  depthPgm,
  depthPng,
  depthTiff,
  drop,
  maskPng,
  type Upload,
} from "./uploads";

/** A grey 8-bit picture, which can be either view. */
const greyPng = (name: string): Upload => ({
  name,
  mimeType: "image/png",
  buffer: Buffer.from(
    encode({
      width: SIDE,
      height: SIDE,
      channels: 1,
      depth: 8,
      data: Uint8Array.from({ length: SIDE * SIDE }, (_, i) => 40 + ((7 * i) % 190)),
    }),
  ),
});

test("four files and a camera dropped anywhere go where their content belongs, each shown at once", async ({
  lab,
  page,
}) => {
  await lab.open("size=32");
  await drop(page, "body", [maskPng("1.png"), cameraJson("2.json"), columnNpy("3.npy"), colourPng("4.png")]);
  await expect(slot(lab, 0)).toContainText("4.png");
  await expect(slot(lab, 0)).toContainText("48x48, 8-bit RGB");
  await expect(slot(lab, 1)).toContainText("3.npy");
  await expect(slot(lab, 1)).toContainText(/48x48, 16-bit, 5\d\.\d % valid, stored numbers 100 to/);
  await expect(slot(lab, 2)).toContainText("1.png");
  await expect(slot(lab, 2)).toContainText("a mask of 5");
  await expect(page.locator(".remarks")).toContainText("The depth map has no mask");
  for (const [index, name] of [
    [0, "4.png"],
    [1, "3.npy"],
    [2, "1.png"],
  ] as const) {
    await expect(slot(lab, index).getByRole("img", { name: `Preview of ${name}` })).toHaveAttribute(
      "width",
      String(SIDE),
    );
  }
  await lab.reaches("ready");
  // Registered pictures of one camera share its parameters.
  for (const side of ["colour", "depth"]) {
    await expect(page.locator(`#fields-${side}`).getByLabel("fx", { exact: true })).toHaveValue("61");
    await expect(page.locator(".remarks")).toContainText(`2.json: the ${side} camera`);
  }
  await expect(page).toHaveURL(/colour\.fx=61.*depth\.fx=61/);
  await page.getByRole("button", { name: "Undo" }).click();
  await expect(page.locator("#fields-colour").getByLabel("fx", { exact: true })).toHaveValue("");
});

test("a slot that is filled keeps its height, and moves no other", async ({ lab, page }) => {
  await lab.open();
  await lab.unfold();
  await page.locator("#origin-files").click();
  const places = () =>
    page.locator(".slot .drop").evaluateAll((zones) =>
      zones.map((zone) => {
        const { top, height } = zone.getBoundingClientRect();
        return [top, height];
      }),
    );
  const before = await places();
  await drop(page, "#lab", [
    colourPng("with-a-name-that-is-longer-than-its-slot-is-wide.png"),
    depthPng(),
    cameraJson(),
  ]);
  await expect(slot(lab, 1).getByRole("img")).toBeVisible();
  await expect(slot(lab, 1)).toContainText("% valid");
  expect(await places()).toEqual(before);
});

test("what is too large for a preview says its name, its size and that, below each other", async ({ lab }) => {
  await own(lab);
  const wide = Buffer.from(
    encode({ width: 8200, height: 16, channels: 3, depth: 8, data: new Uint8Array(8200 * 16 * 3).fill(90) }),
  );
  const name = "a-photograph-with-a-name-that-is-longer-than-its-slot.png";
  await put(lab, "Colour image", { ...colourPng(name), buffer: wide });
  const card = slot(lab, 0);
  await expect(card.locator(".says")).toHaveText("8200x16, too large for a preview");
  const [title, file, says, drop, close] = await Promise.all(
    ["strong", ".file-name", ".says", ".drop", ".quiet"].map((part) => card.locator(part).first().boundingBox()),
  );
  if (!title || !file || !says || !drop || !close) throw new Error("all parts of the card are seen");
  expect(file.x).toBe(title.x);
  expect(file.y).toBeGreaterThanOrEqual(title.y + title.height);
  expect(file.y).toBeGreaterThanOrEqual(close.y + close.height - 4);
  expect(says.x).toBe(title.x);
  expect(says.y).toBeGreaterThanOrEqual(file.y + file.height);
  // The name is truncated, but its size is not.
  await expect(card.locator(".file-name")).toHaveText(/ \(1 kB\)$/);
  expect(
    await card.locator(".file-name").evaluate(({ scrollWidth, clientWidth }) => scrollWidth - clientWidth),
  ).toBeLessThanOrEqual(0);
});

test(
  "depth maps in TIFF, PGM and PFM are the same picture as the PNG, wherever they are dropped",
  LONG,
  async ({ lab, page }) => {
    await own(lab);
    await put(lab, "Colour image", colourPng());
    await put(lab, "Depth map", depthPng());
    await lab.reaches("ready");
    const rows = await lab.fingerprint("Given depth");
    for (const file of [depthTiff(), depthPgm(), depthPfm()]) {
      await drop(page, "body", [file]);
      await expect(slot(lab, 1)).toContainText(file.name);
      await expect(slot(lab, 1)).toContainText(/48x48, .*stored numbers 100 to/);
      await lab.reaches("ready");
      expect(await lab.fingerprint("Given depth"), file.name).toBe(rows);
    }
    // A colour image of another format, and a cloud with its own points, run as well.
    const fixture = async (name: string): Promise<Upload> => ({
      name,
      mimeType: "",
      buffer: await readFile(new URL(`../fixtures/rig/${name}`, import.meta.url)),
    });
    await drop(page, "body", [await fixture("colour.tif")]);
    await expect(slot(lab, 0)).toContainText("colour.tif");
    await lab.reaches("ready");
    await put(lab, "Depth map", cloudPly());
    await expect(slot(lab, 1)).toContainText("d.ply");
    await lab.reaches("ready");
    // The reader's objection to a file is shown in its slot.
    await put(lab, "Depth map", await fixture("large-b44.exr"));
    await expect(slot(lab, 1)).toContainText("has lossy compression");
    await put(lab, "Depth map", await fixture("colour.jpg"));
    await expect(slot(lab, 1)).toContainText("a colour picture where a depth map");
    await lab.reaches("error");
    const cut = depthTiff("cut.tif");
    await put(lab, "Depth map", { ...cut, buffer: cut.buffer.subarray(0, 900) });
    await lab.reaches("error");
    await expect(slot(lab, 1).locator(".note.error").filter({ visible: true }).last()).toContainText(
      /cut\.tif: .*(cut off|end)/,
    );
  },
);

test("a .npy in column order is the same picture as the PNG it was made of", async ({ lab }) => {
  await own(lab);
  await put(lab, "Colour image", colourPng());
  await put(lab, "Depth map", depthPng());
  await lab.reaches("ready");
  const rows = await lab.fingerprint("Given depth");
  await put(lab, "Depth map", columnNpy());
  await expect(slot(lab, 1)).toContainText("d.npy");
  await lab.reaches("ready");
  expect(await lab.fingerprint("Given depth")).toBe(rows);
});

test("swapped files are offered to be swapped, and then run", async ({ lab, page }) => {
  await own(lab);
  await put(lab, "Colour image", depthPng("first.png"));
  await put(lab, "Depth map", colourPng("second.png"));
  await expect(page.locator(".offer")).toContainText("Colour and depth seem to be swapped.");
  await lab.reaches("error");
  // The error is also shown at the verdict, since the settings may be closed.
  await expect(page.locator("#verdict")).toContainText(
    "second.png: it is a colour picture where a depth map was expected",
  );
  await expect(page.locator("#next")).toHaveText("Colour and depth seem to be swapped: Settings, Swap.");
  // The samples are not affected by the swap.
  await page.getByRole("button", { name: "Sample", exact: true }).click();
  await lab.reaches("ready");
  await expect(page.locator("#next")).not.toContainText("swapped");
  await page.getByRole("button", { name: "Own files" }).click();
  await lab.reaches("error");
  await page.getByRole("button", { name: "Swap" }).click();
  await expect(slot(lab, 0)).toContainText("second.png");
  await expect(slot(lab, 1)).toContainText("first.png");
  await lab.reaches("ready");
  await expect(page.locator(".offer")).toBeEmpty();
  await expect(page.locator("#next")).not.toContainText("swapped");
  // A grey picture can be a depth map, but a coloured one cannot.
  await put(lab, "Colour image", greyPng("grey.png"));
  await put(lab, "Depth map", colourPng("third.png"));
  await expect(page.locator("#next")).toHaveText("Colour and depth seem to be swapped: Settings, Swap.");
});

test("a run of files that seem to be in each other's places says so beside its verdict", async ({ lab, page }) => {
  await own(lab);
  await put(lab, "Colour image", depthPng("first.png"));
  await put(lab, "Depth map", greyPng("second.png"));
  await lab.reaches("ready");
  await expect(page.locator("#next")).toContainText("Colour and depth seem to be swapped");
  await page.keyboard.press("s");
  await lab.reaches("lost");
  await expect(page.locator("#next")).toContainText("Colour and depth seem to be swapped");
});

test("where there is nothing to run the player's buttons are off, and say why", async ({ lab, page }) => {
  await own(lab);
  const buttons = ["Play", "Step", "Stage", "Reset"].map((name) =>
    page.locator("#bar").getByRole("button", { name, exact: true }),
  );
  const [play] = buttons;
  const areOff = async (why: string) => {
    for (const button of buttons) {
      await expect(button).toBeDisabled();
      await expect(button).toHaveAccessibleDescription(`Nothing to run (${why})`);
    }
  };
  await areOff("waiting for both files");
  // The buttons can be focused, so that a screen reader announces the reason; pressing them changes nothing.
  await page.locator("#play").focus();
  await page.keyboard.press("Enter");
  await expect(page.locator("#play")).toBeFocused();
  await lab.reaches("waiting");
  await put(lab, "Colour image", colourPng());
  await areOff("waiting for a depth map");
  await put(lab, "Depth map", { ...depthPng("cut.png"), buffer: depthPng().buffer.subarray(0, 90) });
  await areOff("Depth map: invalid value");
  await put(lab, "Depth map", depthPng());
  await lab.reaches("ready");
  for (const button of buttons) {
    await expect(button).toBeEnabled();
    await expect(button).toHaveAccessibleDescription("");
  }
  await play?.click();
  await expect(lab.iteration).not.toHaveText("0");
});

test("while own files are read the page says so, asks for nothing that is there, and plays nothing", async ({
  lab,
  page,
}) => {
  const messages = await Messages.of(page);
  await own(lab);
  const asked = () => page.locator("#hero").evaluate((hero) => getComputedStyle(hero, "::after").content);
  const play = page.locator("#play");
  expect(await asked()).toContain("Drop a colour image and a depth map of one object");
  await put(lab, "Colour image", colourPng());
  await expect.poll(asked).toContain("Drop a depth map of the same object");
  await messages.hold("open");
  await put(lab, "Depth map", depthPng());
  await lab.reaches("loading");
  await expect(page.locator("#verdict")).toContainText("a.png");
  expect(await asked()).toContain("Reading the input");
  await expect(play).toHaveAccessibleDescription("Nothing to run (reading the input)");
  await page.locator("#hero").click({ position: { x: 5, y: 5 } });
  await page.keyboard.press(" ");
  await expect(play).toHaveAttribute("aria-pressed", "false");
  await messages.release();
  await lab.reaches("ready");
  await expect(play).toHaveAttribute("aria-pressed", "false");
  await expect(page.locator("#next")).toHaveText(/^Press play; masks, cameras/);
  // The scaling of a large picture is reported as soon as it is known.
  await page.locator("#verdict").evaluate((verdict) => {
    const said: string[] = [];
    Object.assign(window, { said });
    new MutationObserver(() => said.push(verdict.textContent)).observe(verdict, {
      childList: true,
      characterData: true,
      subtree: true,
    });
  });
  const wide = Buffer.from(
    encode({ width: 4100, height: 32, channels: 3, depth: 8, data: new Uint8Array(4100 * 32 * 3).fill(90) }),
  );
  await put(lab, "Colour image", { ...colourPng("wide.png"), buffer: wide });
  await expect
    .poll(() => page.evaluate(() => (window as unknown as { said: string[] }).said.join("|")))
    .toMatch(/wide\.png: 4100 × 32 px exceeds the library's limit; scaled down by 2\./);
});

test("of own files no true pose is known: none can be chosen, and what was chosen of a sample is not asked for", async ({
  lab,
  page,
}) => {
  await lab.visit("size=32&start=truth");
  await drop(page, "body", [colourPng(), depthPng()]);
  await lab.reaches("ready");
  const start = page.getByLabel("Start", { exact: true });
  await expect(start).toHaveValue("search");
  await expect(start.locator("option[value=truth]")).toBeDisabled();
  await expect(start.locator("option[value=near]")).toBeEnabled();
  await page.getByRole("button", { name: "Sample", exact: true }).click();
  await lab.reaches("ready");
  await expect(start).toHaveValue("truth");
  await expect(start.locator("option[value=truth]")).toBeEnabled();
});

test("a file in the wrong place is offered its own", async ({ lab, page }) => {
  await own(lab);
  await put(lab, "Colour image", depthPng("far.png"));
  await expect(page.locator(".offer")).toContainText("far.png looks like a depth map");
  await page.getByRole("button", { name: "Move it to Depth map" }).click();
  await expect(slot(lab, 1)).toContainText("far.png");
  await expect(slot(lab, 0)).not.toContainText("far.png");
  await put(lab, "Depth mask", colourPng("near.png"));
  await page.getByRole("button", { name: "Move it to Colour image" }).click();
  await expect(slot(lab, 0)).toContainText("near.png");
  await lab.reaches("ready");
});

test("what a file is called, and what is in it, stays text", async ({ lab, page }) => {
  await lab.open("size=32");
  const evil = "<img src=x onerror=document.title='owned'>";
  const camera = {
    ...cameraJson(`${evil}.json`),
    buffer: Buffer.from(JSON.stringify({ camera_name: evil, fx: 61, fy: 62, cx: 23.5, cy: 23.25 })),
  };
  await drop(page, "body", [
    colourPng(`${evil}.png`),
    depthPng(`${evil}2.png`),
    camera,
    { name: `${evil}.txt`, mimeType: "text/plain", buffer: Buffer.from(evil) },
  ]);
  await expect(slot(lab, 0)).toContainText(`${evil}.png`);
  await expect(page.locator(".remarks")).toContainText(`${evil}.txt`);
  await expect(page.locator(".remarks")).toContainText(`${evil}.json`);
  await expect(page.locator("#lab img")).toHaveCount(0);
  await expect(page).toHaveTitle("bimodal-stereo");
});

test("what can't be used is said: a recording, a second depth map, a pose; a fisheye can be", async ({ lab, page }) => {
  await lab.open("size=32");
  const fisheye = {
    ...cameraJson("eye.json"),
    buffer: Buffer.from(
      "camera_model: pinhole\ndistortion_model: equidistant\nimage_width: 48\nimage_height: 48\ncamera_matrix: {rows: 3, cols: 3, data: [61, 0, 23.5, 0, 62, 23.5, 0, 0, 1]}\ndistortion_coefficients: {rows: 1, cols: 4, data: [0.1, 0, 0, 0]}\n",
    ),
  };
  const pose = { name: "T.txt", mimeType: "text/plain", buffer: Buffer.from("1 0 0 0.1\n0 1 0 0\n0 0 1 0\n0 0 0 1\n") };
  const zip = { name: "all.zip", mimeType: "application/zip", buffer: Buffer.from("PK\x03\x04rest") };
  await drop(page, "body", [colourPng(), depthPng("one.png"), depthPng("two.png"), fisheye, pose, zip]);
  const remarks = page.locator(".remarks");
  await expect(remarks).toContainText("two.png looks like a second depth map; the Lab uses only one.");
  await expect(remarks).toContainText(
    "eye.json: the colour camera, used for both images. Its numbers are in the fields below",
  );
  await expect(page.locator("#fields-colour").getByLabel("lens model")).toHaveValue("fisheye");
  await expect(remarks).toContainText("T.txt: a pose");
  await expect(remarks).toContainText("all.zip: it is a ZIP archive");
  await lab.reaches("ready");
});

test("what is wrong with a file is in sight, moves no slot, and is over with the next file", async ({ lab, page }) => {
  await own(lab);
  const zip = { name: "all.zip", mimeType: "application/zip", buffer: Buffer.from("PK\x03\x04rest") };
  const places = () =>
    page.locator(".slot .drop").evaluateAll((zones) => zones.map((zone) => zone.getBoundingClientRect().top));
  for (const [width, height] of [
    [1280, 800],
    [390, 844],
  ] as const) {
    await page.setViewportSize({ width, height });
    const before = await places();
    await drop(page, "body", [zip]);
    const remark = page.locator(".remarks").getByText("all.zip: it is a ZIP archive");
    await expect(remark).toBeInViewport({ ratio: 1 });
    expect(await places()).toEqual(before);
    // Nothing covers it.
    expect(
      await remark.evaluate((words) => {
        const { left, top, width, height } = words.getBoundingClientRect();
        return words.contains(document.elementFromPoint(left + width / 2, top + height / 2));
      }),
    ).toBe(true);
    await put(lab, "Colour image", colourPng(`a${width}.png`));
    await expect(slot(lab, 0)).toContainText(`a${width}.png`);
    await expect(remark).toHaveCount(0);
  }
  // The remark about a slot's own file is next to the slot, however far down.
  await put(lab, "Depth map", depthPng());
  await put(lab, "Depth mask", { ...maskPng("cut.png"), buffer: maskPng().buffer.subarray(0, 60) });
  await lab.reaches("error");
  await expect(slot(lab, 3).locator(".note.error").filter({ visible: true }).last()).toBeInViewport({ ratio: 1 });
  // After switching to the samples and back, nothing remains of a file that failed.
  await drop(page, "body", [zip]);
  await expect(page.locator(".remarks")).toBeVisible();
  await page.getByRole("button", { name: "Sample", exact: true }).click();
  await lab.reaches("ready");
  await page.getByRole("button", { name: "Own files" }).click();
  await expect(page.locator(".remarks")).toBeHidden();
});

test("of two grey pictures the one called depth is the depth map", async ({ lab, page }) => {
  await lab.open("size=32");
  await drop(page, "body", [greyPng("depth.png"), greyPng("photo.png")]);
  await expect(slot(lab, 0)).toContainText("photo.png");
  await expect(slot(lab, 1)).toContainText("depth.png");
});

test("while files are dragged over the page it says what may be dropped", async ({ lab, page }) => {
  await lab.open("size=32");
  const carried = await page.evaluateHandle(() => {
    const transfer = new DataTransfer();
    transfer.items.add(new File([], "a.png"));
    return transfer;
  });
  await page.locator("#hero").dispatchEvent("dragover", { dataTransfer: carried });
  await expect(page.locator("#lab")).toHaveAttribute("data-over", "");
  await page.locator("#hero").dispatchEvent("dragleave", { dataTransfer: carried });
  await expect(page.locator("#lab")).not.toHaveAttribute("data-over");
});
