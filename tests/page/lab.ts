/** Shared by all tests of the page: an open Lab, and a record of errors in the console. */

import { test as base, expect, type Locator, type Page } from "@playwright/test";
import { sayIn, type Say } from "./language";

export { expect };

/** Marks a test over three seconds for which shorter tests stand in: it runs with `npm test -- --long`, not with `npm test`. */
export const LONG = { tag: "@long" };

const PAPER = "lighting=known&start=identity&registration=icp&shading=pixel";

export class Lab {
  readonly page: Page;
  readonly complaints: string[] = [];

  constructor(page: Page) {
    this.page = page;
    page.on("pageerror", (error) => this.complaints.push(error.message));
    page.on("console", (message) => {
      if (message.type() === "error") this.complaints.push(message.text());
    });
  }

  /** Opens the Lab with further settings and the paper's own loop, whose first step is an iteration. */
  async open(settings = ""): Promise<void> {
    await this.visit([settings, PAPER].filter(Boolean).join("&"));
  }

  /** Opens the page as a visitor does, with some settings. */
  async visit(settings = ""): Promise<void> {
    await this.page.goto(`./${settings ? `#${settings}` : ""}`);
    await this.reaches("ready");
  }

  /** Opens the settings, which cover the left of the page. */
  async unfold(): Promise<void> {
    if (!(await this.page.locator("#input").evaluate((drawer: HTMLDetailsElement) => drawer.open)))
      await this.page.locator("#input > summary").click();
  }

  async reaches(state: string): Promise<void> {
    await expect(this.page.locator("#status")).toHaveAttribute("data-state", state);
  }

  get iteration(): Locator {
    return this.page.locator("#iteration");
  }

  /** A hash of a canvas's pixels, to notice changes of the drawing. */
  fingerprint(label: string): Promise<number> {
    return this.page.locator(`canvas[aria-label^="${label}:"]`).evaluate((canvas: HTMLCanvasElement) => {
      const data =
        canvas.getContext("2d")?.getImageData(0, 0, canvas.width, canvas.height).data ?? new Uint8ClampedArray();
      return data.reduce((sum, value) => (sum * 31 + value) % 1_000_003, 7);
    });
  }

  async errorDegrees(): Promise<number> {
    return Number(await this.page.locator("#pose-error").getAttribute("data-degrees"));
  }
}

/** Fails on any error in the console, besides the test's own assertions. */
export const test = base.extend<{ lab: Lab; say: Say }>({
  say: async ({ locale }, use) => use(sayIn(locale)),
  lab: async ({ page }, use) => {
    const lab = new Lab(page);
    await use(lab);
    expect(lab.complaints).toEqual([]);
  },
});
