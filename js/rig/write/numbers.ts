/**
 * Numbers that read back unchanged: the fewest digits for which this holds, with a decimal point, since YAML 1.1 reads 1e-7 as a word and
 * readers in C++ read 1 as an integer. JSON, YAML, C++ and Python can all read the result.
 */
export function real(value: number): string {
  const text = String(value);
  return text.includes(".") ? text : text.replace(/(?=e|$)/, ".0");
}

export const list = (values: ArrayLike<number>): string => Array.from(values, real).join(", ");
