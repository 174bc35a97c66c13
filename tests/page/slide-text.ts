/** The visible texts of a part of a slide, with their sizes and places. */

import type { Page } from "@playwright/test";

export interface SlideText {
  words: string;
  /** Height of the type, px; that of a drawing is scaled with the drawing. */
  size: number;
  left: number;
  right: number;
  top: number;
  bottom: number;
  isInFigure: boolean;
  /** The edges of the drawing that contains the text, if one does. */
  drawing: { left: number; right: number } | undefined;
  /** Whether an element around the text is too small for it. */
  isCut: boolean;
}

/** The options of a closed select are not drawn. */
const LEFT_OUT = "option";

export const textsIn = (page: Page, part: string): Promise<SlideText[]> =>
  page.locator(part).evaluate((root, leftOut) => {
    const found: SlideText[] = [];
    const walk = document.createTreeWalker(root, NodeFilter.SHOW_TEXT);
    for (let node = walk.nextNode(); node; node = walk.nextNode()) {
      const [words, element] = [node.textContent?.trim() ?? "", node.parentElement];
      const range = document.createRange();
      range.selectNodeContents(node);
      const { left, right, top, bottom, width } = range.getBoundingClientRect();
      if (!words || !element || !width || element.closest(`${leftOut}, .visually-hidden`)) continue;
      const drawing = element.closest("svg");
      const box = drawing?.getBoundingClientRect();
      const enlarged = box && drawing ? box.width / drawing.viewBox.baseVal.width : 1;
      const around = element.closest<HTMLElement>("button, li, p, dt, dd, label");
      found.push({
        words,
        size: enlarged * Number.parseFloat(getComputedStyle(element).fontSize),
        ...{ left, right, top, bottom },
        isInFigure: element.closest(".learn-figure") !== null,
        drawing: box && { left: box.left, right: box.right },
        isCut: around !== null && around.scrollWidth > around.clientWidth + 1,
      });
    }
    return found;
  }, LEFT_OUT);

/** The smallest type that can be read from the last row, px. */
export const LEAST_TYPE = 18;

export const tooSmall = (texts: readonly SlideText[]): string[] =>
  texts.filter(({ size }) => size < LEAST_TYPE).map(({ size, words }) => `${size} px: ${words}`);
