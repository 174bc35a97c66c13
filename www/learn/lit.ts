/** Highlights related parts together: the symbol under the pointer and its marks, curves and numbers in the figure, or the reverse. */

const PREFIX = "learn-ink-";

const inkOf = (element: Element): string | undefined => [...element.classList].find((name) => name.startsWith(PREFIX));

export function lightTogether(article: HTMLElement): void {
  let now: string | undefined;
  article.addEventListener("pointerover", ({ target }) => {
    const found = target instanceof Element ? target.closest(`[class*="${PREFIX}"]`) : null;
    const ink = found ? inkOf(found) : undefined;
    if (ink === now) return;
    now = ink;
    for (const lit of article.querySelectorAll(".learn-lit")) lit.classList.remove("learn-lit");
    if (ink) for (const each of article.querySelectorAll(`.${ink}`)) each.classList.add("learn-lit");
    article.classList.toggle("learn-has-lit", ink !== undefined);
  });
  article.addEventListener("pointerleave", () => {
    now = undefined;
    article.classList.remove("learn-has-lit");
    for (const lit of article.querySelectorAll(".learn-lit")) lit.classList.remove("learn-lit");
  });
}
