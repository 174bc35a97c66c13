/**
 * Numbers that read back as the very same ones: the shortest digits that do, with a point, since YAML 1.1 takes 1e-7 for
 * a word and readers in C++ take 1 for an integer. JSON, YAML, C++ and Python all read what comes out.
 */
export function real(value: number): string {
  const text = String(value);
  return text.includes(".") ? text : text.replace(/(?=e|$)/, ".0");
}

export const list = (values: ArrayLike<number>): string => Array.from(values, real).join(", ");
