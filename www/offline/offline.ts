/** Stores the page's files for visits without a network, and reports the state. The development server has no such files. */

import { language, phrase } from "../words";

export async function keepForOffline(line: HTMLElement): Promise<void> {
  if (!import.meta.env.PROD || !("serviceWorker" in navigator)) return;
  // The page itself loads first.
  if (document.readyState !== "complete")
    await new Promise((loaded) => addEventListener("load", loaded, { once: true }));
  try {
    const registration = await navigator.serviceWorker.register("./sw.js");
    const tell = (): void => {
      if (registration.waiting)
        line.textContent = phrase(
          "offline.newer",
          "A newer version is ready. To use it, close every tab of this page and open it again.",
        );
      else if (registration.active) line.textContent = phrase("offline.works", "It works offline.");
    };
    const follow = (worker: ServiceWorker | null): void =>
      worker?.addEventListener("statechange", () => {
        tell();
        const isRefused = worker.state === "redundant" && !registration.active && !registration.waiting;
        if (isRefused)
          line.textContent = phrase(
            "offline.refused",
            "This browser could not store a copy of the page (its storage may be full), so the page needs a network connection.",
          );
      });
    follow(registration.installing);
    registration.addEventListener("updatefound", () => follow(registration.installing));
    language.addEventListener("changed", tell);
    tell();
  } catch {
    // Private windows, and pages that are not served over https, have no service workers; the page then needs its network.
  }
}
