import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { encode } from "fast-png";
import { expect, test } from "./lab";
import { answerChecks, colourPng, matrixFile, pair } from "./rig";
import { open, openPair, put } from "./rigsteps";

test("a wrong file is named beside itself, and the others are read", async ({ lab, page }) => {
  await open(page);
  const name = "<img src=x onerror=alert(1)>.pdf";
  await put(page, [
    ...pair(),
    { name, mimeType: "application/pdf", buffer: Buffer.from("%PDF-1.7 not a picture") },
    { name: "cut.png", mimeType: "image/png", buffer: colourPng().subarray(0, 200) },
  ]);
  const file = (name: string) => page.locator(".rig-file").filter({ hasText: name });
  for (const wrong of [name, "cut.png"]) {
    await expect(file(wrong).getByRole("alert")).toContainText(wrong);
    await expect(file(wrong)).toHaveAttribute("data-state", "failed");
  }
  // A file's name is inserted as text.
  expect(await page.locator("#rig img").count()).toBe(0);
  await expect(page.locator(".rig-frame")).toHaveCount(1);
  await expect(file("color_0001.png")).toContainText("160x120");
  await file("cut.png").getByRole("button", { name: "Remove cut.png" }).click();
  await expect(file("cut.png")).toHaveCount(0);
  expect(lab.complaints).toEqual([]);
});

test("frames come one by one, and kind and unit can be corrected", async ({ lab, page }) => {
  await open(page);
  const next = page.getByRole("button", { name: "Next: your calibration" });
  await put(page, pair().slice(0, 1));
  await expect(page.locator(".rig-frame")).toContainText("A depth map is missing.");
  await expect(next).toBeDisabled();
  await put(page, pair().slice(1));
  await expect(page.locator(".rig-frame")).toContainText("Colour 160×120 px, depth 160×120 px");
  await put(page, pair("0002"));
  await expect(page.locator(".rig-frame")).toHaveCount(2);
  await expect(page.locator(".rig-missing")).toContainText("the depth camera's parameters");

  const depth = page.locator(".rig-file").filter({ hasText: "depth_0002.png" });
  await expect(depth.getByLabel("Unit")).toHaveValue("");
  await depth.getByLabel("Unit").selectOption("0.001");
  await expect(depth).not.toContainText("was guessed");
  await depth.getByLabel("Kind").selectOption("colour");
  await expect(page.locator(".rig-frame").nth(1)).toContainText("A depth map is missing.");
  expect(lab.complaints).toEqual([]);
});

test("files dropped beside the target are taken, too", async ({ lab, page }) => {
  await open(page);
  const dropped = await page.evaluateHandle(
    (bytes) => {
      const data = new DataTransfer();
      data.items.add(new File([new Uint8Array(bytes)], "dropped.png", { type: "image/png" }));
      return data;
    },
    [...colourPng()],
  );
  await page.getByRole("heading", { name: "Cameras", exact: true }).dispatchEvent("drop", { dataTransfer: dropped });
  await expect(page.locator(".rig-file")).toContainText("dropped.png");
  await expect(page.locator(".rig-frame")).toContainText("A depth map is missing.");
  expect(lab.complaints).toEqual([]);
});

test("what is used of a frame can be restricted, with the pointer and with numbers", async ({ lab, page }) => {
  await openPair(page);
  await page.getByRole("button", { name: "Restrict what is used" }).click();
  const dialog = page.getByRole("dialog");
  const share = dialog.getByRole("status");
  await expect(share).toHaveText("100 % of the image is used.");
  const box = await dialog.locator(".rig-mask-layer").boundingBox();
  if (!box) throw new Error("The picture has no box.");
  await page.mouse.move(box.x + 1, box.y + 1);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height - 1, { steps: 4 });
  await page.mouse.up();
  await expect(share).toHaveText(/^(49|50) % of the image is used\.$/);
  await dialog.getByRole("button", { name: "Use everything" }).click();
  await dialog.getByText("Rectangle by numbers").click();
  for (const [label, value] of [
    ["left, px", "0"],
    ["top, px", "0"],
    ["width, px", "160"],
    ["height, px", "30"],
  ] as const)
    await dialog.getByLabel(label).fill(value);
  await dialog.getByRole("button", { name: "Apply" }).click();
  await expect(share).toHaveText("25 % of the image is used.");
  // Strokes are undone one at a time.
  await dialog.getByRole("button", { name: "Undo stroke" }).click();
  await expect(share).toHaveText("100 % of the image is used.");
  await dialog.getByRole("button", { name: "Undo stroke" }).click();
  await expect(share).toHaveText(/^(49|50) % of the image is used\.$/);
  await dialog.getByRole("button", { name: "Undo stroke" }).click();
  await expect(share).toHaveText("100 % of the image is used.");
  await expect(dialog.getByRole("button", { name: "Undo stroke" })).toBeDisabled();
  await dialog.getByRole("button", { name: "Apply" }).click();
  await expect(share).toHaveText("25 % of the image is used.");
  await dialog.getByLabel("By, px").fill("6");
  await dialog.getByRole("button", { name: "Grow" }).click();
  await expect(share).toHaveText("30 % of the image is used.");
  await dialog.getByLabel("Farthest depth, m").fill("1.2");
  await dialog.getByRole("button", { name: "Done" }).click();
  await expect(page.locator(".rig-frame")).toContainText("used: 30 % of the image, as drawn, depths from 0 to 1.2 m.");
  expect(lab.complaints).toEqual([]);
});

