/** The report of a run as a file: its numbers, the page's information about the files, and how to repeat it. Loaded when one is saved. */

import { version } from "../../pkg/package.json";
import type { Calls } from "./protocol";
import { type Overlay, reportHtml, shellCheck } from "./report";
import type { Rig } from "./rig";
import { isRestricted, shellOf } from "./shell";
import type { Item, Run } from "./state";
import { whole } from "./words";

/** The codes of a file's warnings; a unit that the visitor has confirmed is no longer a guess. */
const notesOf = ({ summary }: Item): string[] =>
  [...new Set((summary?.warnings ?? []).map(({ code }) => code))].filter(
    (code) => code !== "unit-guessed" || summary?.guessed.includes("unit"),
  );

/** The files that were read, with their hashes. */
export const inputsOf = (rig: Rig): Promise<Calls["inputs"]["answer"]> =>
  rig.session.call("inputs", {
    items: rig.items.map((item) => ({
      file: item.id,
      name: item.name,
      says: item.summary?.says ?? "not read",
      notes: notesOf(item),
      ...(item.blob ? { blob: item.blob } : {}),
    })),
  });

/** The browser's name and version, the most specific of those that it claims. */
function browser(): string {
  const agent = navigator.userAgent;
  const [name] = /(?:Firefox|Edg|OPR|HeadlessChrome|Chrome|Version)\/[\d.]+/.exec(agent) ?? ["unknown"];
  const [, system] = /\(([^;)]+)/.exec(agent) ?? [];
  return `${name.replace("Version/", "Safari ").replace("/", " ")}${system ? `, ${system}` : ""}`;
}

function settingsOf(rig: Rig, run: Run): [string, string][] {
  const units = new Set(run.plans.map(({ depth }) => rig.item(depth)?.unit));
  const given = [...units].map((unit) => (unit === undefined ? "as the files state it or as guessed" : `${unit} m`));
  return [
    ["cues", run.cues.length > 0 ? run.cues.join(",") : "all"],
    ["frames", String(run.plans.length)],
    ["unit", given.join(" and ")],
    ["masks drawn", run.plans.some(({ paint }) => paint) ? "yes" : "no"],
    ["depths restricted", run.plans.some(({ range }) => range) ? "yes" : "no"],
  ];
}

/** Number of digits of a hash that are enough to distinguish versions. */
const HASH = 16;
const ESTIMATE = "The command checks a calibration; none was given here.";
const LIKE = "Type it in the folder that holds these files and no others.";
const DIFFERS = " It has no option for drawn masks and depth ranges, so its numbers will differ.";
const NO_FILES =
  "The frames are not files: they came from the example, a recording or a robot, so no command can repeat the check.";

/** The report as HTML. */
export async function reportOf(rig: Rig, run: Run, overlays: Overlay[]): Promise<string> {
  const { inputs, module } = await inputsOf(rig);
  const isShell = !run.estimateOnly && inputs.every(({ bytes }) => bytes !== undefined);
  const [name] = Object.keys(run.candidates);
  return reportHtml(whole(run), [], {
    title: run.estimateOnly ? "Estimate of a calibration" : `Check of ${name}`,
    made: new Date(),
    isEstimate: run.estimateOnly,
    calibrations: run.candidates,
    inputs,
    overlays,
    settings: settingsOf(rig, run),
    versions: [
      ["bimodal-stereo", version],
      ...(module ? [["wasm", `SHA-256 ${module.slice(0, HASH)}`] as const] : []),
      ["browser", browser()],
    ],
    shell: isShell
      ? { command: shellCheck(shellOf(rig, run)), note: LIKE + (isRestricted(run) ? DIFFERS : "") }
      : { note: run.estimateOnly ? ESTIMATE : NO_FILES },
  });
}
