/** The visitor's own files go through a rig's readers: guesses are reported and can be changed, and nothing fails silently. */

import { readFile } from "node:fs/promises";
import { encode } from "fast-png";
import init, { sample } from "../../pkg/index.js";
import { LONG, expect, test, type Lab } from "./lab";
import { Messages } from "./messages";
import { own, put, slot } from "./ownfiles";
import { SIDE, cameraJson, colourPng, depthPng, drop, maskPng, roomPng, type Upload } from "./uploads";

const middle = (SIDE - 1) / 2;
const radius = (i: number) => Math.hypot((i % SIDE) - middle, Math.floor(i / SIDE) - middle);
const image = (name: string, channels: 1 | 3, depth: 8 | 16, value: (i: number) => number): Upload => {
  const levels = Array.from({ length: channels * SIDE * SIDE }, (_, i) => value(i));
  const data = depth === 16 ? Uint16Array.from(levels) : Uint8Array.from(levels);
  const buffer = Buffer.from(encode({ width: SIDE, height: SIDE, channels, depth, data }));
  return { name, mimeType: "image/png", buffer };
};
const remarks = ({ page }: Lab) => page.locator(".remarks");
const unit = ({ page }: Lab) => page.getByLabel("Unit", { exact: true });
const unfoldDepth = ({ page }: Lab) => page.getByText("Depth camera", { exact: true }).click();

test("the unit of a depth map with a camera is guessed into its field, said, and stays once it is typed", async ({
  lab,
  page,
}) => {
  await own(lab);
  await unfoldDepth(lab);
  await drop(page, "body", [colourPng(), depthPng(), cameraJson()]);
  await lab.reaches("ready");
  await expect(unit(lab)).toHaveValue("0.001");
  const row = page.locator(".field", { has: unit(lab) });
  await expect(row).toContainText(/guessed to be millimetres, so depths are 0\.10 to 0\.\d\d m; give the unit/);
  await expect(remarks(lab)).toContainText(
    "Unit of depth: The file does not state its unit. It was guessed to be milli",
  );
  await expect(page.locator("#pose tr", { hasText: "translation along z" })).toContainText(/z\s*m/);
  // A typed unit is not a guess, and it also applies to the next depth map.
  await unit(lab).fill("0.002");
  await page.keyboard.press("Enter");
  await lab.reaches("ready");
  await expect(remarks(lab)).not.toContainText("guessed");
  await put(lab, "Depth map", depthPng("another.png"));
  await expect(slot(lab, 1)).toContainText("another.png");
  await lab.reaches("ready");
  await expect(unit(lab)).toHaveValue("0.002");
  // If the field is emptied, the unit is guessed again, for this depth map and for the next one.
  await unit(lab).fill("");
  await page.keyboard.press("Enter");
  await expect(unit(lab)).toHaveValue("0.001");
  const fifths = image("fifths.png", 1, 16, (i) => (radius(i) < 20 ? 5 * Math.round(700 - 8 * (20 - radius(i))) : 0));
  await put(lab, "Depth map", fifths);
  await expect(unit(lab)).toHaveValue("0.0002");
  await expect(remarks(lab)).toContainText("fifths of a millimetre");
});

test("without a depth camera a number stays a pixel, and what it looks like is said", async ({ lab, page }) => {
  await own(lab);
  await drop(page, "body", [colourPng(), depthPng()]);
  await lab.reaches("ready");
  await expect(remarks(lab)).toContainText(
    "Its numbers look like millimetres, but without a depth camera each counts as one pixel of depth.",
  );
  await expect(unit(lab)).toHaveValue("");
});

