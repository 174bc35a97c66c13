/** The command that repeats a check in a shell. */

/** The arguments of the command; after the first two, only those that differ from the defaults. */
export interface ShellCheck {
  /** The folder of the frames. */
  folder: string;
  /** The files of the calibrations, the one in question first. */
  calibrations: readonly string[];
  /** Files of intrinsics that the command names. */
  cameras?: readonly string[] | undefined;
  /** Whether the calibrations map colour to depth. */
  isInverted?: boolean | undefined;
  /** Metres per stored number. */
  unit?: number | undefined;
  /** Largest number of pairs. */
  frames?: number | undefined;
  /** The cues to use. */
  cues?: readonly string[] | undefined;
  /** Threads. */
  workers?: number | undefined;
  /** Files that must be written first, because no file with this content exists. */
  written?: readonly { name: string; text: string }[] | undefined;
}

/** Quotes a word for a POSIX shell. A leading dash would be an option. */
const quoted = (word: string): string => {
  const path = word.startsWith("-") ? `./${word}` : word;
  return /^[\w./,:@%+=-]+$/.test(path) ? path : `'${path.replaceAll("'", `'\\''`)}'`;
};

/** The command, after the files that it needs. */
export function shellCheck({ written = [], ...given }: ShellCheck): string {
  const { folder, calibrations, cameras = [], isInverted, unit, frames, cues, workers } = given;
  const files = written.map(({ name, text }) => `cat > ${quoted(name)} <<'END'\n${text.trimEnd()}\nEND\n`);
  const option = (name: string, value: string | number | undefined) =>
    value === undefined ? [] : [`--${name} ${quoted(String(value))}`];
  const words = [
    quoted(folder),
    ...calibrations.flatMap((path) => option("calibration", path)),
    ...cameras.flatMap((path) => option("cameras", path)),
    ...(isInverted ? ["--inverted"] : []),
    ...[
      ...option("unit", unit),
      ...option("frames", frames),
      ...option("cues", cues?.join(",")),
      ...option("workers", workers),
    ],
  ];
  return `${files.join("")}npx bimodal-stereo check ${words.join(" ")}`;
}
