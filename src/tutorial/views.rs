//! Chapter 1. Two views of one object.
//!
//! A colour image from one place, a depth map from another. Both use one frame: x right, y down, z forward; normals
//! face the camera, so n_z < 0. Without intrinsics, a view is orthographic and its unit is the pixel,
//!
//! > x = column − (W − 1) / 2,  y = row − (H − 1) / 2
//!
//! and with them it is metric: X = (column − c_x) Z / f_x. The unknown is the pose that maps depth points into the
//! colour view,
//!
//! > P_colour = s R P_depth + t,  R = Rx(α) Ry(β) Rz(γ)
//!
//! A [`ColourView`](crate::ColourView) holds the *logarithm* of linear intensity, in which exposure and albedo become
//! additive. A [`DepthView`](crate::DepthView) holds points and normals; zeros, NaN and infinite depths are holes.
//!
//! ```
//! use bimodal_stereo::{ColourView, DepthView, scenes};
//!
//! let sample = scenes::Scene::new(&scenes::surface("bust")?)?.sample(&scenes::SampleRequest::default())?;
//! let image = ColourView::new(sample.colour_image())?;
//! let depth = DepthView::new(&sample.depth_map(), true)?;
//! assert!(image.camera.is_orthographic());
//!
//! // All visible normals face the camera.
//! let seen = (0..depth.size.len()).filter(|&index| depth.normals.is_valid(index));
//! assert!(seen.clone().count() > 1000 && seen.clone().all(|index| depth.normals.get(index)[2] < 0.0));
//!
//! // The true pose maps a depth point onto the object in the image.
//! let centre = depth.points.centroid();
//! let [column, row] = image.camera.project(image.size, sample.pose.apply(centre).into()).unwrap();
//! assert!(image.mask[image.size.nearest(column as f32, row as f32).unwrap()]);
//! # Ok::<(), bimodal_stereo::Error>(())
//! ```
