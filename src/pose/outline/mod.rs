//! The pose from outlines: where the depth map's rims fall on the image's mask (docs/method/registration.md).
//!
//! Least over w, t, d: three times the mean of rho(max(0, sd(p) + d - 0.7)) over the depth points, and the mean of w rho(sd(p) + d)
//! over their rims, and 0.4 times that of w s rho(n (p - m) + d) against edges m of the image, and 0.3 times the mean of
//! rho(max(0, |q - p(q)| - 0.7 - d)) over the pixels q of the mask's outline that no point covers, and a prior about the
//! told pose. sd is the signed distance to the mask's outline, positive outside, p(q) the nearest rim, n the normal of a rim
//! in the image, m the strongest gradient along it, s how far it stands out.
//!
//! A sensor loses the outline of what it sees, or blurs it outward, by an amount d that is alike all around: one pixel of
//! it would be 17 mm of distance, so it is an unknown of its own.
//!
//! The object turns about its own middle c, x = R (X - c) + c + t. Method: rounds of damped Gauss-Newton; what is visible,
//! covered and next to what is frozen in a round, and rho narrows from round to round.
//!
//! | file | what it holds |
//! |---|---|
//! | `edges` | edges of the image across a line |
//! | `rims` | which points of the depth map draw its outline under a pose |
//! | `problem` | what goes in, what comes out |
//! | `registration` | the rounds: [`Outline`] |
//!
//! Limits: the image needs a mask that was not drawn from the depth map, and its outline has to be inside the frame. What
//! turns without changing its outline (a bowl about its axis) keeps the told turn.

mod edges;
mod problem;
mod registration;
mod rims;

pub use problem::{OutlineProblem, OutlineReport};
pub use registration::Outline;
