/** Numbers in messages. */

/** Five significant digits, without zeros at the end: a file's own digits, of which there may be sixteen, hide the value. */
export const digits = (value: number): string => Number(value.toPrecision(5)).toString();
