// Draws a figure from pictures, lines over them, titles and legends. The background is white in any theme of the page.
export const INK = "#1f2328";
export const SOFT = "#59636e";
export const ORANGE = "#d55e00";
export const BLUE = "#0072b2";
export const GREEN = "#008060";

const escaped = (words) => words.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll('"', "&quot;");
const short = (value) => String(Math.round(value * 100) / 100);
const LINE = 17;

/** Lines of text; y is the baseline of the first line. */
export const text = (x, y, lines, { size = 13, colour = INK, bold = false, anchor = "start" } = {}) =>
  [lines]
    .flat()
    .map(
      (words, at) =>
        `<text x="${short(x)}" y="${short(y + at * LINE)}" font-size="${size}" fill="${colour}" text-anchor="${anchor}"${bold ? ' font-weight="600"' : ""}>${escaped(words)}</text>`,
    )
    .join("\n");

export const line = (x1, y1, x2, y2, { colour = INK, width = 1, dash } = {}) =>
  `<line x1="${short(x1)}" y1="${short(y1)}" x2="${short(x2)}" y2="${short(y2)}" stroke="${colour}" stroke-width="${width}"${dash ? ` stroke-dasharray="${dash}"` : ""}/>`;

/** An entry of a legend: a coloured bar with its text to the right. */
export const key = (x, y, colour, words) =>
  `<rect x="${short(x)}" y="${short(y - 9)}" width="16" height="7" rx="1" fill="${colour}"/>\n${text(x + 22, y, words)}`;

/** Draws shapes over a picture. They are given in pixels of the raster, with whole numbers at the corners of pixels. */
export function over(box, x, y, width, shapes) {
  const scale = Math.round((1e5 * width) / box.width) / 1e5;
  const place = `translate(${short(x)} ${short(y)}) scale(${scale}) translate(${-box.left} ${-box.top})`;
  return `<g transform="${place}">\n${shapes.join("\n")}\n</g>`;
}

/** A picture at a position of the figure, with shapes over it. */
export function placed({ box, address }, x, y, width, shapes = []) {
  const height = short((width * box.height) / box.width);
  const image = `<image x="${short(x)}" y="${short(y)}" width="${short(width)}" height="${height}" preserveAspectRatio="none" href="${address}"/>`;
  return shapes.length > 0 ? `${image}\n${over(box, x, y, width, shapes)}` : image;
}

/** Line segments as one path; each segment is given by its two ends. */
export const strokes = (segments, colour, width) =>
  `<path d="${segments.map(([x1, y1, x2, y2]) => `M${short(x1)} ${short(y1)}L${short(x2)} ${short(y2)}`).join("")}" stroke="${colour}" stroke-width="${width}" stroke-linecap="round" fill="none"/>`;

/** Draws points as squares with sides of this size. */
export const dots = (points, colour, size) =>
  `<path d="${points.map(([x, y]) => `M${short(x - size / 2)} ${short(y - size / 2)}h${size}v${size}h${-size}z`).join("")}" fill="${colour}"/>`;

/** The whole figure; `words` describe it to screen readers. */
export const figure = (width, height, words, parts) =>
  `${[
    `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" width="${width}" height="${height}" font-family="Helvetica, Arial, sans-serif" role="img">`,
    `<title>${escaped(words)}</title>`,
    `<rect width="${width}" height="${height}" fill="#ffffff"/>`,
    ...parts,
    "</svg>",
  ].join("\n")}\n`;
