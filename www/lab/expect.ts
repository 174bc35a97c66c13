/** What to expect of a pair before it is run. The figures are those of docs/guide/limits.md, which says how they were measured. */

import type { Look } from "./look";

export interface Facts {
  colour: Look;
  depth: Look;
  masks: { colour: boolean; depth: boolean };
  cameras: { colour: boolean; depth: boolean };
  /** Focal lengths, where both cameras are known. */
  focal?: { colour: number; depth: number };
}

export interface Expectation {
  words: string;
  /** Whether the visitor can improve it. */
  isDoubt: boolean;
}

/** Sides up to which `docs/guide/limits.md` calls a view small, and the share of pixels below which a depth map has few. */
const [SMALL, TINY, SPARSE] = [64, 32, 0.3];

const sides = ({ width = 0, height = 0 }: Look): [number, number] => [width, height];

function ofSize(colour: Look, depth: Look): Expectation {
  const least = Math.min(...sides(colour), ...sides(depth));
  const sizes = `Picture ${sides(colour).join("×")}, depth map ${sides(depth).join("×")}.`;
  if (least <= TINY) return { words: `${sizes} At 32×32 no pose is certain to a degree.`, isDoubt: true };
  if (least <= SMALL)
    return { words: `${sizes} Of 72 scenes of 40 to 64 pixels 49 converge, all within three degrees.`, isDoubt: true };
  return {
    words: `${sizes} Large enough; a photograph beyond a megapixel is reduced to what the depth map can use.`,
    isDoubt: false,
  };
}

function ofCameras({ cameras, masks }: Facts): Expectation {
  if (cameras.colour && cameras.depth)
    return {
      words: masks.colour
        ? "Both cameras are known. With a mask, silhouettes give the pose to a degree or two and some millimetres, also under varying albedo."
        : "Both cameras are known, so the pose is in metres. A mask of the picture would let silhouettes help.",
      isDoubt: !masks.colour,
    };
  if (!cameras.colour && !cameras.depth)
    return {
      words:
        "No camera is known, so both views count as orthographic: fine from afar or for renders. The distance along the line of sight cannot be observed, and lengths are in pixels.",
      isDoubt: true,
    };
  return {
    words: `The ${cameras.colour ? "depth" : "colour"} camera is unknown, so that view counts as orthographic. Drop its intrinsics, or type them under its camera.`,
    isDoubt: true,
  };
}

function ofMasks({ masks }: Facts): Expectation[] {
  const found: Expectation[] = [];
  if (!masks.depth)
    found.push({
      words:
        'The depth map has no mask: its largest connected piece counts as the object, and in a room this is usually a wall. The status is then at best "ambiguous".',
      isDoubt: true,
    });
  if (!masks.colour)
    found.push({
      words: "The picture has no mask: that is right only if everything around the object is black.",
      isDoubt: true,
    });
  return found;
}

/** Both views come from one camera or from two aligned cameras, so that the true rotation is zero. */
const isRegistered = ({ colour, depth, focal }: Facts): boolean => {
  const [columns, rows] = sides(colour);
  const [width, height] = sides(depth);
  const isSimilar = Math.abs(columns * height - rows * width) < 0.01 * rows * width;
  return (
    isSimilar &&
    (focal === undefined || Math.abs(focal.colour / columns - focal.depth / width) < 1e-3 * (focal.depth / width))
  );
};

function ofOverlap(facts: Facts): Expectation {
  return isRegistered(facts)
    ? {
        words:
          "Both pictures have the same shape and perhaps one camera. If they were taken from one place, the answer should be no rotation; the run then mostly adds detail to the depth map.",
        isDoubt: false,
      }
    : {
        words:
          "Two viewpoints. Views of a real statue 10 to 20 degrees apart ended about a degree and a millimetre off when they started near the truth, and 3 degrees off by silhouettes.",
        isDoubt: false,
      };
}

/** What to expect, most important first. */
export function expectations(facts: Facts): Expectation[] {
  const { colour, depth } = facts;
  const valid = depth.measured?.valid;
  const found = [ofSize(colour, depth), ...ofMasks(facts), ofCameras(facts), ofOverlap(facts)];
  if (valid !== undefined && valid < SPARSE && !facts.masks.depth)
    found.push({ words: `Only ${Math.round(100 * valid)} % of the depth map's pixels hold a depth.`, isDoubt: true });
  found.push({
    words:
      "A wrong unit of depth spoils everything: the pose is 4 degrees off at 0.7 times the true depth, 10 at 1.5 times, 23 at five times.",
    isDoubt: false,
  });
  found.push({
    words:
      'A sphere, a bowl or a cylinder looks the same after a rotation; such a run ends "lost" or "ambiguous" and names the axis.',
    isDoubt: false,
  });
  return found.sort((a, b) => Number(b.isDoubt) - Number(a.isDoubt));
}
