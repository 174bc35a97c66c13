/** Checks the input of writers by name, because readers of the written file would trust wrong contents. */
import { BimodalError, type ErrorCode, refused } from "../../errors.js";

/** `value` is the refused value, and `index` the position of the entry. */
export const fault = (
  code: ErrorCode,
  field: string,
  words: string,
  { value, index }: { value?: unknown; index?: number } = {},
): BimodalError => new BimodalError(code, `${field}: ${words}`, field, refused(value, index));

/** Checks that a value is one of some words. */
export function oneOf(words: readonly string[], value: unknown, field: string): void {
  if (!words.some((word) => word === value))
    throw fault("option", field, `"${String(value)}" is unknown; known: ${words.join(", ")}`, { value });
}

/** In an example, a list has one entry, and "*" stands for arbitrary names of members. Members that it lacks are not checked. */
export type Example = readonly Example[] | { readonly [name: string]: Example };

/** Checks that the lists and objects of an example are present. */
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
