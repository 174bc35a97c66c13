/** Decimal commas, "0,998301", as spreadsheets in many languages write them. */

/** A number with a comma and its fraction. */
const NUMBER = /^[-+]?\d+,\d+(?:[eE][-+]?\d+)?$/;
const MOST = 4_000_000;

/**
 * The text with decimal points in place of decimal commas; undefined if its commas may separate numbers. Commas count as decimal if every
 * number has at most one comma and no point, and if either one number has three digits after it or begins with "0,", or each number has a
 * line and a name.
 */
export function withPoints(text: string): string | undefined {
  if (text.length > MOST || !/\d,\d/.test(text) || /\d\.\d/.test(text) || /[[{]/.test(text)) return undefined;
  const words = text.split(/[\s;=:]+/).filter((word) => /\d,/.test(word) || /,\d/.test(word));
  if (!words.every((word) => NUMBER.test(word))) return undefined;
  const isSure = words.some((word) => /,\d{3}/.test(word) || /^[-+]?0,/.test(word));
  const isNamed = text
    .split(/\r?\n/)
    .every((line) => !/\d,\d/.test(line) || /^\s*[A-Za-z_][\w ]*[:=\s]\s*[-+]?\d+,\d+\s*$/.test(line));
  if (!isSure && !isNamed) return undefined;
  // Spaces around semicolons keep the words apart.
  return text.replace(/(\d),(\d)/g, "$1.$2").replace(/;/g, " ; ");
}
