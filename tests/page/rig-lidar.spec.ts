/** Check a rig with a LiDAR: files that are chosen one by one are arranged as those of a folder, and words and pictures fit a scan. */

import { expect, test } from "@playwright/test";
import { answerChecks, colourPng, giveFiles, matrixFile, pair } from "./rig";
import { open, put, run } from "./rigsteps";

const image = (name: string) => ({ name, mimeType: "image/png", buffer: colourPng() });
const text = (name: string, content: string) => ({ name, mimeType: "text/plain", buffer: Buffer.from(content) });

/** A scan in KITTI's form: 16 rings of x y z and a reflectance, ring by ring, with x forward and z up. */
function scan(name: string) {
  const values: number[] = [];
  for (let ring = 0; ring < 16; ring++)
    for (let column = 0; column < 900; column++) {
      const [azimuth, elevation] = [(column * Math.PI) / 450, ((15 - 2 * ring) * Math.PI) / 180];
      const range = 6 + 2 * Math.sin(3 * azimuth);
      const level = range * Math.cos(elevation);
      values.push(level * Math.cos(azimuth), level * Math.sin(azimuth), range * Math.sin(elevation), 0.5);
    }
  return { name, mimeType: "application/octet-stream", buffer: Buffer.from(Float32Array.from(values).buffer) };
}

const camera = (focal: number, rows: number[][]) => ({
  ...{
    K: [
      [focal, 0, 79.5],
      [0, focal, 59.5],
      [0, 0, 1],
    ],
    lidar2cam: [...rows, [0, 0, 0, 1]],
  },
  ...{ width: 160, height: 120 },
});
const AROUND = text(
  "calibration.json",
  JSON.stringify({
    CAM_FRONT: camera(150, [
      [0, -1, 0, 0.1],
      [0, 0, -1, 0.2],
      [1, 0, 0, 0.3],
    ]),
    CAM_FRONT_LEFT: camera(160, [
      [1, 0, 0, 0.4],
      [0, 0, -1, 0.5],
      [0, 1, 0, 0.6],
    ]),
  }),
);
const KITTI = text(
  "calib.txt",
  "P2: 150 0 79.5 0 0 150 59.5 0 0 0 1 0\nR0_rect: 1 0 0 0 1 0 0 0 1\nTr_velo_to_cam: 0 -1 0 0.1 0 0 -1 0.2 1 0 0 0.3\nTr_imu_to_velo: 1 0 0 -0.8 0 1 0 0.3 0 0 1 -0.8\n",
);

for (const [name, focal] of [
  ["CAM_FRONT", 150],
  ["CAM_FRONT_LEFT", 160],
] as const)
  test(`${name}: the picture's name chooses the camera and the calibration`, async ({ page }) => {
    await open(page);
    await put(page, [image(`${name}.png`), scan("LIDAR_TOP.bin"), AROUND]);
    const colour = page.getByRole("group", { name: "Colour camera" });
    await expect(colour).toContainText(`fx ${focal}.00`);
    await page.getByRole("button", { name: "Next: your calibration" }).click();
    await expect(page.locator(".rig-candidate")).toHaveCount(1);
    await expect(page.locator(".rig-candidate input")).toHaveValue(`${name} from lidar`);
  });

test("KITTI: no pose of the inertial unit, words for a LiDAR, the hint once, a thumbnail of the scan", async ({
  page,
}) => {
  await open(page);
  await put(page, [image("000000.png"), scan("000000.bin"), KITTI]);
  const thumb = page.locator(".rig-frame canvas").nth(1);
  await expect
    .poll(() =>
      thumb.evaluate((canvas: HTMLCanvasElement) => {
        const { width, height } = canvas;
        const { data } = canvas.getContext("2d")?.getImageData(0, 0, width, height) ?? { data: [] };
        const seen = Array.from(data).filter((value, i) => i % 4 === 3 && value > 0).length;
        return height >= 64 && seen > 0.5 * width * height;
      }),
    )
    .toBe(true);
  await page.getByRole("button", { name: "Next: your calibration" }).click();
  await expect(page.locator(".rig-candidate")).toHaveCount(1);
  await expect(page.locator(".rig-candidate .rig-words")).toHaveText(
    /^The LiDAR sits .* the colour camera, which looks along the LiDAR's x axis with z up, except for a rotation by 0\.00°\.$/,
  );
  await expect(page.getByText("Does this match your rig?")).toHaveCount(1);
});

test("the list of supported files is the readers' own", async ({ page }) => {
  await open(page);
  await page.getByText("Supported files").click();
  for (const name of ["KITTI", "nuScenes", "Polycam", "OpenEXR", "LAS", "Azure Kinect", "ZED"])
    await expect(page.locator(".rig-formats")).toContainText(name);
});

test("undecided: the export offers the visitor's calibration first, and calls what was found an estimate", async ({
  page,
}) => {
  await answerChecks(page, "undecided");
  await open(page);
  await giveFiles(page, [...pair(), matrixFile("told.txt", 0.025)]);
  await run(page);
  const which = page.locator(".rig-results").getByLabel("Calibration", { exact: true });
  await expect(which).toHaveValue("told");
  await page.getByRole("button", { name: "Save calibration" }).click();
  await expect(page.getByText("Saved as depth_to_colour.txt.")).toBeVisible();
  await which.selectOption("found");
  await page.getByRole("button", { name: "Save calibration" }).click();
  await expect(page.getByText("Saved as depth_to_colour.estimate.txt.")).toBeVisible();
});
