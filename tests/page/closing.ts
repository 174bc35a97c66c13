/** Browsers report the end of a dialog later than they close it. Here a test decides when. */

import type { Locator } from "@playwright/test";

/** Closes an open dialog, and keeps the event of its end from the page. */
export const closeSilently = (dialog: Locator): Promise<void> =>
  dialog.evaluate((each: HTMLDialogElement) => {
    addEventListener("close", (event) => event.stopImmediatePropagation(), { capture: true, once: true });
    each.close();
  });

/** Sends the event that was kept back. */
export const reportEnd = (dialog: Locator): Promise<boolean> =>
  dialog.evaluate((each) => each.dispatchEvent(new Event("close")));
