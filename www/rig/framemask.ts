/** A frame of the rig as the subject of the mask tool. */

import type { Subject } from "./masktool";
import type { Frame, Rig } from "./rig";

const ADVICE =
  "Restrict the check to what you trust: an object and the background behind it, without screens, mirrors, glass or people who moved.";

/** Undefined for a frame without a colour image. */
export function subjectOf(rig: Rig, frame: Frame): Subject | undefined {
  const { colour, depth, paint, range } = frame;
  if (colour === undefined) return undefined;
  return {
    title: `Used part of ${frame.name}`,
    advice: ADVICE,
    paint,
    range,
    picture: () => rig.session.call("picture", { file: colour }),
    depth:
      depth === undefined
        ? undefined
        : (range) => rig.session.call("picture", { file: depth, ...(range ? { range } : {}) }),
    done(painted, chosen) {
      rig.undo.keep(`restricting ${frame.name}`);
      if (painted.data) frame.paint = painted.data;
      else delete frame.paint;
      if (chosen) frame.range = chosen;
      else delete frame.range;
      rig.changed();
    },
  };
}
