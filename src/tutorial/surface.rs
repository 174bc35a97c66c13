//! Chapter 4. Which surface has these normals?
//!
//! A normal is a slope (Eq. 4, 10),
//!
//! > p = ∂z/∂x = −n_x / n_z,  q = ∂z/∂y = −n_y / n_z
//!
//! and a surface follows from slopes up to its distance, by least squares over the edges between neighbours on the
//! object's mask (Eq. 11):
//!
//! > min_z  Σ (z(x+1, y) − z(x, y) − p̄)² + (z(x, y+1) − z(x, y) − q̄)²
//!
//! This is a Poisson equation; [`Integrator`](crate::Integrator) solves it with conjugate gradients, preconditioned by cosine transforms.
//! Edges across which depth jumps are outliers and lose their weight.
//!
//! ```
//! use bimodal_stereo::{scenes, surface_of_normals};
//!
//! let sample = scenes::Scene::new(&scenes::surface("bust")?)?.sample(&scenes::SampleRequest::default())?;
//! let depth = surface_of_normals(sample.image.size, &sample.truth.image_normals, true)?;
//!
//! // Both relative to their median, because the distance is free.
//! let about_median = |values: &[f32]| -> Vec<f32> {
//!     let mut known: Vec<f32> = values.iter().copied().filter(|value| value.is_finite()).collect();
//!     known.sort_by(f32::total_cmp);
//!     values.iter().map(|value| value - known[known.len() / 2]).collect()
//! };
//! let (found, truth) = (about_median(&depth), about_median(&sample.truth.image_depth));
//! let mut errors: Vec<f32> =
//!     found.iter().zip(&truth).map(|(a, b)| (a - b).abs()).filter(|error| error.is_finite()).collect();
//! errors.sort_by(f32::total_cmp);
//! assert!(errors[errors.len() / 2] < 1.0, "median {} pixels", errors[errors.len() / 2]);
//! # Ok::<(), bimodal_stereo::Error>(())
//! ```
