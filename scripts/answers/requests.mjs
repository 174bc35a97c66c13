// Shorthands for the requests of scenes.

export const NOISE = 0.01;
/** The paper's own loop. */
export const PAPER = { start: "identity", registration: "icp", shading: "pixel" };
export const GIVEN = { light: "known", start: { off: 0 } };
export const near = (off, ...members) => ({ off, ...(members.length > 0 ? { members } : {}) });
export const sample = (surface, light, size, rest = {}) => ({ surface, light, size, noise: NOISE, ...rest });
export const grid = (surface, light, angles, rest = {}) => ({ surface, light, protocol: "grid", angles, ...rest });

export const pinhole = (width, height, rest = {}) => ({
  width,
  height,
  camera: { fx: 2.2 * height, fy: 2.25 * height, cx: (width - 1) / 2 + 1.3, cy: (height - 1) / 2 - 0.8, ...rest },
});
export const LENS = { distortion: [-0.12, 0.05, 0.001, -0.0015, 0.01] };
export const OTHER_LENS = { distortion: [0.08, -0.03, -0.001, 0.002, 0] };
/** Two pinhole cameras side by side, with the body rotated between them. */
export const metric = (light, image, depth, rest = {}) => ({
  light,
  image,
  depth,
  axis: [0.36, 0.8, -0.48],
  degrees: 15,
  noise: NOISE,
  ...rest,
});
