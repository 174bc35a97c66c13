#!/usr/bin/env node
/** `npx bimodal-stereo`: the commands of the package. */
import { Mistake, argumentsOf } from "./arguments.js";
import { BAD, check } from "./check.js";
import { CHECK_HELP, HELP } from "./help.js";
import { versionOf } from "./version.js";

const INTERRUPTED = 130;

/** The message of a mistake, of an error of the package or of a system error is all that the user needs. */
const isForeseen = (error: unknown): error is Error =>
  error instanceof Mistake ||
  (error instanceof Error && (error.name === "BimodalError" || ("syscall" in error && error.syscall !== undefined)));

function print(text: string): number {
  process.stdout.write(text);
  return 0;
}

async function run([command, ...rest]: string[]): Promise<number> {
  if (command === undefined || command === "--help" || command === "-h") return print(HELP);
  if (command === "--version" || command === "-V") return print(`bimodal-stereo ${versionOf()}\n`);
  if (command !== "check") throw new Mistake(`there is no command "${command}"; --help lists them`);
  const args = argumentsOf(rest);
  if (args === "help") return print(CHECK_HELP);
  return args === "version" ? print(`bimodal-stereo ${versionOf()}\n`) : check(args);
}

try {
  process.exitCode = await run(process.argv.slice(2));
} catch (error) {
  // Node's own exit code for failures is 1, which means "off" here.
  const isAbort = error instanceof Error && error.name === "AbortError";
  const words = isForeseen(error) ? error.message : error instanceof Error ? error.stack : String(error);
  process.stderr.write(`${isAbort ? "interrupted" : words}\n`);
  process.exitCode = isAbort ? INTERRUPTED : BAD;
}
