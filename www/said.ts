/** What the library says of a run, in the page's words: an option that it names as a program would is called what it is. */

const NAMES = [
  ["startTolerance", "the start's tolerance"],
  ["`scale` or `start.scale` takes another one", "another one can be told as the scale"],
  ["check depth.unit", "check the depth map's unit"],
] as const;

export const inWords = (message: string): string =>
  NAMES.reduce((words, [name, said]) => words.replace(name, said), message);
