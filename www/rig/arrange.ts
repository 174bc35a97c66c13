/** Files that were added one by one, arranged by the readers of folders: which camera took which pictures, and which poses matter. */

import type { RigState } from "./state";

/**
 * Arranges the files. Candidates from files that were arranged earlier keep the visitor's choices, and all candidates do if the visitor has
 * changed one meanwhile.
 */
export async function arrange(rig: RigState): Promise<void> {
  const frames = rig.complete.flatMap(({ colour, depth }) =>
    colour === undefined || depth === undefined ? [] : [{ colour, depth }],
  );
  const texts = rig.items.filter(
    ({ blob, summary }) => blob && (summary?.kind === "cameras" || summary?.kind === "poses"),
  );
  if (frames.length === 0 || texts.length === 0) return;
  const asked = { frames, texts: texts.map(({ id }) => id) };
  const before = JSON.stringify(rig.candidates);
  const { cameras, poses, warnings } = await rig.session.call("arrange", asked);
  const left = texts.filter((item) => rig.items.includes(item));
  if (left.length === 0) return;
  rig.arranged = cameras;
  const fresh = new Map(left.filter(({ arranged }) => !arranged).map((item) => [item.id, item]));
  if (JSON.stringify(rig.candidates) === before) {
    rig.candidates = rig.candidates.filter(({ file }) => file === undefined || !fresh.has(file));
    for (const { file, ...pose } of poses) {
      const item = fresh.get(file ?? -1) ?? (file === undefined ? [...fresh.values()][0] : undefined);
      if (item) rig.addPose(pose, item.name, item.id);
    }
  }
  for (const item of fresh.values()) item.arranged = true;
  const known = new Set(rig.notes.map(({ message }) => message));
  rig.notes.push(...warnings.filter(({ message }) => !known.has(message)));
}
