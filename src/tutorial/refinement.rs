//! Chapter 7. What does the image add to the depth map?
//!
//! If the pose is known, the image also shows the shading of the depth map's surface. The normals of that surface
//! follow from the colours of their pixels (Eq. 17),
//!
//! > g(n_R) = Σ_j ( (R n_R)ᵀ M_j (R n_R) − log S_j )² + λ_g2 |n_R − n_R⁰|²
//!
//! as in chapter 3 with both views exchanged. The depth follows these normals and the measurement, each as far as it
//! can be trusted (Eq. 18, 19). The noise decreases and holes are filled.
//! [`Estimator::refined_depth`](crate::Estimator::refined_depth) and
//! [`Estimator::depth_normals`](crate::Estimator::depth_normals) hold the result.
//!
//! ```
//! use bimodal_stereo::{Estimator, LightSource, Options, Start, Status, scenes};
//! use scenes::DepthData;
//!
//! let request = scenes::SampleRequest { depth_noise: 0.3, holes: 0.05, ..Default::default() };
//! let sample = scenes::Scene::new(&scenes::surface("bust")?)?.sample(&request)?;
//! let options = Options {
//!     light: LightSource::Known(sample.light),
//!     start: Start::Identity,
//!     scale: Some(1.0),
//!     max_iterations: 6,
//!     ..Options::default()
//! };
//! let mut estimator = Estimator::new(sample.colour_image(), &sample.depth_map(), options)?;
//! while estimator.report().status == Status::Running {
//!     estimator.step();
//! }
//!
//! // Median distance to the truth where there is a measurement.
//! let DepthData::Map(measured) = &sample.depth.data else { unreachable!("an orthographic map is no cloud") };
//! let median_error = |depth: &[f32]| {
//!     let errors = depth.iter().zip(&sample.truth.depth).zip(measured);
//!     let mut errors: Vec<f32> =
//!         errors.map(|((a, b), there)| (a - b + 0.0 * there).abs()).filter(|error| error.is_finite()).collect();
//!     errors.sort_by(f32::total_cmp);
//!     errors[errors.len() / 2]
//! };
//! assert!(median_error(estimator.refined_depth()) < 0.7 * median_error(measured));
//!
//! // Holes are filled.
//! let known = |depth: &[f32]| depth.iter().filter(|value| value.is_finite()).count();
//! assert!(known(estimator.refined_depth()) > known(measured));
//! # Ok::<(), bimodal_stereo::Error>(())
//! ```
