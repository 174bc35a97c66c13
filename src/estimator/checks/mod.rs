//! Checks of the input. Each makes of some evidence a reason not to trust an answer that looks good, or none;
//! what such a reason caps is decided in the verdict alone.
//!
//! | file | what it asks |
//! |---|---|
//! | `hollow` | whether depths grow towards the camera |
//! | `masks` | whether the views show more than the object |
//! | `unit` | whether the depths are in another unit |

mod hollow;
mod masks;
mod unit;

pub use hollow::hollow;
pub use masks::missing_mask;
pub use unit::other_unit;
