/** The Lab for a newcomer: examples, the light, and the result of a run. */

import { LONG, expect, test, type Lab } from "./lab";

const panelHeight = (lab: Lab) => lab.page.locator("#panel").evaluate((panel) => panel.getBoundingClientRect().height);

test("a first visit plays once by itself, a second one waits", async ({ lab, page }) => {
  await page.goto("./");
  await lab.reaches("converged");
  await expect(page.locator("#status")).toHaveAttribute("data-tone", "good");
  expect(await lab.errorDegrees()).toBeLessThan(1);
  await page.reload();
  await lab.reaches("ready");
  await expect(lab.iteration).toHaveText("0");
});

test("where motion is unwelcome nothing plays by itself", async ({ lab, page }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.goto("./");
  await lab.reaches("ready");
  await expect(page.locator("#pose-error")).toBeVisible();
  await expect(lab.iteration).toHaveText("0");
  await page.getByRole("button", { name: "Noise", exact: true }).click();
  await lab.reaches("ready");
  await expect(page).toHaveURL(/noise=0\.05/);
});

test("an example is a press: it sets everything and plays", async ({ lab, page }) => {
  await lab.open("surface=vase&size=64");
  const examples = page.getByRole("group", { name: "Examples" });
  await expect(examples.locator('[aria-pressed="true"]')).toHaveCount(0);
  await examples.getByRole("button", { name: "The paper's loop" }).click();
  await lab.reaches("converged");
  await expect(examples.locator('[aria-pressed="true"]')).toHaveText("The paper's loop");
  await expect(page).toHaveURL(/registration=icp/);
  await expect(page).not.toHaveURL(/vase/);
  await lab.unfold();
  await page.getByRole("button", { name: "Undo" }).click();
  await expect(page).toHaveURL(/surface=vase/);
});

test(
  "a press of the example that is set, as a space after it was chosen, pauses and plays on",
  LONG,
  async ({ lab, page }) => {
    await lab.open("surface=vase&size=64");
    const play = page.locator("#play");
    const example = page.getByRole("button", { name: "Noise", exact: true });
    await example.click();
    await expect(lab.iteration).not.toHaveText("0");
    await expect(example).toBeFocused();
    await page.keyboard.press(" ");
    await expect(play).toHaveAttribute("aria-label", "Play");
    // The run is not restarted.
    await expect(lab.iteration).not.toHaveText("0");
    await page.keyboard.press(" ");
    await lab.reaches("converged");
  },
);

test("a pose that was held and is off has no tick", async ({ lab, page }) => {
  await lab.visit("size=32&registration=fixed&start=identity&beta=40");
  await page.getByLabel("Speed").selectOption({ label: "fastest" });
  await page.getByRole("button", { name: "Play" }).click();
  await expect(page.locator("#status")).toHaveAttribute("data-tone", "wrong");
  await expect(page.locator("#status-icon")).not.toHaveText("✓");
  await expect(page.locator("#status-icon")).not.toHaveAttribute("data-mark", "converged");
});

test("a link that asks for what can't be says which field is wrong, and how", async ({ lab, page }) => {
  await page.goto("./#size=32&overlap=7");
  await lab.reaches("error");
  await expect(page.locator("#status")).toHaveText("Overlap: invalid value");
  await expect(page.locator("#verdict")).toHaveText(/^Must be .*\d.*\. The field is marked\.$/);
  const field = page.locator("#fields-sample").getByRole("spinbutton", { name: "Overlap" });
  await expect(field).toHaveAttribute("aria-invalid");
  await expect(field).toBeInViewport();
  // If a view sees only the back, the rotation is at fault, not the size.
  await page.goto("./#size=32&beta=180");
  await expect(page.locator("#status")).toHaveText("Rotation β: invalid value");
  await expect(page.locator("#verdict")).toHaveText(
    "The depth camera sees only the back of the surface. The field is marked.",
  );
});

