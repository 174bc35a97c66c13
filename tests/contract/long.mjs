/** The options of a test of over three seconds, which a shorter one makes up for: `npm test -- --long` runs it, `npm test` does not. */
export const LONG = { skip: process.env.LONG_TESTS ? false : "it takes long: npm test -- --long" };
