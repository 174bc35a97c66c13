/** Says which tests did not run and why, which the list of them leaves out. */

import type { Reporter, TestCase, TestResult } from "@playwright/test/reporter";

export default class Skipped implements Reporter {
  onTestEnd(test: TestCase, { status, annotations }: TestResult): void {
    if (status !== "skipped") return;
    const reason = annotations.find(({ type }) => type === "skip" || type === "fixme")?.description;
    console.log(`skipped: ${test.title} # ${reason ?? "no reason given"}`);
  }
}
