// Checks of captures with a hidden truth: how each draw is made and what is measured.
import { after, chance, inverse, mahalanobis, offset, poseOf, sizes, wrong } from "../rigs/draws.mjs";
import { IDENTITY } from "../../protocols/rotations.mjs";
import { costs } from "./costs.mjs";
import { checkFrame, hide } from "./read.mjs";

const NOWHERE = poseOf(IDENTITY, [0, 0, 0]);
/** Size of the motion that hides the truth. */
const HIDING = { degrees: 10, millimetres: 100 };

/** A seed for each text, so that a capture's draws do not depend on other captures (Fowler, Noll and Vo's hash). */
export const seedOf = (text, draw) =>
  [...`${text} ${draw}`].reduce((hash, letter) => Math.imul(hash ^ letter.charCodeAt(0), 16777619), -2128831035) >>> 0;

/** Frames of one rig behind one motion; the truth of the first frame holds for all. */
export function hidden(frames, random) {
  const motion = wrong(NOWHERE, HIDING, random.direction);
  // Frames with different poses become frames of one rig: the difference is applied to their clouds.
  const first = frames[0].truth;
  return { motion, frames: frames.map((frame) => hide(frame, after(motion, after(inverse(first), frame.truth)))) };
}

function measured(report, truth, centre) {
  const d = offset(report.estimate, truth, centre);
  const [x, y, z] = d.slice(0, 3).map((angle) => (angle * 180) / Math.PI);
  const [right, down, along] = d.slice(3).map((metres) => 1000 * metres);
  const fit = sizes(offset(report.estimate, truth, report.middle));
  const parts = {
    turn: Math.hypot(x, y, z),
    inPlane: Math.abs(z),
    tilt: Math.hypot(x, y),
    lateral: Math.hypot(right, down),
    along: Math.abs(along),
  };
  const chiSquare = mahalanobis(report.covariance, offset(report.estimate, truth, report.middle));
  return {
    fit,
    parts,
    signed: [x, y, z, right, down, along],
    chiSquare,
    focal: report.focal,
    health: report.health.pixels,
  };
}

/** Checks a candidate that is off by `error` about the colour camera or about the middle of the frames. */
export async function toldOff(check, frames, error, { seed, about = "camera", options = {}, correction }) {
  const random = chance(seed);
  const { frames: behind } = hidden(frames, random);
  const { truth, centre } = behind[0];
  const told = wrong(truth, error, random.direction, about === "middle" ? centre : undefined);
  const report = await check(behind.map(checkFrame), { told }, options);
  // `correction` improves an authors' pose that is known to be off. It is a pose in the colour frame, applied after the authors' pose.
  const better = correction ? after(correction, truth) : truth;
  return {
    error,
    about,
    verdict: report.verdict,
    ...measured(report, better, centre),
    start: measured({ ...report, estimate: told }, truth, centre).parts,
  };
}

/** The rank is 1 if the wrong candidate is worse, 0 if it is better, and one half for a tie or a missing value. */
export const beats = (right, wrong) => (right === wrong || Number.isNaN(right - wrong) ? 0.5 : Number(wrong > right));

/**
 * Ranks the true candidate against wrong ones. The first candidate, on which the prior is centred, is another pose that is off by
 * `start`. The project's measures are the Mahalanobis distance from the estimate and the report's pixels.
 */
export async function ranked(check, frame, { start, errors, each, seed, about }) {
  const random = chance(seed);
  const { motion, frames } = hidden([frame], random);
  const [behind] = frames;
  const { truth, centre } = behind;
  const first = wrong(truth, start, random.direction, about === "middle" ? centre : undefined);
  const rivals = errors.flatMap((error) =>
    Array.from({ length: each }, () => ({ error, pose: wrong(truth, error, random.direction) })),
  );
  const named = Object.fromEntries(rivals.map(({ pose }, index) => [`rival ${index + 1}`, pose]));
  const report = await check([checkFrame(behind)], { first, truth, ...named });
  const theirs = costs(behind, motion);
  const distance = (pose) => mahalanobis(report.covariance, offset(report.estimate, pose, report.middle));
  const pixels = (name) => report.candidates[name].pixels;
  const [right, information, edges] = [distance(truth), theirs.information(truth), theirs.edges(truth)];
  const rows = rivals.map(({ error, pose }, index) => ({
    error,
    distance: beats(right, distance(pose)),
    pixels: beats(pixels("truth"), pixels(`rival ${index + 1}`)),
    information: beats(information, theirs.information(pose)),
    edges: beats(edges, theirs.edges(pose)),
  }));
  return { rows, verdict: report.candidates.truth.verdict, near: theirs.near(truth) };
}
