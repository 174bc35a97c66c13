//! Chapter 5. Where to start if nothing is known?
//!
//! The paper starts from the identity. This crate tries all rotations on a coarse grid. For each of them it rotates the
//! depth map's normals and projects out the light that would fit the image best,
//!
//! > score(R) = max over t, s of  log p(colours | R, s, t) − log p(colours | one colour)
//!
//! with all translations at once by correlation. The work is cut into slices, so that progress can be reported; the
//! best candidates are then registered. [`Search`](crate::Search) does this, and
//! [`Estimator::step`](crate::Estimator::step) runs it slice by slice while its stage is
//! [`Stage::Search`](crate::Stage::Search).
//!
//! ```
//! use bimodal_stereo::{Angles, ColourView, DepthView, Search, SearchProblem, scenes};
//!
//! let rotation = Angles { alpha: -20.0, beta: 55.0, gamma: 15.0 }.rotation();
//! let request = scenes::SampleRequest { rotation, ..Default::default() };
//! let sample = scenes::Scene::new(&scenes::surface("bust")?)?.sample(&request)?;
//! let (image, depth) = (ColourView::new(sample.colour_image())?, DepthView::new(&sample.depth_map(), true)?);
//!
//! let mut search = Search::new(&SearchProblem {
//!     image: &image,
//!     depth: &depth,
//!     normals: &depth.normals,
//!     light: Some(&sample.light),
//!     scale: Some(1.0),
//!     unit_scale: 1.0,
//!     seed: 1,
//! })?;
//! while search.advance().share < 1.0 {}
//!
//! // One of the first candidates is close enough for a registration.
//! let nearest = search.candidates().iter().take(10).map(|found| found.pose.degrees_to(&sample.pose));
//! assert!(nearest.fold(f64::INFINITY, f64::min) < 12.0);
//! # Ok::<(), bimodal_stereo::Error>(())
//! ```
