/** The arguments of `check`. */
import { parseArgs } from "node:util";
import type { CheckCue } from "../types/index.js";

/** A mistake of the user; only its message is printed. The code and the field are those of the contract's errors. */
export class Mistake extends Error {
  readonly code: "option" | "file";
  readonly field: string;

  constructor(message: string, field?: string) {
    super(message);
    this.code = field === "file" ? "file" : "option";
    this.field = field ?? "arguments";
  }
}

export interface Arguments {
  folder: string;
  /** Files of calibrations; the calibration to be checked comes first. */
  calibrations: string[];
  isInverted: boolean;
  cameras: string[];
  reading: { frames?: number; unit?: number };
  checking: { workers?: number; cues?: CheckCue[] };
  json?: string;
  report?: string;
}

const text = { type: "string" } as const;
const many = { type: "string", multiple: true } as const;
const flag = { type: "boolean" } as const;
const OPTIONS = {
  ...{
    calibration: many,
    cameras: many,
    cues: text,
    frames: text,
    json: text,
    report: text,
    unit: text,
    workers: text,
  },
  ...{ inverted: flag, help: { ...flag, short: "h" }, version: { ...flag, short: "V" } },
} as const;

function parsed(args: string[]) {
  try {
    return parseArgs({ args, options: OPTIONS, allowPositionals: true });
  } catch (error) {
    throw new Mistake(error instanceof Error ? error.message : String(error));
  }
}

function number(written: string | undefined, name: string): number | undefined {
  if (written === undefined) return undefined;
  const value = Number(written);
  if (written.trim() === "" || !Number.isFinite(value)) throw new Mistake(`--${name} needs a number, not "${written}"`);
  return value;
}

/** The arguments, or the text that was requested instead. */
export function argumentsOf(args: string[]): Arguments | "help" | "version" {
  const { values, positionals } = parsed(args);
  if (values.help) return "help";
  if (values.version) return "version";
  const [folder, ...rest] = positionals;
  if (folder === undefined || rest.length > 0)
    throw new Mistake(`one folder is needed, not ${positionals.length}; --help prints the manual`);
  if (!values.calibration) throw new Mistake("--calibration FILE is needed; --help prints the manual");
  const [frames, unit, workers] = [
    number(values.frames, "frames"),
    number(values.unit, "unit"),
    number(values.workers, "workers"),
  ];
  // The check itself refuses a cue that it does not know.
  const cues = values.cues?.split(",").map((cue) => cue.trim() as CheckCue);
  return {
    folder,
    calibrations: values.calibration,
    isInverted: values.inverted === true,
    cameras: values.cameras ?? [],
    reading: { ...(frames !== undefined && { frames }), ...(unit !== undefined && { unit }) },
    checking: { ...(workers !== undefined && { workers }), ...(cues !== undefined && { cues }) },
    ...(values.json !== undefined && { json: values.json }),
    ...(values.report !== undefined && { report: values.report }),
  };
}
