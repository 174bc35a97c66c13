/** Records a visit's requests and the violations of the page's policy. */

import type { BrowserContext, Page } from "@playwright/test";

/** The violations in any document of the page. */
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

/** Requested addresses, including the service worker's, without a document's own data. */
export function requests(context: BrowserContext): string[] {
  const found: string[] = [];
  context.on("request", (request) => {
    if (!/^(data|blob):/.test(request.url())) found.push(request.url());
  });
  return found;
}
