/** The page around every report: it has no script, and its policy allows none. */
import { fault } from "../built.js";
import { Markup, type Part, html } from "./markup.js";
import { STYLE, STYLE_SHA256 } from "./style.js";

const POLICY = `default-src 'none'; img-src data:; style-src 'sha256-${STYLE_SHA256}'; base-uri 'none'; form-action 'none'`;

/** A date as a report prints it. */
export function dateOf(made: Date | undefined, field: string): string | undefined {
  if (made !== undefined && !(made instanceof Date && made.getTime() <= Infinity))
    throw fault("type", field, "must be a valid Date");
  return made && `${made.toISOString().slice(0, 16).replace("T", " ")} UTC`;
}

export const heading = (title: string, date: string | undefined): Markup =>
  html`<header><h1>${title}</h1>${date === undefined ? undefined : html`<p class="soft">${date}</p>`}</header>`;

export function reportPage(title: string, header: Markup, body: Part): string {
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
${header}
<main>
${body}
</main>
<footer>Made by bimodal-stereo. This file is self-contained.</footer>
</body>
</html>
`;
  return String(page);
}
