//! Checks of the input. Each turns evidence into a reason to distrust a good-looking answer, if there is one. Only the
//! verdict decides what such a reason caps.
//!
//! | file | what it detects |
//! |---|---|
//! | `hollow` | depths that grow towards the camera |
//! | `masks` | views that show more than the object |
//! | `unit` | depths in another unit |

mod hollow;
mod masks;
mod unit;

pub use hollow::hollow;
pub use masks::missing_mask;
pub use unit::other_unit;
