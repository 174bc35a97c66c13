/** Numbers as the language of the page writes them. */

import { decimals as plainDecimals, short as plainShort } from "../draw/numbers";
import { inFigures } from "../words";

export const decimals = (value: number | null | undefined, count: number): string =>
  inFigures(plainDecimals(value, count));
export const short = (value: number): string => inFigures(plainShort(value));

/** A number before its unit; only the sign for degrees follows without a space. */
export function withUnit(number: string, unit: string | undefined): string {
  if (unit === undefined) return number;
  return unit === "°" ? `${number}°` : `${number} ${unit}`;
}
