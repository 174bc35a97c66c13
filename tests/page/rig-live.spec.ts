/** Check a rig: a robot behind a bridge of @foxglove/ws-protocol, with a verdict that sharpens view by view. */

import { expect, test } from "./lab";
import type { Page } from "@playwright/test";
import { bridge } from "../contract/bridge.mjs";
import { smallFrames } from "../contract/recorded-messages.mjs";
import { driver } from "../contract/recordings.mjs";
import { open, step } from "./rigsteps";

const shot = async (page: Page, name: string) => {
  if (process.env.SHOTS) await page.screenshot({ path: `${process.env.SHOTS}/${name}.png`, fullPage: true });
};

/** The messages of a robot in front of each of three scenes. */
async function scenes() {
  const frames = await smallFrames();
  const [first] = frames;
  if (!first) throw new Error("No frame was rendered.");
  return frames.map((frame) => driver([frame], first.pose, { compress: true }));
}

const card = (page: Page) => page.locator(".rig-live");

async function connect(page: Page, address: string): Promise<void> {
  await open(page);
  await page.getByText("Connect to a robot").click();
  await card(page).getByLabel("Address of the bridge").fill(address);
  await card(page).getByRole("button", { name: "Connect" }).click();
}

test("a robot is connected to, its topics are chosen, and the verdict sharpens view by view", async ({ lab, page }) => {
  const robot = await bridge(await scenes());
  try {
    await connect(page, robot.address);
    await expect(card(page).getByRole("status")).toHaveText("Connected to test robot.");
    await expect(card(page).getByLabel("Depth of")).toHaveValue("/camera/depth/image_raw/compressedDepth");
    await shot(page, "live-topics");
    await card(page).getByRole("button", { name: "Take views and check" }).click();
    const steps = card(page).getByRole("table", { name: "The verdict, view by view" }).locator("tbody tr");
    await expect(steps).toHaveCount(1);
    await expect(card(page).getByRole("status")).toContainText("1 view taken. Turn the robot");
    robot.turn(1);
    await expect(steps).toHaveCount(2);
    robot.turn(2);
    await expect(steps).toHaveCount(3);
    await expect(steps.last()).toContainText("consistent");
    await shot(page, "live-steps");
    await card(page).getByRole("button", { name: "See the verdict" }).click();
    await expect(page.locator(".rig-word")).toHaveText("Consistent");
    await expect(page.locator(".rig-run")).toContainText("Live, 3 views taken: looking for another view.");
    await shot(page, "live-verdict");
    await step(page, "Files and cameras").click();
    await card(page).getByRole("button", { name: "Stop" }).click();
    await expect(card(page).getByRole("status")).toHaveText("Connected; 3 views taken.");
    await card(page).getByRole("button", { name: "Disconnect" }).click();
    await expect(card(page).getByRole("button", { name: "Connect" })).toBeEnabled();
    await expect(page.locator(".rig-frame")).toHaveCount(3);
    expect(lab.complaints).toEqual([]);
  } finally {
    await robot.close();
  }
});

test("a connection that is lost is said, what was taken stays, and it can be tried again", async ({ page }) => {
  const all = await scenes();
  const robot = await bridge(all);
  await connect(page, robot.address);
  await card(page).getByRole("button", { name: "Take views and check" }).click();
  await expect(page.locator(".rig-frame")).toHaveCount(1);
  await robot.close();
  await expect(card(page).getByRole("alert")).toContainText("was lost");
  await shot(page, "live-lost");
  await expect(page.locator(".rig-frame")).toHaveCount(1);
  await card(page).getByRole("button", { name: "Try again" }).click();
  await expect(card(page).getByRole("alert")).toContainText("no foxglove_bridge can be reached there");
  const again = await bridge(all, { port: robot.port });
  try {
    await card(page).getByRole("button", { name: "Try again" }).click();
    await expect(card(page).getByRole("status")).toContainText("Connected; 1 view taken.");
  } finally {
    await again.close();
  }
});
