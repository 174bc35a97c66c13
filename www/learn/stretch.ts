/** The factor of a depth as a slider sets it. */

/** The flattest relief: at zero there is no shape left. */
const LEAST = 0.1;

export const stretchOf = (value: number): number => (Math.abs(value) < LEAST ? (value < 0 ? -LEAST : LEAST) : value);
