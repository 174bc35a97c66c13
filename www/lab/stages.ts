/** The search and the five stages of one iteration, in words. */

import type { Stage } from "../../pkg/index.js";

export interface StageText {
  name: Stage;
  title: string;
  equation: string;
  words: string;
  source: string;
}

export const stages: readonly StageText[] = [
  {
    name: "search",
    title: "Search",
    equation: "maximise ∛N ln(spread / noise) over R, s, t",
    words:
      "Where nothing is known of the pose, rotations from all over are tried on a coarse grid, every shift of each at once by a Fourier transform. The best candidates are registered by their colours; the loop starts from the one that leaves the least noise, and those that explain nearly as much are reported as its rivals.",
    source: "Before Algorithm 1; not in the paper",
  },
  {
    name: "light",
    title: "Light",
    equation: "log S = nᵀ M n",
    words:
      "With the normals held, the logarithm of every colour is linear in 27 numbers, nine spherical harmonics for each channel. They are fitted by least squares; a Gaussian learned from natural lights says which lights are likely. A known light is not fitted; its exposure is found in the shading stage.",
    source: "Equations 2, 3 and 5",
  },
  {
    name: "shading",
    title: "Shading",
    equation: "minimise |log S − nᵀ M n|² + λ₂ |n − R n_R|² + λ₃ (nᵀ n − 1)²",
    words:
      "With light and pose held, each pixel of the image looks for the normal that explains its three colours, stays close to the normal that the depth map has at the corresponding point, and has length one. Under a known light the exposure of the picture is found along with the normals.",
    source: "Equations 6 to 9",
  },
  {
    name: "surface",
    title: "Surface",
    equation: "∂z/∂x = −n_x / n_z,  ∂z/∂y = −n_y / n_z",
    words:
      "Normals are slopes. The depth whose slopes fit them best, in least squares over the object's pixels, turns the normals of the image into a surface that can be compared with the depth map.",
    source: "Harker and O'Leary's integration",
  },
  {
    name: "registration",
    title: "Registration",
    equation: "minimise Σ |P − (s R P_R + t)|²",
    words:
      "As in the paper, the depth map's points are moved onto the image's surface: nearest neighbours first, then a robust fit of twelve linear parameters, from which the scale s, the rotation R and the shift t are taken apart. The joint registration skips the surface: it turns the depth map until its normals predict the image's colours, the light following along.",
    source: "Equations 12 to 16",
  },
  {
    name: "refinement",
    title: "Refinement",
    equation: "minimise |log S − (R n_R)ᵀ M (R n_R)|² + λ |n_R − R⁻¹ n|²",
    words:
      "Where both views overlap, the colours now correct the depth map's own normals, and the normals its depth: noise goes down and holes are filled. The next iteration starts from the better map.",
    source: "Equations 17 to 19",
  },
];
