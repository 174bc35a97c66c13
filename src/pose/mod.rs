//! The pose between both views (Eq. 12 to 16).

mod similarity;

pub use similarity::Similarity;
