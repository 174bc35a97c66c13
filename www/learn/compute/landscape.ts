/** The objective of one pixel as a panel: values, minima, prior, and the steps of one descent. */

import { pixelLandscape, type PixelLandscape, type PixelLandscapeRequest } from "../../../pkg/index.js";
import type { ImagePanel, Mark } from "../protocol";
import { onDisc, scalarOf } from "./draw";

const SIDE = 128;
/** Distance in log colour up to which a normal counts as an explanation: two percent of brightness, the noise of a good camera. */
export const NOISE = 0.02;
/** Largest distance on the picture's colour scale. */
const MOST_SHOWN = 1;

export interface Landscape {
  panel: ImagePanel;
  /** Share of the hemisphere whose predicted colour equals the pixel's up to noise, percent. */
  explained: number;
  /** Difference of the lowest minimum's colour from the pixel's, percent of brightness (rms of the three). */
  off: number;
  /** Minima as good as the best, within the noise. */
  good: number;
  /** All minima. */
  minima: number;
  lowest: [number, number, number];
  end: [number, number, number];
}

const COLUMNS = 5;

export function landscapeOf(
  request: PixelLandscapeRequest,
  words: { key?: string; title?: string; truth?: ArrayLike<number>; curves?: Mark[]; hasSteps?: boolean } = {},
): Landscape {
  const found = pixelLandscape({ side: SIDE, ...request });
  const distances = found.objective.map((value) => Math.sqrt(value));
  const inside = distances.filter(Number.isFinite);
  // The noise of three channels together.
  const reach = NOISE * Math.sqrt(3);
  const minima = minimaOf(found);
  const best = minima[0]?.objective ?? NaN;
  // If a minimum between two samples of the picture explains the pixel, one sample is coloured for it, so that zero means that no normal
  // explains it.
  const places = Math.max(inside.filter((value) => value < reach).length, Math.sqrt(best) < reach ? 1 : 0);
  const explained = (100 * places) / inside.length;
  const end = found.path.subarray(-3);
  const panel = scalarOf(
    {
      key: words.key ?? "landscape",
      title: words.title ?? "Cost of every normal",
      alt: "The hemisphere of all visible normals seen from the front; dark means a low cost. It has {minima} minima.",
      details: { minima: minima.length },
      legend: words.curves
        ? "red, green, blue line: explains this colour; dark: all three; dots: minima; cross: truth"
        : `dark: explains the pixel; dots: minima; cross: truth${words.hasSteps ? "; line: solver" : ""}`,
    },
    { width: SIDE, height: SIDE },
    distances,
    { min: 0, max: MOST_SHOWN },
    "viridis",
    [...(words.curves ?? []), ...(words.hasSteps ? pathOf(found) : []), ...marksOf(minima, request, words.truth)],
  );
  return {
    panel,
    explained,
    off: (100 * Math.sqrt(best)) / Math.sqrt(3),
    good: minima.filter(({ objective }) => objective < best + reach * reach).length,
    minima: minima.length,
    lowest: minima[0]?.normal ?? [NaN, NaN, NaN],
    end: [end[0] ?? NaN, end[1] ?? NaN, end[2] ?? NaN],
  };
}

interface Minimum {
  normal: [number, number, number];
  objective: number;
  share: number;
}

/** The smallest share of the directions for which a minimum is marked: single descents that stall are not minima. */
const LEAST_SHARE = 0.004;

function minimaOf({ minima }: PixelLandscape): Minimum[] {
  return Array.from({ length: minima.length / COLUMNS }, (_, i) => {
    const [x = NaN, y = NaN, z = NaN, objective = NaN, share = NaN] = minima.subarray(COLUMNS * i, COLUMNS * (i + 1));
    return { normal: [x, y, z] as [number, number, number], objective, share };
  }).filter(({ share }) => share > LEAST_SHARE);
}

function pathOf({ path }: PixelLandscape): Mark[] {
  const points = Array.from({ length: path.length / 3 }, (_, i) => onDisc(path.subarray(3 * i, 3 * i + 3))).flat();
  return [
    { ink: "path", shape: "line", points },
    { ink: "path", shape: "dot", points, size: 0.9 },
  ];
}

function marksOf(minima: Minimum[], { prior, weight }: PixelLandscapeRequest, truth?: ArrayLike<number>): Mark[] {
  return [
    ...minima.map(
      ({ normal, share }) =>
        ({ ink: "minimum", shape: "dot", points: onDisc(normal), size: 1.2 + 3 * Math.sqrt(share) }) as const,
    ),
    ...(prior && (weight ?? 0) > 0 ? [{ ink: "prior", shape: "ring", points: onDisc(prior), size: 3.5 } as const] : []),
    // Above the dots, because a minimum may be at the truth.
    ...(truth ? [{ ink: "truth", shape: "cross", points: onDisc(truth), size: 3 } as const] : []),
  ];
}
