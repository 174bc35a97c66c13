/** Reports the skipped tests with their reasons, which Playwright's list omits. */

import type { Reporter, TestCase, TestResult } from "@playwright/test/reporter";

export default class Skipped implements Reporter {
  onTestEnd(test: TestCase, { status, annotations }: TestResult): void {
    if (status !== "skipped") return;
    const reason = annotations.find(({ type }) => type === "skip" || type === "fixme")?.description;
    console.log(`skipped: ${test.title} # ${reason ?? "no reason given"}`);
  }
}
