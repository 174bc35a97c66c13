/**
 * A check of a rig as one HTML file that asks for nothing else: it can be kept, mailed and printed. It has no script, its policy
 * allows none, and whatever comes from files is escaped.
 */
import { BimodalError } from "../../../errors.js";
import type { CheckReport } from "../../../types.js";
import type { Picture, ReportOptions } from "./contents.js";
import { Markup, html } from "./markup.js";
import {
  candidateTable,
  cueTable,
  estimateSection,
  frameTable,
  inputTable,
  pictureSection,
  sensitivitySection,
  verdictCard,
  warningList,
} from "./sections.js";
import { STYLE, STYLE_SHA256 } from "./style.js";

export type { Picture, ReportInput, ReportOptions } from "./contents.js";

/** Pixels in the file itself; SVG may ask for other files. */
const PICTURE = /^data:image\/(?:png|jpeg|webp|avif|gif);base64,[A-Za-z0-9+/]+={0,2}$/;

function checkPicture({ dataUrl }: Picture, index: number): void {
  const field = `pictures[${index}].dataUrl`;
  if (!PICTURE.test(dataUrl)) throw new BimodalError("type", `${field}: must be a data URL of a PNG, JPEG, WebP, AVIF or GIF`, field);
}

const POLICY = `default-src 'none'; img-src data:; style-src 'sha256-${STYLE_SHA256}'; base-uri 'none'; form-action 'none'`;

export function reportHtml(report: CheckReport, pictures: readonly Picture[] = [], options: ReportOptions = {}): string {
  pictures.forEach(checkPicture);
  const { title = "Check of a calibration", made, inputs = [] } = options;
  const date = made && `${made.toISOString().slice(0, 16).replace("T", " ")} UTC`;
  const body = [
    ...[verdictCard(report), warningList(report), candidateTable(report), pictureSection(pictures), cueTable(report)],
    ...[frameTable(report), sensitivitySection(report), estimateSection(report), inputTable(inputs)],
  ];
  const page = html`<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="${POLICY}">
<meta name="referrer" content="no-referrer">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>${title}</title>
<style>${new Markup(STYLE)}</style>
</head>
<body>
<header><h1>${title}</h1>${date === undefined ? undefined : html`<p class="soft">${date}</p>`}</header>
<main>
${body}
</main>
<footer>Made by bimodal-stereo. This file holds everything it shows.</footer>
</body>
</html>
`;
  return String(page);
}