test("a file that gives the unit fills the field, unless the visitor has", async ({ lab, page }) => {
  const bop: Upload = {
    name: "camera.json",
    mimeType: "application/json",
    buffer: Buffer.from(
      JSON.stringify({ cx: 23.5, cy: 23.25, depth_scale: 0.1, fx: 61, fy: 62, height: SIDE, width: SIDE }),
    ),
  };
  await own(lab);
  await drop(page, "body", [colourPng(), depthPng(), bop]);
  await lab.reaches("ready");
  await expect(unit(lab)).toHaveValue("0.0001");
  await expect(remarks(lab)).toContainText("camera.json: one stored unit of depth is 0.1 mm.");
  await unfoldDepth(lab);
  await unit(lab).fill("0.5");
  await page.keyboard.press("Enter");
  await lab.reaches("ready");
  await drop(page, "body", [bop]);
  await expect(remarks(lab)).toContainText("one stored unit of depth is 0.1 mm; the unit that you typed stays.");
  await expect(unit(lab)).toHaveValue("0.5");
});

test("a mask of 16 bits is a mask, and labels are refused in words", async ({ lab, page }) => {
  await lab.open("size=32");
  const mask = (name: string, edge: number) =>
    image(name, 1, 16, (i) => (radius(i) < 20 ? 65535 : radius(i) < 20.6 ? edge : 0));
  const labels = image("objects.png", 1, 16, (i) => 1 + Math.floor((i % SIDE) / 12));
  await drop(page, "body", [mask("1.png", 0), depthPng("2.png"), colourPng("3.png"), labels]);
  await expect(slot(lab, 2)).toContainText("1.png");
  await expect(slot(lab, 2)).toContainText("16-bit grey, a mask of");
  await expect(slot(lab, 1)).toContainText("2.png");
  await expect(remarks(lab)).toContainText(
    "objects.png: its few small integers are labels of objects rather than depths. To use it anyway, choose it by hand in the settings",
  );
  await lab.reaches("ready");
  await drop(page, "body", [mask("soft.png", 30_000)]);
  await expect(slot(lab, 3)).toContainText("soft.png");
  // A file that is chosen by hand is read as its slot requires, and the page shows the reason against it.
  await put(lab, "Depth map", labels);
  await expect(slot(lab, 1)).toContainText(
    "Read as this slot requires; without the slot it would have been refused: its few small integers are labels",
  );
});

/** The ball's depths as floats in metres. */
function floatsNpy(name: string): Upload {
  const said = `{'descr': '<f4', 'fortran_order': False, 'shape': (${SIDE}, ${SIDE}), }`;
  const head = Buffer.from(`\x93NUMPY\x01\x00\x76\x00${said.padEnd(117, " ")}\n`, "latin1");
  const data = Float32Array.from({ length: SIDE * SIDE }, (_, i) =>
    radius(i) < 20 ? 1 - 0.01 * Math.sqrt(400 - radius(i) ** 2) : 0,
  );
  return { name, mimeType: "application/octet-stream", buffer: Buffer.concat([head, Buffer.from(data.buffer)]) };
}

for (const order of ["together", "the photograph first", "the depth map first"])
  test(`a grey photograph of 16 bits is the colour image beside depths in floats: ${order}`, async ({ lab, page }) => {
    const photo = image("1.png", 1, 16, (i) => (radius(i) < 20 ? 9000 + ((i * 7919) % 40_000) : 0));
    const floats = floatsNpy("2.npy");
    await own(lab);
    if (order === "together") await drop(page, "body", [floats, photo]);
    else {
      const [first, second] = order === "the photograph first" ? [photo, floats] : [floats, photo];
      await drop(page, "body", [first]);
      await expect(slot(lab, 1)).toContainText(first.name);
      await drop(page, "body", [second]);
    }
    await expect(slot(lab, 0)).toContainText("1.png");
    await expect(slot(lab, 1)).toContainText("2.npy");
    await expect(remarks(lab)).toContainText("1.png is grey and has the bits of a depth map");
    await lab.reaches("ready");
    await expect(page.locator(".offer")).toBeEmpty();
  });

test("in the slot for masks a mask of 16 bits is not said to be a depth map", async ({ lab, page }) => {
  await own(lab);
  await drop(page, "body", [colourPng(), depthPng()]);
  await lab.reaches("ready");
  await put(
    lab,
    "Colour mask",
    image("m.png", 1, 16, (i) => (radius(i) < 20 ? 65535 : 0)),
  );
  await expect(slot(lab, 2)).toContainText("16-bit grey, a mask of");
  await lab.reaches("ready");
  await expect(page.locator(".offer")).toBeEmpty();
  // The same slot objects to a depth map.
  await put(lab, "Colour mask", depthPng("depths.png"));
  await expect(page.locator(".offer")).toContainText("depths.png looks like a depth map but is in the slot");
});

