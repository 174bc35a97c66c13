//! Computations that only the lessons need (www/learn): classical shape from shading, the ambiguities of one lamp, and
//! parts of the method on their own. The estimator uses none of them.
//!
//! | file | content |
//! |---|---|
//! | `lamp` | one distant lamp and a matte surface, the changes of shape that it does not show, its approximation of second order |
//! | `strips` | characteristic strips of a picture with one lamp (Horn 1970) |
//! | `landscape` | the objective of one pixel over the hemisphere (Eq. 6), for display |
//! | `surface_of_normals` | a surface from given normals alone (Eq. 4, 10, 11) |

mod lamp;
mod landscape;
mod strips;
mod surface_of_normals;

pub use lamp::{BasRelief, Lamp, second_order};
pub use landscape::{Minimum, PixelLandscape};
pub use strips::{Form, ShadedImage, characteristic_strips};
pub use surface_of_normals::surface_of_normals;
