/** Checks the input of writers by name, because the reader of a file would trust wrong contents. */
import { BimodalError, type ErrorCode, refused } from "../../errors.js";

/** `value` is what was refused, and `index` the entry that it is. */
export const fault = (
  code: ErrorCode,
  field: string,
  words: string,
  { value, index }: { value?: unknown; index?: number } = {},
): BimodalError => new BimodalError(code, `${field}: ${words}`, field, refused(value, index));

/** One of some words. */
export function oneOf(words: readonly string[], value: unknown, field: string): void {
  if (!words.some((word) => word === value))
    throw fault("option", field, `"${String(value)}" is unknown; known: ${words.join(", ")}`, { value });
}

/** Lists by one entry, objects by their members, those of any name by "*"; what is in neither is not looked at. */
export type Example = readonly Example[] | { readonly [name: string]: Example };

/** Checks that there are the lists and objects of an example. */
export function like(example: Example, value: unknown, field: string): void {
  const isList = Array.isArray(example);
  const members = Object(value) as Record<string, unknown>;
  if (members !== value || Array.isArray(value) !== isList)
    throw fault("type", field, `must be ${isList ? "a list" : "an object"}`, { value });
  for (const [name, member] of Object.entries(example)) {
    for (const key of isList || name === "*" ? Object.keys(members) : [name])
      like(member, members[key], field + (isList ? `[${key}]` : `.${key}`));
  }
}
