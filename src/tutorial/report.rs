//! Chapter 8. How far can the answer be trusted?
//!
//! The loop lowers the sum of all terms (Eq. 1),
//!
//! > l + f + g
//!
//! and ends when the rotation has settled (Algorithm 1). The status at the end says how far to trust it:
//!
//! | status | meaning |
//! |---|---|
//! | [`Converged`](crate::Status::Converged) | the rotation has settled, and no check contradicts it |
//! | [`Ambiguous`](crate::Status::Ambiguous) | other poses fit equally well (`rivals`), or the rotation is uncertain; `reason` says why |
//! | [`Lost`](crate::Status::Lost) | the answer cannot be trusted; `reason` says why |
//! | [`MaxIterations`](crate::Status::MaxIterations) | the loop ended before it settled |
//!
//! `uncertainty` holds one sigma of each number. It adds two parts: a sandwich over tiles of the image,
//!
//! > Σ_pose ≈ (JᵀJ)⁻¹ (Σ_tiles g gᵀ) (JᵀJ)⁻¹
//!
//! with the gradient g of a tile, so that neighbouring residuals may be correlated, and a jackknife over sectors of the
//! object, which covers errors of the model that differ from sector to sector. An undetermined number has no sigma: t_z of an orthographic image is
//! `None`.
//!
//! ```
//! use bimodal_stereo::{Estimator, LightSource, Options, Start, Status, scenes};
//!
//! let request = scenes::SampleRequest { noise: 0.01, ..Default::default() };
//! let sample = scenes::Scene::new(&scenes::surface("bust")?)?.sample(&request)?;
//! let options = Options { light: LightSource::Known(sample.light), start: Start::Identity, ..Options::default() };
//! let mut estimator = Estimator::new(sample.colour_image(), &sample.depth_map(), options)?;
//! while estimator.report().status == Status::Running {
//!     estimator.step();
//! }
//!
//! let report = estimator.report();
//! assert_eq!((report.status, report.rivals.len()), (Status::Converged, 0));
//! let sigma = report.uncertainty.as_ref().expect("it has converged");
//! let largest = sigma.rotation_degrees.into_iter().fold(0.0, f64::max);
//! // Three axes, three sigmas.
//! assert!(report.pose.degrees_to(&sample.pose) < 3.0 * 3.0_f64.sqrt() * largest);
//! assert_eq!(sigma.translation[2], None);
//! println!("{} within {largest:.2} degrees; weakest: {}", report.status.name(), sigma.weakest);
//! # Ok::<(), bimodal_stereo::Error>(())
//! ```
