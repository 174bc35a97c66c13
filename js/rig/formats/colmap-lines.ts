/** Lines of COLMAP's texts. A separate module, because the first files of a check need no more of COLMAP's reader. */

/** The lines that are neither empty nor comments. */
export const linesOf = (text: string): string[] =>
  text.split(/\r?\n/).filter((line) => line.trim() !== "" && !line.trim().startsWith("#"));