test("intrinsics of another picture size are scaled and named; of another aspect they are named and left out", async ({
  lab,
  page,
}) => {
  const fx = (side: string) => page.locator(`#fields-${side}`).getByLabel("fx", { exact: true });
  await own(lab);
  await drop(page, "body", [cameraJson("color.json", 2 * SIDE)]);
  await expect(remarks(lab)).toContainText("color.json: intrinsics. They are used once both pictures are here.");
  await drop(page, "body", [colourPng(), depthPng()]);
  await lab.reaches("ready");
  await expect(fx("colour")).toHaveValue("30.5");
  await expect(fx("depth")).toHaveValue("");
  await expect(remarks(lab)).toContainText(
    "The intrinsics of the colour images are for 96x96 pixels, but these pictures have 48x48: the intrinsics were scaled",
  );
  await page.getByRole("button", { name: "Undo" }).click();
  await expect(fx("colour")).toHaveValue("");
  await expect(remarks(lab)).not.toContainText("color.json");
  const wide = cameraJson("color.json");
  wide.buffer = Buffer.from(JSON.stringify({ width: 96, height: 54, fx: 61, fy: 62, cx: 47.5, cy: 26.5 }));
  await drop(page, "body", [wide]);
  await expect(remarks(lab)).toContainText(
    "for 96x54 pixels, but these pictures have 48x48: scale or crop the intrinsics first",
  );
  await expect(remarks(lab)).toContainText("color.json: not used for the colour images");
  await expect(fx("colour")).toHaveValue("");
});

test("a missing mask before a background is named, and can be drawn", async ({ lab, page }) => {
  await own(lab);
  await drop(page, "body", [colourPng(), depthPng()]);
  await lab.reaches("ready");
  await expect(remarks(lab)).not.toContainText("mask");
  await put(lab, "Colour image", roomPng());
  await expect(remarks(lab)).toContainText(
    "The colour image has no mask, and its background is not black: it counts as part of the object.",
  );
  await lab.reaches("ready");
  await page.getByRole("button", { name: "Draw a mask" }).click();
  const dialog = page.getByRole("dialog");
  await expect(dialog).toContainText("The object in room.png");
  await expect(dialog.getByText("Depths", { exact: true })).toBeHidden();
  await dialog.getByText("Rectangle by numbers").click();
  for (const [label, value] of [
    ["left, px", "4"],
    ["top, px", "4"],
    ["width, px", "40"],
    ["height, px", "24"],
  ] as const)
    await dialog.getByLabel(label).fill(value);
  await dialog.getByRole("button", { name: "Apply" }).click();
  await dialog.getByRole("button", { name: "Done" }).click();
  await expect(slot(lab, 2)).toContainText("mask of room.png");
  await expect(slot(lab, 2)).toContainText(`a mask of ${((100 * 40 * 24) / SIDE ** 2).toFixed(1)} % of the pixels`);
  await lab.reaches("ready");
  await expect(remarks(lab)).not.toContainText("no mask, and its background");
  // Another program's mask works as well.
  await put(lab, "Colour mask", maskPng("round.png"));
  await expect(slot(lab, 2)).toContainText("round.png");
  await lab.reaches("ready");
});