test(
  "the light is shown as found and true, and the true one can be dragged: the picture follows",
  LONG,
  async ({ lab, page }) => {
    await lab.open("size=64");
    const before = await lab.fingerprint("Colour");
    const balls = page.locator("#light .ball");
    await expect(balls).toHaveCount(3);
    const truth = page.getByRole("img", { name: /^A ball under the true light/ });
    const ball = await truth.boundingBox();
    if (!ball) throw new Error("the ball is on the page");
    await page.mouse.move(ball.x + ball.width / 2, ball.y + ball.height / 2);
    await page.mouse.down();
    await page.mouse.move(ball.x + ball.width / 2 + 10, ball.y + ball.height / 2 + 4, { steps: 3 });
    await expect.poll(() => lab.fingerprint("Colour")).not.toBe(before);
    // A rest during the drag takes effect, and the whole drag is one step for Undo.
    await expect(page).toHaveURL(/lightTurn=-\d+/);
    await lab.reaches("ready");
    await page.mouse.move(ball.x + ball.width / 2 + 20, ball.y + ball.height / 2 + 8, { steps: 3 });
    await page.mouse.up();
    await expect(page).toHaveURL(/lightTurn=-(4[5-9]|5\d)/);
    await lab.reaches("ready");
    const turned = await lab.fingerprint("Colour");
    expect(turned).not.toBe(before);
    await lab.unfold();
    await page.getByRole("button", { name: "Undo" }).click();
    await expect.poll(() => lab.fingerprint("Colour")).toBe(before);
    await page.getByRole("button", { name: "Redo" }).click();
    await expect.poll(() => lab.fingerprint("Colour")).toBe(turned);
  },
);

test(
  "while the light is dragged, what was found is marked as of the run before, and nothing moves",
  LONG,
  async ({ lab, page }) => {
    await lab.open("size=64");
    const found = page.locator("#pose-found");
    const ball = page.locator("#light figcaption").first();
    const truth = page.getByRole("img", { name: /^A ball under the true light/ });
    const box = await truth.boundingBox();
    if (!box) throw new Error("the ball is on the page");
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 10, y);
    // The initial pose is the same under any light.
    await expect(found).toHaveText("start");
    await page.mouse.up();
    await expect(page).toHaveURL(/lightTurn=-\d+/);

    await page.keyboard.press(" ");
    await lab.reaches("converged");
    const boxes = () =>
      page
        .locator("#pose th, #pose td, #pose-error, #light figure")
        .evaluateAll((parts) => parts.map((part) => JSON.stringify(part.getBoundingClientRect())));
    const before = await boxes();
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 6, y);
    await expect(found).toHaveText("last run");
    await expect(ball).toHaveText("last run");
    expect(await boxes()).toEqual(before);
    // After the light has returned to its place and is released, nothing has to run again.
    await page.mouse.move(x, y);
    await page.mouse.up();
    await expect(found).toHaveText("found");
    await expect(ball).toHaveText("found");
    await lab.reaches("converged");

    await page.mouse.down();
    await page.mouse.move(x + 12, y);
    await page.mouse.up();
    await lab.reaches("converged");
    await expect(found).toHaveText("found");
    await expect(page.locator("#pose")).not.toHaveAttribute("data-before");
  },
);

test(
  "a light that is turned on while its last turn is being opened does not stop what was playing",
  LONG,
  async ({ lab, page }) => {
    await lab.open("size=64");
    await page.keyboard.press(" ");
    const truth = page.getByRole("img", { name: /^A ball under the true light/ });
    await truth.focus();
    for (const turn of [5, 10, 15]) {
      await page.keyboard.press("ArrowRight");
      // The light has come to rest, so the pair is rendered and opened again.
      await expect(page).toHaveURL(new RegExp(`lightTurn=-${turn}\\b`));
    }
    await lab.reaches("converged");
  },
);

