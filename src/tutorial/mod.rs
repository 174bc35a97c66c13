//! The method in eight short chapters, one for each stage, each with its equation and an example that runs.
//!
//! | chapter | question | the paper |
//! |---|---|---|
//! | [`views`] | what comes in, and in which frame? | input of Algorithm 1 |
//! | [`light`] | what colour has a normal? | Eq. 2, 3, 5 |
//! | [`normals`] | which normal has a colour? | Eq. 6 to 9 |
//! | [`surface`] | which surface has these normals? | Eq. 4, 10, 11 |
//! | [`search`] | where to start, with nothing known? | before Algorithm 1 |
//! | [`registration`] | which pose lays both surfaces onto each other? | Eq. 12 to 16 |
//! | [`refinement`] | what do the colours tell the depth map? | Eq. 17 to 19 |
//! | [`report`] | how far is the answer to be trusted? | the end of Algorithm 1 |
//!
//! [`Estimator`](crate::Estimator) runs all of it; the chapters use its parts one at a time, on the built-in bust, whose answer is known.
//! Each example is compiled and run by `cargo test --doc`. Formulas are plain Unicode, so that they read without a network.

pub mod light;
pub mod normals;
pub mod refinement;
pub mod registration;
pub mod report;
pub mod search;
pub mod surface;
pub mod views;
