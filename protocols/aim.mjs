/** One aim: a measured value against a limit, in the sense "<=" or ">="; without rows, the verdict is null. */
export function aim(table, what, measured, sense, limit, rows) {
  const known = typeof measured === "number" && rows > 0;
  const ok = known ? (sense === "<=" ? measured <= limit : measured >= limit) : null;
  return { table, what, measured: known ? measured : null, sense, limit, rows, ok };
}