test("the arrow keys turn the light toward where they point", async ({ lab, page }) => {
  await lab.open("size=64&light=window");
  /** The mean column of the ball's brightness. */
  const column = () =>
    page.getByRole("img", { name: /^A ball under the true light/ }).evaluate((canvas: HTMLCanvasElement) => {
      const { data, width } =
        canvas.getContext("2d")?.getImageData(0, 0, canvas.width, canvas.height) ?? new ImageData(1, 1);
      let [sum, weighted] = [0, 0];
      for (let i = 0; i < data.length; i += 4) {
        if (!data[i + 3]) continue;
        sum += data[i] ?? 0;
        weighted += (data[i] ?? 0) * ((i / 4) % width);
      }
      return weighted / sum;
    });
  await page.getByRole("img", { name: /^A ball under the true light/ }).focus();
  const start = await column();
  for (let press = 0; press < 6; press++) await page.keyboard.press("ArrowRight");
  await expect(page).toHaveURL(/lightTurn=-30/);
  await lab.reaches("ready");
  expect(await column()).toBeGreaterThan(start + 0.3);
});

test("a slider acts when it rests, and what had been played plays again", LONG, async ({ lab, page }) => {
  await lab.visit("size=64");
  await page.getByLabel("Speed").selectOption({ label: "fastest" });
  await page.getByRole("button", { name: "Play" }).click();
  await lab.reaches("converged");
  await lab.unfold();
  const noise = page.locator("#fields-sample").getByRole("slider", { name: "Colour noise" });
  const exact = page.locator("#fields-sample").getByRole("spinbutton", { name: "Colour noise" });
  const before = await lab.fingerprint("Colour");
  await noise.evaluate((slider: HTMLInputElement) => {
    slider.value = "0.05";
    slider.dispatchEvent(new Event("input", { bubbles: true }));
  });
  await expect(exact).toHaveValue("0.05");
  await expect.poll(() => lab.fingerprint("Colour")).not.toBe(before);
  await expect(page).toHaveURL(/noise=0\.05/);
  await lab.reaches("converged");
  // One step of Undo, however many values the slider passed.
  await page.getByRole("button", { name: "Undo" }).click();
  await expect.poll(() => lab.fingerprint("Colour")).toBe(before);
  // Undone and redone values play like the slider's own change.
  await lab.reaches("converged");
  await page.getByRole("button", { name: "Redo" }).click();
  await expect.poll(() => lab.fingerprint("Colour")).not.toBe(before);
  await lab.reaches("converged");
  // A typed number plays like a change of the slider.
  await exact.fill("0");
  await exact.press("Enter");
  await expect.poll(() => lab.fingerprint("Colour")).toBe(before);
  await lab.reaches("converged");
});

test("a weight over many decades has a slider of powers of ten", async ({ lab, page }) => {
  await lab.open("size=64");
  await lab.unfold();
  await page.getByText("Weights", { exact: true }).click();
  const weights = page.locator("#fields-weights");
  await weights.getByRole("slider", { name: "λ light" }).fill("-3");
  await expect(weights.getByRole("spinbutton", { name: "λ light" })).toHaveValue("0.001");
  await expect(page).toHaveURL(/lightPrior=0\.001/);
  await expect(weights.getByRole("slider", { name: "λ light" })).toHaveValue("-3");
});

