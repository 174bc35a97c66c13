//! The pose from silhouettes: the depth map's discontinuities have to fall on the border of the image's mask
//! (docs/method/registration.md).
//!
//! The objective over rotation w, translation t and edge bias d is the sum of
//! - 3 times the mean of rho(max(0, sd(p) + d - 0.7)) over the depth points p,
//! - the weighted mean of rho(sd(p) + d) over the depth discontinuities p beside background,
//! - 0.4 times the weighted mean of s rho(n (p - m) + d) over all depth discontinuities, against edges m of the image,
//! - 0.3 times the mean of rho(max(0, |q - p(q)| - 0.7 - d)) over the pixels q of the silhouette that no point covers,
//! - a prior about the initial pose.
//!
//! Here sd is the signed distance to the silhouette, positive outside, p(q) the nearest discontinuity, n the normal of
//! a discontinuity in the image, m the strongest gradient along that normal, and s how clear it is.
//!
//! A depth sensor shrinks or grows every object by an edge bias d that is the same all around. Without this unknown the
//! distance would be biased.
//!
//! The object turns about its centre c: x = R (X - c) + c + t. Method: rounds of damped Gauss-Newton. Visible points,
//! covered pixels and matches are frozen in a round, and rho narrows in stages.
//!
//! | file | content |
//! |---|---|
//! | `edges` | edges of the image across a line |
//! | `discontinuities` | depth discontinuities: points of the depth map on the object's silhouette under a pose |
//! | `problem` | input and output |
//! | `registration` | the rounds: [`SilhouetteRegistration`] |
//!
//! Limits: the image needs a mask that was not drawn from the depth map and whose border lies inside the frame.
//! Rotations that do not change the silhouette (of a bowl about its axis) keep their initial value.

mod discontinuities;
mod edges;
mod problem;
mod registration;

pub use problem::{SilhouetteProblem, SilhouetteReport};
pub use registration::SilhouetteRegistration;
