/** The visitor's own files, valid and invalid. They are made from a sample, so that the answer is known. */

import { readFile } from "node:fs/promises";
import { encode } from "fast-png";
import init, { sample, type Sample } from "../../pkg/index.js";
import { LONG, expect, test, type Lab } from "./lab";
import { Messages } from "./messages";

const size = 64;
let pair: Sample;

test.beforeAll(async () => {
  await init(await readFile(new URL("../../pkg/bimodal_stereo_bg.wasm", import.meta.url)));
  pair = sample({ surface: "bust", light: "colourful", size, angles: { beta: 12 } });
});

interface Upload {
  name: string;
  mimeType: string;
  buffer: Buffer;
}

/** Linear floats as 16-bit RGB, with the brightest just below white. */
function colourPng(): Upload {
  const linear = pair.image.data as Float32Array;
  const brightest = linear.reduce((most, value) => (Number.isFinite(value) ? Math.max(most, value) : most), 0);
  const data = Uint16Array.from(linear, (value) =>
    Number.isFinite(value) ? Math.round((60_000 * value) / brightest) : 0,
  );
  const png = encode({ width: size, height: size, data, depth: 16, channels: 3 });
  return { name: "colour.png", mimeType: "image/png", buffer: Buffer.from(png) };
}

function maskPng(mask: Uint8Array | undefined, name: string): Upload {
  const data = Uint8Array.from({ length: size * size }, (_, i) => (mask === undefined || mask[i] ? 255 : 0));
  return {
    name,
    mimeType: "image/png",
    buffer: Buffer.from(encode({ width: size, height: size, data, depth: 8, channels: 1 })),
  };
}

/** Depth in hundredths of a pixel. */
function depthPng(): Upload {
  const data = Uint16Array.from(pair.depth.data ?? [], (value) => (value > 0 ? Math.round(100 * value) : 0));
  const png = encode({ width: size, height: size, data, depth: 16, channels: 1 });
  return { name: "depth.png", mimeType: "image/png", buffer: Buffer.from(png) };
}

function depthNpy(): Upload {
  const header = `{'descr': '<f4', 'fortran_order': False, 'shape': (${size}, ${size}), }`;
  const padded = `${header.padEnd(Math.ceil((header.length + 11) / 64) * 64 + 53, " ")}\n`;
  const lead = Buffer.from([0x93, 0x4e, 0x55, 0x4d, 0x50, 0x59, 1, 0, padded.length & 255, padded.length >> 8]);
  const data = pair.depth.data as Float32Array;
  return {
    name: "depth.npy",
    mimeType: "application/octet-stream",
    buffer: Buffer.concat([lead, Buffer.from(padded), Buffer.from(data.buffer, data.byteOffset, data.byteLength)]),
  };
}

async function put(lab: Lab, slot: string, file: Upload): Promise<void> {
  await lab.page.getByLabel(slot, { exact: true }).setInputFiles(file);
}

async function openFiles(lab: Lab): Promise<void> {
  await lab.open("size=64");
  await lab.unfold();
  await lab.page.getByRole("button", { name: "Own files" }).click();
  await lab.reaches("waiting");
}

test("nothing runs while files are awaited", async ({ lab, page }) => {
  const messages = await Messages.of(page);
  await openFiles(lab);
  await expect(page.locator("#verdict")).toContainText("choose them in the settings");
  // Clicks buttons that are marked as disabled, with the pointer and with the keyboard.
  await page.getByRole("button", { name: "Step", exact: true }).click({ force: true });
  const play = page.locator("#play");
  await play.click({ force: true });
  await page.keyboard.press("s");
  await page.keyboard.press("t");
  await page.locator("#clouds-canvas").press(" ");
  await expect(play).toHaveAttribute("aria-pressed", "false");
  await lab.reaches("waiting");
  await expect(lab.iteration).toHaveText("0");
  expect(await messages.count("advance")).toBe(0);
});