test("a pose with a rival says so, and the rival can be seen and chosen", LONG, async ({ lab, page }) => {
  await lab.visit("surface=vase&light=window&beta=30&size=64&noise=0.08");
  const height = await panelHeight(lab);
  await expect(page.locator("#rivals")).toBeHidden();
  const places = () =>
    page
      .locator("#panel, #pose, #pose-error, #light, #clouds-box")
      .evaluateAll((parts) => parts.map((part) => JSON.stringify(part.getBoundingClientRect())));
  const before = await places();
  await page.getByLabel("Speed").selectOption({ label: "fastest" });
  await page.getByRole("button", { name: "Play" }).click();
  await lab.reaches("ambiguous");
  await expect(page.locator("#verdict")).toContainText("One other pose fits the image equally well");
  await expect(page.locator("#status-icon")).toHaveText("?");
  await expect(page.locator("#next")).toContainText("poses on the surfaces");
  expect(await panelHeight(lab)).toBe(height);
  const rivals = page.locator("#rivals");
  await expect(rivals.getByRole("button", { name: "best pose" })).toHaveAttribute("aria-pressed", "true");
  const rival = rivals.getByRole("button", { name: /^alternative, \d+° away$/ });
  const away = Number(/\d+/.exec((await rival.textContent()) ?? "")?.[0]);
  const beta = page.locator("#pose tbody tr").nth(2).locator("td").first();
  const [foundBeta, foundOff] = [await beta.textContent(), await lab.errorDegrees()];
  expect(foundOff).toBeLessThan(5);
  await rival.click();
  await expect(rival).toHaveAttribute("aria-pressed", "true");
  // The table shows the rival, without extra space for its actions.
  await expect(page.locator("#pose-found")).toHaveText("alternative");
  await expect(beta).not.toHaveText(String(foundBeta));
  expect(await lab.errorDegrees()).toBeGreaterThan(away - 5);
  await expect(rivals.getByRole("button", { name: "Restart from here" })).toBeVisible();
  // Verdict and light belong to the pose that was found, and their words state it.
  await expect(page.locator("#status")).toHaveText(/^best pose: ambiguous, /);
  await expect(page.locator("#pose-error")).toHaveText(/° from the true rotation \(best pose: \d\.\d\d°\)/);
  await expect(page.locator("#light figcaption").first()).toHaveText("best pose");
  expect(await places()).toEqual(before);
  await rivals.getByRole("button", { name: "best pose" }).click();
  await expect(page.locator("#pose-found")).toHaveText("found");
  await expect(page.locator("#status")).toHaveText(/^ambiguous, /);
  await expect(page.locator("#light figcaption").first()).toHaveText("found");
  await expect(beta).toHaveText(String(foundBeta));
  expect(await lab.errorDegrees()).toBe(foundOff);
  await rival.click();
  await rivals.getByRole("button", { name: "Restart from here" }).click();
  await expect(page).toHaveURL(/start=near/);
});

test("a lost pose has one cause, one remedy, and no sigmas", LONG, async ({ lab, page }) => {
  await lab.visit("light=overcast&size=32&noise=0.2&beta=60&overlap=0.2");
  const height = await panelHeight(lab);
  await page.getByLabel("Speed").selectOption({ label: "fastest" });
  await page.getByRole("button", { name: "Play" }).click();
  await lab.reaches("lost");
  await expect(page.locator("#verdict")).not.toBeEmpty();
  await expect(page.locator("#next")).toHaveText(/would|may find it/);
  expect(await panelHeight(lab)).toBe(height);
  await expect(page.locator("#pose-extra dt", { hasText: "Overlap" })).toBeVisible();
  for (const sigma of await page.locator("#pose-extra dt", { hasText: "σ" }).all()) await expect(sigma).toBeHidden();
});

test("a stage explains the method that runs", async ({ lab, page }) => {
  for (const [settings, stage, words] of [
    ["", "registration", "Equations 12 to 16"],
    ["registration=joint", "registration", "until its normals predict the colours"],
    ["registration=fixed", "registration", "The pose stays at its initial value"],
    ["", "surface", "Normals give slopes"],
    ["shading=surface", "surface", "The unknowns are the heights themselves"],
    ["lighting=estimate", "light", "Robust least squares fits them"],
    ["", "light", "Only the exposure of the image"],
  ] as const) {
    // Only the address changes: the page handles it a moment later, so the first click may come too early.
    await lab.open(`size=32${settings && "&"}${settings}`);
    await expect(async () => {
      await page.keyboard.press("Escape");
      await page.getByRole("button", { name: new RegExp(`^${stage}`) }).click();
      await expect(page.locator("#explanation")).toContainText(words, { timeout: 5_000 });
    }).toPass();
    await expect(page.locator("#explanation math")).toHaveCount(settings === "registration=fixed" ? 0 : 1);
    await page.keyboard.press("Escape");
  }
});

test("each number has its explanation", async ({ lab, page }) => {
  await lab.open("size=32");
  for (const name of ["Overlap", "Inliers", "Colour residual", "Rotation change", "Objective"]) {
    await page
      .getByRole("button", { name: `What is "${name}"?` })
      .last()
      .click();
    await expect(page.locator("#explanation h2")).toBeVisible();
    expect((await page.locator("#explanation p").first().textContent())?.length).toBeGreaterThan(40);
    await page.keyboard.press("Escape");
  }
});

