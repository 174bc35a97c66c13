/** The five stages of one iteration, in words. */

export interface StageText {
  name: string;
  title: string;
  equation: string;
  words: string;
  source: string;
}

export const stages: readonly StageText[] = [
  {
    name: "light",
    title: "Light",
    equation: "log S = nᵀ M n",
    words:
      "With the normals held, the logarithm of every colour is linear in 27 numbers, nine spherical harmonics for each channel. They are fitted by least squares; a Gaussian learned from natural lights says which lights are likely. A known light keeps its form and only its exposure is fitted.",
    source: "Equations 2, 3 and 5",
  },
  {
    name: "shading",
    title: "Shading",
    equation: "minimise |log S − nᵀ M n|² + λ₂ |n − R n_R|² + λ₃ (nᵀ n − 1)²",
    words:
      "With light and pose held, each pixel of the image looks for the normal that explains its three colours, stays close to the normal that the depth map has at the corresponding point, and has length one.",
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
      "The depth map's points are moved onto the image's surface: nearest neighbours first, then a robust fit of twelve linear parameters, from which the scale s, the rotation R and the shift t are taken apart.",
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
