//! Chapter 3. Which normal has a given colour?
//!
//! Three colours give three equations for two unknowns, but a polynomial of second order can have several solutions:
//! many normals look the same. The other view decides. For each pixel (Eq. 6 to 9)
//!
//! > min_n  Σ_j (nᵀ M_j n − log S_j)² + λ₂ |n − R n_R|² + λ₃ (nᵀ n − 1)²
//!
//! where R n_R is the depth map's normal there. [`PixelLandscape`](crate::PixelLandscape) shows the cost of one pixel
//! over all normals; [`ShadingSolver`](crate::ShadingSolver) solves for all pixels, four at a time.
//!
//! ```
//! use bimodal_stereo::{ColourView, Normals, ShadingProblem, ShadingSolver, ShadingWeights, scenes};
//!
//! let sample = scenes::Scene::new(&scenes::surface("bust")?)?.sample(&scenes::SampleRequest::default())?;
//! let image = ColourView::new(sample.colour_image())?;
//! let log = [&image.log[0][..], &image.log[1], &image.log[2]];
//! let truth = &sample.truth.image_normals;
//!
//! // A prior that is 10 degrees off, as under a pose that has not been found yet.
//! let turn = bimodal_stereo::Angles { beta: 10.0, ..Default::default() }.rotation();
//! let mut prior = Normals::missing(truth.len());
//! for index in (0..truth.len()).filter(|&index| truth.is_valid(index)) {
//!     let [x, y, z] = truth.get(index).map(f64::from);
//!     prior.set(index, <[f64; 3]>::from(turn * nalgebra::Vector3::new(x, y, z)).map(|value| value as f32));
//! }
//! let mut normals = prior.clone();
//! let weights = ShadingWeights { prior: 0.01, unit: 1.0, robust: None };
//! ShadingSolver::new().solve(ShadingProblem { log, prior: &prior, light: &sample.light }, weights, &mut normals);
//!
//! // The colours outweigh it.
//! let mut degrees: Vec<f32> = (0..truth.len())
//!     .filter(|&index| truth.is_valid(index) && normals.is_valid(index))
//!     .map(|index| normals.get(index).iter().zip(truth.get(index)).map(|(a, b)| a * b).sum::<f32>().min(1.0))
//!     .map(|cosine| cosine.acos().to_degrees())
//!     .collect();
//! degrees.sort_by(f32::total_cmp);
//! assert!(degrees[degrees.len() / 2] < 3.0, "median {}", degrees[degrees.len() / 2]);
//! # Ok::<(), bimodal_stereo::Error>(())
//! ```
