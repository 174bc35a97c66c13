/** What a visit asks for and what the page's policy refuses, whatever is looked at. */

import type { BrowserContext, Page } from "@playwright/test";

/** What the policy has refused in any document of the page. */
export async function refusals(page: Page): Promise<string[]> {
  const found: string[] = [];
  await page.exposeFunction("refused", (what: string) => void found.push(what));
  await page.addInitScript(() => {
    document.addEventListener("securitypolicyviolation", ({ violatedDirective, blockedURI, sample }) => {
      (window as unknown as { refused(what: string): void }).refused(`${violatedDirective}: ${blockedURI} ${sample}`);
    });
  });
  return found;
}

/** Addresses that were asked for, the service worker's included; what a document holds itself is not asked for. */
export function requests(context: BrowserContext): string[] {
  const found: string[] = [];
  context.on("request", (request) => {
    if (!/^(data|blob):/.test(request.url())) found.push(request.url());
  });
  return found;
}
