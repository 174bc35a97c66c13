//! Chapter 6. Which pose aligns both surfaces?
//!
//! The paper pairs points (ICP, Eq. 12), fits a linear model P → A P + t to most of them (RANSAC, Eq. 13, 14), and
//! takes the nearest similarity,
//!
//! > min_{s, R} |s R − A|²  (Eq. 15, 16)
//!
//! which has a closed form: [`Similarity::nearest`](crate::Similarity::nearest). [`ransac`](crate::ransac) fits the
//! model, refuses one that is near no similarity, and fits the similarity to the pairs on which most agree:
//!
//! ```
//! use bimodal_stereo::{Angles, RansacOptions, Similarity, ransac};
//! use nalgebra::Vector3;
//!
//! let rotation = Angles { alpha: 5.0, beta: 20.0, gamma: -10.0 }.rotation();
//! let truth = Similarity { scale: 1.2, rotation, translation: Vector3::new(3.0, -1.0, 7.0) };
//! let depth: Vec<_> = (0..200).map(f64::from).map(|k| Vector3::new((3.0 * k).sin(), (5.0 * k).cos(), (7.0 * k).sin()) * 20.0).collect();
//! let mut image: Vec<_> = depth.iter().map(|&point| truth.apply(point)).collect();
//! // A quarter of the pairs are wrong.
//! image.iter_mut().step_by(4).for_each(|point| *point += Vector3::new(15.0, -9.0, 4.0));
//! let found = ransac(&depth, &image, &RansacOptions::default())?;
//! assert_eq!(found.inliers.len(), 150);
//! assert!(found.pose.degrees_to(&truth) < 1e-6);
//! # Ok::<(), bimodal_stereo::Error>(())
//! ```
//!
//! By default, the pose is found without pairs, directly from the image, with the light projected out:
//!
//! > min_{s, R, t} min_L  Σ ρ( log S(π(s R P + t)) − Y(R n_R) L )
//!
//! with harmonics Y of the rotated normal and a robust ρ. [`Photometric`](crate::Photometric) does this; a known light
//! is passed in `light`:
//!
//! ```
//! use bimodal_stereo::{
//!     Angles, ColourView, DepthView, LightPrior, Photometric, PhotometricOptions, PhotometricProblem, Similarity,
//!     cubic_normals, scenes,
//! };
//!
//! let request = scenes::SampleRequest { noise: 0.01, ..Default::default() };
//! let sample = scenes::Scene::new(&scenes::surface("bust")?)?.sample(&request)?;
//! let (image, mut depth) = (ColourView::new(sample.colour_image())?, DepthView::new(&sample.depth_map(), true)?);
//! // More accurate normals than those of a plane through the neighbours, with their errors.
//! let mut error = vec![0.0; depth.size.len()];
//! cubic_normals::improve(depth.size, &depth.points, &mut depth.normals, &mut error, depth.noise.is_white);
//! let prior = LightPrior::natural();
//! let problem = PhotometricProblem {
//!     image: &image,
//!     depth_size: depth.size,
//!     points: &depth.points,
//!     normals: &depth.normals,
//!     normal_error: Some(&error),
//!     depth_noise: depth.noise,
//!     light: Some(&sample.light),
//!     prior: &prior,
//!     prior_weight: 1.0,
//!     scale_is_held: true,
//!     near: None,
//! };
//! // Eight degrees off, about the object's centre.
//! let centre = depth.points.centroid();
//! let rotation = Angles { alpha: 8.0, ..Default::default() }.rotation() * sample.pose.rotation;
//! let start = Similarity { rotation, translation: sample.pose.apply(centre) - rotation * centre, ..sample.pose };
//! let report = Photometric::new(&problem).register(&problem, &start, &PhotometricOptions::default())?;
//! let degrees = report.pose.degrees_to(&sample.pose);
//! assert!(degrees < 1.0, "{degrees} degrees off");
//! # Ok::<(), bimodal_stereo::Error>(())
//! ```