test("a guessed unit is confirmed at one press, for all depth maps", async ({ lab, page }) => {
  await open(page);
  await put(page, [...pair(), ...pair("0002")]);
  await expect(page.locator(".rig-frame")).toHaveCount(2);
  const guess = page.getByRole("group", { name: "Units" });
  await expect(guess).toContainText("The unit of 2 depth maps was guessed: millimetres.");
  await guess.getByRole("button", { name: "Confirm" }).click();
  await expect(guess).toBeHidden();
  await expect(page.locator(".rig-files")).not.toContainText("was guessed");
  for (const name of ["depth_0001.png", "depth_0002.png"])
    await expect(page.locator(".rig-file").filter({ hasText: name }).getByLabel("Unit")).toHaveValue("0.001");
  expect(lab.complaints).toEqual([]);
});

test("a folder comes in order, with its masks to be seen and left out, and its guesses in view", async ({
  lab,
  page,
}) => {
  await answerChecks(page, "consistent");
  await open(page);
  const folder = mkdtempSync(join(tmpdir(), "rig-"));
  const mask = Buffer.from(
    encode({
      width: 160,
      height: 120,
      channels: 1,
      data: Uint8Array.from({ length: 160 * 120 }, (_, i) => (i % 160 < 80 ? 255 : 0)),
    }),
  );
  for (const name of ["10", "9"])
    for (const { name: file, buffer } of pair(name)) writeFileSync(join(folder, file), buffer);
  writeFileSync(join(folder, "mask_9.png"), mask);
  writeFileSync(join(folder, "K.txt"), "150 0 80\n0 150 60\n0 0 1\n");
  await page.locator("#rig input[webkitdirectory]").first().setInputFiles(folder);
  const frames = page.locator(".rig-frame");
  await expect(frames).toHaveCount(2);
  await expect(frames.first()).toContainText("used: mask file.");
  await frames.first().getByLabel("Mask").selectOption("");
  await expect(frames.first()).toContainText("all of it is used.");
  await expect(page.locator(".rig-notes").first()).toContainText("Only one camera's intrinsics were found");
  await page.getByRole("group", { name: "Units" }).getByRole("button").click();
  await expect(page.getByRole("group", { name: "Units" })).toBeHidden();
  await expect(page.locator(".rig-notes").first()).not.toContainText("unit");
  await page.getByRole("button", { name: "Next: your calibration" }).click();
  await page.getByLabel("Or paste it in any of these formats").fill("1 0 0 0.02\n0 1 0 0\n0 0 1 0\n0 0 0 1");
  await page.getByRole("button", { name: "Add what I pasted" }).click();
  await page.getByRole("button", { name: "Run the check" }).locator("visible=true").click();
  await expect(page.locator(".rig-word")).toHaveText("Undecided, see warnings");
  await expect(page.locator(".rig-verdict")).toContainText("they are used for both pictures");
  await expect(page.locator(".rig-verdict")).not.toContainText("Guessed");
  rmSync(folder, { recursive: true });
  expect(lab.complaints).toEqual([]);
});

test("a frame that was removed stays away when files are added, and comes back undone", async ({ lab, page }) => {
  await open(page);
  const frames = page.locator(".rig-frame");
  await put(page, [...pair(), ...pair("0002")]);
  await expect(frames).toHaveCount(2);
  await expect(page.getByRole("button", { name: /^Undo/ })).toBeHidden();
  await page.getByRole("button", { name: "Remove frame 1" }).click();
  await expect(frames).toHaveCount(1);
  await put(page, [matrixFile("factory.txt", 0.025), ...pair("0003")]);
  await expect(page.locator(".rig-file")).toHaveCount(7);
  await expect(frames).toHaveCount(2);
  await expect(frames.first()).toContainText("frame 2");
  await page.getByRole("button", { name: "Undo removing frame 1" }).click();
  // Frames that were added later are still there.
  await expect(frames).toHaveCount(3);
  await expect(page.locator(".rig-file")).toHaveCount(7);
  await expect(page.getByRole("button", { name: /^Undo/ })).toBeHidden();
  await page.getByRole("button", { name: "Remove color_0003.png" }).click();
  await expect(frames.filter({ hasText: "A colour image is missing." })).toHaveCount(1);
  await page.getByRole("button", { name: "Undo removing color_0003.png" }).click();
  await expect(frames.filter({ hasText: "A colour image is missing." })).toHaveCount(0);
  expect(lab.complaints).toEqual([]);
});
