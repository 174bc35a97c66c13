/**
 * Options of a test over three seconds for which shorter tests stand in, and of those that compile the command line: they run with
 * `npm test -- --long`, not with `npm test`.
 */
export const LONG = { skip: process.env.LONG_TESTS ? false : "it takes long: npm test -- --long" };

/** Options of a long test with a requirement; `missing` states why it is not met. */
export const longUnless = (missing) => (missing ? { skip: missing } : LONG);
