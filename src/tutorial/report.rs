//! Chapter 8. How far is the answer to be trusted?
//!
//! The loop lowers the sum of all terms (Eq. 1),
//!
//! > l + f + g
//!
//! and ends when the rotation has settled (Algorithm 1). What its end is called says how far to trust it:
//!
//! | status | meaning |
//! |---|---|
//! | [`Converged`](crate::Status::Converged) | the rotation has settled, and nothing speaks against it |
//! | [`Ambiguous`](crate::Status::Ambiguous) | other poses explain the colours as well: they are in `rivals` |
//! | [`Lost`](crate::Status::Lost) | the answer cannot be trusted; `message` says why |
//! | [`MaxIterations`](crate::Status::MaxIterations) | the cap came first |
//!
//! One sigma of each number is in `uncertainty`, from the curvature of the objective and the noise of the residuals,
//!
//! > Σ_pose ≈ σ² (JᵀJ)⁻¹
//!
//! It knows noise, not what the model leaves out. A number that nothing determines has no sigma: t_z of an orthographic image is `None`.
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