test("a colour and a depth PNG of 16 bits run to convergence", async ({ lab, page }) => {
  await openFiles(lab);
  await page.getByText("Depth camera", { exact: true }).click();
  await page.getByLabel("Unit", { exact: true }).fill("0.01");
  await put(lab, "Colour image", colourPng());
  await put(lab, "Depth map", depthPng());
  await lab.reaches("ready");
  await put(lab, "Colour mask", maskPng(pair.image.mask, "mask.png"));
  await lab.reaches("ready");
  await page
    .locator("#fields-method")
    .getByLabel("Light", { exact: true })
    .filter({ visible: true })
    .fill([...pair.light].join(" "));
  await page.keyboard.press("Enter");
  await expect(page.getByText("guessed: linear")).toBeAttached();
  await page.getByLabel("Speed").selectOption({ label: "fastest" });
  await page.getByRole("button", { name: "Play" }).click();
  await lab.reaches("converged");
  const beta = page.locator("#pose tbody tr").nth(2).locator("td").first();
  await expect.poll(async () => Math.abs(Number(await beta.textContent()) - 12)).toBeLessThan(1);
  await expect(page.locator("#pose-error")).toBeHidden();
});

test("a .npy depth map gives the same picture as the sample it was made of", async ({ lab }) => {
  await lab.open("size=64&beta=12");
  await lab.unfold();
  const truth = await lab.fingerprint("Given depth");
  await lab.page.getByRole("button", { name: "Own files" }).click();
  await put(lab, "Colour image", colourPng());
  await put(lab, "Depth map", depthNpy());
  await put(lab, "Depth mask", maskPng(pair.depth.mask, "mask.png"));
  await lab.reaches("ready");
  expect(await lab.fingerprint("Given depth")).toBe(truth);
});

test("bad files are named in words, and another pair is not shown for them", async ({ lab, page }) => {
  await lab.open();
  await lab.unfold();
  const shown = await lab.fingerprint("Given depth");
  await page.getByRole("button", { name: "Own files" }).click();
  const whole = colourPng();
  await put(lab, "Depth map", depthNpy());
  await put(lab, "Colour image", {
    ...whole,
    name: "cut.png",
    buffer: whole.buffer.subarray(0, whole.buffer.length / 2),
  });
  await lab.reaches("error");
  await expect(page.locator(".slot").first()).toContainText("cut.png: this PNG is cut off or damaged");

  await put(lab, "Colour image", {
    name: "notes.txt",
    mimeType: "text/plain",
    buffer: Buffer.from("a list of things"),
  });
  await expect(page.locator(".slot").first()).toContainText("notes.txt");
  await lab.reaches("error");

  await put(lab, "Colour image", whole);
  await lab.reaches("ready");
  await put(lab, "Depth map", {
    name: "depth.npy",
    mimeType: "application/octet-stream",
    buffer: Buffer.from("also no array"),
  });
  await lab.reaches("error");
  await expect(page.locator(".slot").nth(1)).toContainText("depth.npy");

  // The previous depth map is not the requested one; once that is there, the pair runs.
  await expect(page.locator('canvas[aria-label^="Given depth:"]')).toBeHidden();
  await put(lab, "Depth map", depthNpy());
  await lab.reaches("ready");
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  await page.getByRole("button", { name: "Sample", exact: true }).click();
  await lab.reaches("ready");
  expect(await lab.fingerprint("Given depth")).toBe(shown);
});

test("a number out of range is refused beside its field", async ({ lab, page }) => {
  await lab.open();
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  await lab.unfold();
  await page.getByText("Weights", { exact: true }).click();
  const prior = page.getByLabel("λ shape prior", { exact: true }).first();
  await prior.fill("-1");
  await prior.press("Enter");
  await expect(page.locator(".field", { has: prior })).toContainText("must be a finite number, zero or above");
  await expect(lab.iteration).toHaveText("1");
  await page.getByRole("button", { name: "Undo" }).click();
  await lab.reaches("ready");
  await expect(page.locator(".field", { has: prior })).not.toContainText("must be");
});

test("on a phone a refused field is unfolded", async ({ lab, page }) => {
  await page.setViewportSize({ width: 390, height: 844 });
  await page.goto("./#distance=0");
  await lab.reaches("error");
  await expect(page.getByLabel("Match within", { exact: true })).toBeVisible();
});

