/** The style of the lessons' figures for a shadow root. */

import words from "../style/learn.css?inline";
import waiting from "../style/learn-blank.css?inline";
import parts from "../style/learn-figure.css?inline";
import marks from "../style/learn-marks.css?inline";
import tokens from "../style/tokens.css?inline";
import own from "./figure.css?inline";

/** The page's rules for its root apply to the element here. */
const inShadow = (text: string): string =>
  text.replaceAll(/:root\[([^\]]+)\]/g, ":host([$1])").replaceAll(":root", ":host");

let sheet: CSSStyleSheet | undefined;
export function styled(root: ShadowRoot): void {
  if (!sheet) {
    sheet = new CSSStyleSheet();
    sheet.replaceSync([tokens, words, parts, marks, waiting, own].map(inShadow).join("\n"));
  }
  root.adoptedStyleSheets = [sheet];
}