/** Inverse depths of the bust, for a camera whose focal length is the side of the map. */
async function inverse(size: number): Promise<{ colour: Upload; depth: (name: string) => Upload; beta: number }> {
  await init(await readFile(new URL("../../pkg/bimodal_stereo_bg.wasm", import.meta.url)));
  const beta = 12;
  const pair = sample({ surface: "bust", light: "colourful", size, angles: { beta } });
  const linear = pair.image.data as Float32Array;
  const isInside = (i: number) => (pair.image.mask?.[Math.floor(i / 3)] ?? 0) > 0;
  const brightest = linear.reduce((most, value, i) => (isInside(i) ? Math.max(most, value) : most), 0);
  const levels = Uint16Array.from(linear, (value, i) => (isInside(i) ? Math.round((60_000 * value) / brightest) : 0));
  const depths = pair.depth.data as Float32Array;
  const known = depths.filter((value) => value > 0).sort();
  const median = known[known.length >> 1] ?? 0;
  const stored = Uint16Array.from(depths, (z) => (z > 0 ? Math.round((20_000 * size) / (size + z - median)) : 0));
  const file = (name: string, channels: 1 | 3, data: Uint16Array): Upload => ({
    name,
    mimeType: "image/png",
    buffer: Buffer.from(encode({ width: size, height: size, channels, depth: 16, data })),
  });
  return { colour: file("colour.png", 3, levels), depth: (name) => file(name, 1, stored), beta };
}

test("larger is nearer by a choice beside the unit, by which disparities run", LONG, async ({ lab, page }) => {
  const { colour, depth, beta } = await inverse(64);
  await own(lab);
  await page.goto("./#size=64");
  await drop(page, "body", [colour, depth("near.png")]);
  await lab.reaches("ready");
  const upright = await lab.fingerprint("Given depth");
  await unfoldDepth(lab);
  await page.getByLabel("Numbers", { exact: true }).selectOption({ label: "larger is nearer" });
  await expect(remarks(lab)).toContainText("Inverse depths are known up to a factor only");
  await lab.reaches("ready");
  expect(await lab.fingerprint("Given depth")).not.toBe(upright);
  expect(await page.evaluate(() => location.hash)).toContain("meaning=inverse");
  await page.getByLabel("Speed").selectOption({ label: "fastest" });
  await page.getByRole("button", { name: "Play" }).click();
  await lab.reaches("converged");
  const found = page.locator("#pose tbody tr").nth(2).locator("td").first();
  await expect.poll(async () => Math.abs(Number(await found.textContent()) - beta)).toBeLessThan(1);
});

test("disparities by their name are read as such, and with a camera wait for focal length times baseline", async ({
  lab,
  page,
}) => {
  const { colour, depth } = await inverse(SIDE);
  await own(lab);
  await unfoldDepth(lab);
  const numbers = page.getByLabel("Numbers", { exact: true });
  const factor = page.getByLabel("Focal × baseline", { exact: true });
  await expect(factor).toBeHidden();
  await drop(page, "body", [colour, depth("disparity.png")]);
  await expect(numbers).toHaveValue("inverse");
  await expect(remarks(lab)).toContainText("disparity.png: its name suggests disparities or inverse depths");
  await lab.reaches("ready");
  await drop(page, "body", [cameraJson("depth.json")]);
  await expect(page.locator("#status")).toHaveText("depth camera: waiting for focal length × baseline");
  await expect(page.locator("#verdict")).toContainText("known up to a factor");
  await factor.fill("12000");
  await page.keyboard.press("Enter");
  await lab.reaches("ready");
  await expect(page.getByLabel("Unit", { exact: true })).toHaveValue("1");
  // A file with another name contains depths again.
  await drop(page, "body", [depthPng("depth.png")]);
  await expect(numbers).toHaveValue("depth");
  await lab.reaches("ready");
});

test("a photograph much finer than the depth map is scaled down to it, and each file is read once", async ({
  lab,
  page,
}) => {
  const messages = await Messages.of(page);
  await own(lab);
  const [width, height] = [1600, 1200];
  const data = Uint8Array.from({ length: 3 * width * height }, (_, i) => 40 + ((7 * i) % 150));
  const photo: Upload = {
    name: "photo.png",
    mimeType: "image/png",
    buffer: Buffer.from(encode({ width, height, data, channels: 3, depth: 8 })),
  };
  await drop(page, "body", [photo, depthPng()]);
  await expect(slot(lab, 0)).toContainText("1600 × 1200 px is 28.9 times as fine as the depth map; scaled down by 28");
  await lab.reaches("ready");
  await expect(page.locator('canvas[aria-label^="Colour:"]')).toHaveAttribute("width", "57");
  expect(await messages.count("read")).toBe(2);
  expect(await messages.count("pair")).toBe(1);
});