test("errors are mapped where the truth is known, and nowhere else", async ({ lab, page }) => {
  await lab.open("size=64");
  await expect(page.locator("#errors")).toBeVisible();
  const before = await lab.fingerprint("Error of normals");
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  await expect.poll(() => lab.fingerprint("Error of normals")).not.toBe(before);
});

test("charts say in words what they show, and begin with the first iteration", async ({ lab, page }) => {
  await lab.open("size=32");
  await expect(page.locator("#objective-chart")).toHaveAttribute("aria-label", /total: none yet/);
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  await expect(page.locator("#objective-chart")).toHaveAttribute("aria-label", /total: from \d/);
});

test("a rotation that does not change leaves no empty chart, but words", async ({ lab, page }) => {
  await lab.open("size=32");
  const words = page.locator("#rotation-chart .still");
  await expect(words).toBeHidden();
  await lab.visit("size=32&start=identity&registration=fixed");
  await page.keyboard.press("s");
  await expect(lab.iteration).toHaveText("1");
  await expect(words).toBeVisible();
  await expect(page.locator("#rotation-chart")).toHaveAttribute("aria-label", /change, deg: zero throughout/);
});

test(
  "where a rotation has come to rest, table and chart say zero, and that the axis leaves it out",
  LONG,
  async ({ lab, page }) => {
    await lab.visit("size=32&start=near");
    await page.getByRole("button", { name: "Play" }).click();
    await expect(page.locator("#status")).toHaveAttribute("data-state", /converged|ambiguous|lost/);
    await expect(page.locator("#pose-extra")).toContainText(/Rotation change\??\s*0°/);
    await expect(page.locator("#rotation-chart")).toHaveAttribute(
      "aria-label",
      /change, deg: from \S+ to 0, zero in \d of \d+ iterations \(not shown on a logarithmic axis\)\./,
    );
    await expect(page.locator("#rotation-chart .still")).toHaveText(
      /^Zero in \d of \d+ iterations \(not shown on a logarithmic axis\)\.$/,
    );
  },
);

test("files dropped anywhere go where their content belongs", async ({ lab, page }) => {
  await lab.open("size=32");
  const { encode } = await import("fast-png");
  const side = 48;
  const disc = (inside: number) => (_: unknown, i: number) =>
    Math.hypot((i % side) - 23.5, Math.floor(i / side) - 23.5) < 20 ? inside : 0;
  const colour = encode({
    width: side,
    height: side,
    depth: 8,
    channels: 3,
    data: Uint8Array.from({ length: 3 * side * side }, (_, i) => 60 + ((5 * i) % 120)),
  });
  const depth = encode({
    width: side,
    height: side,
    depth: 16,
    channels: 1,
    data: Uint16Array.from({ length: side * side }, disc(90)),
  });
  const mask = encode({
    width: side,
    height: side,
    depth: 8,
    channels: 1,
    data: Uint8Array.from({ length: side * side }, disc(255)),
  });
  const files = [
    ["a.png", depth],
    ["b.png", mask],
    ["c.png", colour],
  ] as const;
  const carried = await page.evaluateHandle(
    (files) => {
      const transfer = new DataTransfer();
      for (const [name, bytes] of files)
        transfer.items.add(new File([new Uint8Array(bytes)], name, { type: "image/png" }));
      return transfer;
    },
    files.map(([name, bytes]) => [name, [...bytes]] as const),
  );
  await page.locator("#hero").dispatchEvent("drop", { dataTransfer: carried });
  const slots = page.locator(".slot");
  await expect(slots.nth(0)).toContainText("c.png");
  await expect(slots.nth(1)).toContainText("a.png");
  await expect(slots.nth(2)).toContainText("b.png");
  await lab.reaches("ready");
  // The sample's truth is no longer shown.
  await expect(page.locator("#errors")).toBeHidden();
  await expect(page.locator("#pose-error")).toBeHidden();
  await expect(page.locator("#light .ball").filter({ visible: true })).toHaveCount(1);
});