test("empty angles of a sample are zero, all of them as well as one", async ({ lab, page }) => {
  for (const [settings, beta] of [
    ["beta=20&alpha=&gamma=", "20.00"],
    ["alpha=&beta=&gamma=", "0.00"],
  ] as const) {
    await page.goto("about:blank");
    await lab.open(settings);
    await expect(page.locator("#pose tr", { hasText: "β" }).locator("td").nth(1)).toHaveText(beta);
  }
});

/** A JPEG from a phone held upright: a landscape picture with a tag for its orientation. */
function phonePhoto(jpeg: Buffer): Upload {
  const exif = Buffer.from(
    "457869660000" + "49492a0008000000" + "0100" + "120103000100000006000000" + "00000000",
    "hex",
  );
  const length = Buffer.alloc(2);
  length.writeUInt16BE(exif.length + 2);
  const buffer = Buffer.concat([jpeg.subarray(0, 2), Buffer.from([0xff, 0xe1]), length, exif, jpeg.subarray(2)]);
  return { name: "phone.jpg", mimeType: "image/jpeg", buffer };
}

test("a phone's photo is turned upright, and a dropped file is taken", LONG, async ({ lab, page }) => {
  await openFiles(lab);
  const landscape = await page.evaluate(async () => {
    const canvas = new OffscreenCanvas(80, 48);
    const context = canvas.getContext("2d");
    for (let x = 0; context && x < 80; x++) {
      context.fillStyle = `hsl(${4 * x} 40% 60%)`;
      context.fillRect(x, 0, 1, 48);
    }
    return [...new Uint8Array(await (await canvas.convertToBlob({ type: "image/jpeg" })).arrayBuffer())];
  });
  await put(lab, "Depth map", depthNpy());
  const photo = phonePhoto(Buffer.from(landscape));
  const carried = await page.evaluateHandle(
    (bytes) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([new Uint8Array(bytes)], "phone.jpg", { type: "image/jpeg" }));
      return transfer;
    },
    [...photo.buffer],
  );
  await page.locator(".drop").first().dispatchEvent("drop", { dataTransfer: carried });
  await expect(page.locator(".slot").first()).toContainText("phone.jpg");
  await lab.reaches("ready");
  await expect(page.locator('canvas[aria-label^="Colour:"]')).toHaveAttribute("width", "48");
});

test("a picture that is too large is scaled down with its camera, and says so", async ({ lab, page }) => {
  await openFiles(lab);
  const [width, height] = [4104, 16];
  const data = Uint8Array.from({ length: 3 * width * height }, (_, i) => 60 + ((i * 7) % 150));
  await put(lab, "Depth map", depthNpy());
  await put(lab, "Colour image", {
    name: "wide.png",
    mimeType: "image/png",
    buffer: Buffer.from(encode({ width, height, data, channels: 3, depth: 8 })),
  });
  await expect(page.locator(".slot").first()).toContainText("scaled down by 2");
  await lab.reaches("ready");
});

test("a camera waits for its four numbers, and its distortion for as many as its lens has", async ({ lab, page }) => {
  await openFiles(lab);
  await put(lab, "Colour image", colourPng());
  await put(lab, "Depth map", depthNpy());
  await lab.reaches("ready");
  await page.getByText("Colour camera", { exact: true }).click();
  const fields = page.locator("#fields-colour");
  const type = async (name: string, value: string) => {
    await fields.getByLabel(name, { exact: true }).fill(value);
    await page.keyboard.press("Enter");
  };
  await type("fx", "100");
  await expect(page.locator("#status")).toHaveText("colour camera: waiting for fy, cx, cy");
  await expect(page.locator("#verdict")).toContainText("leave all fields of that camera empty");
  for (const [name, value] of [
    ["fy", "100"],
    ["cx", "31.5"],
    ["cy", "31.5"],
  ] as const)
    await type(name, value);
  await lab.reaches("ready");
  await type("distortion", "0.1 0 0");
  await expect(fields.locator(".field", { has: page.getByLabel("distortion", { exact: true }) })).toContainText(
    "needs 4, 5 or 8 numbers, not 3",
  );
  await type("distortion", "0.1 0 0 0 0 0 0 0");
  await lab.reaches("ready");
  await type("distortion", "0.1 0 0 0");
  await fields.getByLabel("lens model").selectOption("fisheye");
  await lab.reaches("ready");
  expect(await page.evaluate(() => location.hash)).toContain("colour.model=fisheye");
});
