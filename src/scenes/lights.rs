//! Lights for scenes, in the colour view's optical frame.

use crate::error::{Error, ErrorKind, Result};
use crate::light::Light;

/// Names of the built-in lights.
pub const NAMES: [&str; 3] = ["colourful", "window", "overcast"];

/// Three strong coloured lamps (docs/lab/protocols.md): every normal has a different colour.
pub const COLOURFUL: Light = Light([
    [-1.2, 0.1, -0.9, 0.7, 0.1, 0.2, 0.15, -0.2, -0.1],
    [-1.1, 0.8, -0.7, -0.3, -0.2, -0.15, -0.1, -0.1, 0.2],
    [-1.3, -0.6, -0.8, -0.5, 0.15, -0.1, 0.1, 0.25, 0.1],
]);

/// A room with a warm, tall window above and to the left of the camera, a bluish reflection of the sky from the right,
/// and a wooden floor. The nine harmonics are fitted (0.02 rms) to the logarithm of an invented radiance, integrated
/// over the cosine lobes of 2400 normals; log shading spans 1.2.
pub const WINDOW: Light = Light([
    [-1.15, -0.24, -0.26, -0.51, 0.13, 0.11, 0.03, 0.21, 0.10],
    [-1.28, -0.30, -0.28, -0.44, 0.09, 0.08, 0.00, 0.19, 0.18],
    [-1.38, -0.35, -0.31, -0.29, 0.05, 0.05, -0.04, 0.14, 0.26],
]);

/// A yard under clouds: a sky that brightens toward the zenith, brightest to the right of the camera, brown ground
/// below and a brick wall on the left. Made like [`WINDOW`] (0.01 rms); log shading spans 1.0 to 1.6.
pub const OVERCAST: Light = Light([
    [-1.21, -0.47, -0.17, 0.06, -0.14, 0.06, -0.04, -0.04, 0.02],
    [-1.31, -0.59, -0.13, 0.11, -0.08, 0.05, 0.02, -0.06, 0.03],
    [-1.43, -0.77, -0.10, 0.09, -0.04, 0.01, 0.08, -0.06, 0.13],
]);

/// The built-in light with this name, one of [`NAMES`].
///
/// # Errors
/// [`ErrorKind::Range`] for any other name.
pub fn light(name: &str) -> Result<Light> {
    match name {
        "colourful" => Ok(COLOURFUL),
        "window" => Ok(WINDOW),
        "overcast" => Ok(OVERCAST),
        _ => {
            let message = format!("no light is named {name:?}; there are {}", NAMES.join(", "));
            Err(Error::new(ErrorKind::Range, "light", message))
        }
    }
}
