/** Options of a test over three seconds for which shorter tests stand in: it runs with `npm test -- --long`, not with `npm test`. */
export const LONG = { skip: process.env.LONG_TESTS ? false : "it takes long: npm test -- --long" };
