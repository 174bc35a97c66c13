//! The method in eight short chapters, one for each stage, each with its equation and a runnable example.
//!
//! | chapter | question | the paper |
//! |---|---|---|
//! | [`views`] | what is the input, and in which frame? | input of Algorithm 1 |
//! | [`light`] | what colour does a normal have? | Eq. 2, 3, 5 |
//! | [`normals`] | which normal has a given colour? | Eq. 6 to 9 |
//! | [`surface`] | which surface has these normals? | Eq. 4, 10, 11 |
//! | [`search`] | where to start if nothing is known? | before Algorithm 1 |
//! | [`registration`] | which pose aligns both surfaces? | Eq. 12 to 16 |
//! | [`refinement`] | what does the image add to the depth map? | Eq. 17 to 19 |
//! | [`report`] | how far can the answer be trusted? | the end of Algorithm 1 |
//!
//! [`Estimator`](crate::Estimator) runs all of it; the chapters use its parts one at a time on the built-in bust, whose
//! answer is known. `cargo test --doc` compiles and runs each example. Formulas are plain Unicode, so that they can be
//! read offline.

pub mod light;
pub mod normals;
pub mod refinement;
pub mod registration;
pub mod report;
pub mod search;
pub mod surface;
pub mod views;
