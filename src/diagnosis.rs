//! Diagnoses whether a single albedo explains an image, or whether its residuals show an error of the model or a
//! varying albedo.
//!
//! Nothing else in the crate decides between methods by residuals. [`Residuals::diagnose`] gives the diagnosis for each method
//! that could take over, because each has its own threshold. [`is_pure_noise`] tells whether a palette of albedos is
//! fitted at all; [`excess`] and [`share_of_model`] grade the residuals for weights that depend on them. A method may still
//! decline: local contrast also needs clean normals or edges of albedo (`estimator/finder/local_contrast`).
//! docs/lab/thresholds.md has the data that were held out.
//!
//! | threshold | value | set on |
//! |---|---|---|
//! | [`PURE_NOISE`] | 0.035 log units | renders leave 0.010 to 0.018, photographs 0.041 or more |
//! | [`MIXED_NOISE`] | twice that | photographs of objects with varying albedo leave 0.04 to 0.34 |
//! | `PURE_SHARE` | 0.15 of the spread | pinhole renders leave 0.01 to 0.10, registered captures 0.14 to 0.54 |
//! | `MODEL_COVARIANCE` | 0.007 log units | 155 renders leave up to 0.0043, pictures of shading 0.0084 or more |
//! | `PINHOLE_COVARIANCE` | 0.03 log units | twelve pinhole renders leave up to 0.006, four captures 0.14 to 0.39 |
//! | `UNIT_COVARIANCE` | 0.0015 log units | all but two of 110 random renders in the right unit stay below |
//! | `NOISE_OF_IMAGE`, `SHARE_OF_SPREAD` | 1.5, 0.05 | renders leave 0.75 to 1 times the image's noise |
//! | `UNIT_NOISE` | 1.25 | right pairs with clean depth leave up to 1.23 times the image's noise |
//! | `MODEL_NOISE` | 2 | renders leave 0.75 to 1 times the image's noise, photographs 0.7 to 5 times |
//! | [`LARGEST_UNEXPLAINED`] | 0.3 of the spread | renders leave 0.01 to 0.1 |
//! | [`LARGEST_CONTRAST_OBJECTIVE`] | 0.56 | photographs whose pose is found end at 0.13 to 0.51 |

/// Standard deviation of residuals in a channel, log units, up to which noise and errors of normals may explain them.
pub const PURE_NOISE: f64 = 0.035;
/// Standard deviation of residuals in a channel, log units, above which light, noise and errors of normals do not
/// explain them.
pub const MIXED_NOISE: f64 = 2.0 * PURE_NOISE;
/// [`PURE_NOISE`] as a share of the spread of the log image: noisy normals under a strong light leave as much.
const PURE_SHARE: f64 = 0.15;
/// Largest spatial covariance of residuals (root of their mean covariance within tiles, log units) for which a single albedo is
/// an adequate model.
const MODEL_COVARIANCE: f64 = 0.007;
/// [`MODEL_COVARIANCE`] behind a pinhole, where dark print makes the spread of the colours large in comparison with the noise.
const PINHOLE_COVARIANCE: f64 = 0.03;
/// No other unit of depth is tried if the spatial covariance of residuals is at most this, log units, and they are at
/// most `UNIT_NOISE` times the image's noise.
pub const UNIT_COVARIANCE: f64 = 0.0015;
/// Residuals up to this multiple of the image's own noise count as noise.
const NOISE_OF_IMAGE: f64 = 1.5;
/// Residuals up to this share of the spread of the log image also count as noise.
const SHARE_OF_SPREAD: f64 = 0.05;
/// No other unit of depth is tried if residuals are at most this multiple of the image's noise, and their spatial
/// covariance is at most [`UNIT_COVARIANCE`].
pub const UNIT_NOISE: f64 = 1.25;
/// Residuals beyond this multiple of the image's own noise are errors of the model, such as shadows, print, or a lamp
/// too sharp for nine harmonics.
const MODEL_NOISE: f64 = 2.0;
/// Largest share of the spread of the log image that a trusted pose may leave unexplained.
pub const LARGEST_UNEXPLAINED: f64 = 0.3;
/// Largest objective of local contrast (E of `pose/contrast`, without unit) of a trusted pose: 0 if shading and silhouette
/// fit perfectly, about 1 if shading explains nothing.
pub const LARGEST_CONTRAST_OBJECTIVE: f64 = 0.56;

/// The residuals of an image after registration with a single albedo, in log units.
#[derive(Clone, Copy, Debug)]
pub struct Residuals {
    /// Robust standard deviation of a channel.
    pub noise: f64,
    /// Spatial covariance: root of the mean covariance of residuals within tiles, log units; `None` if only the
    /// noise was measured.
    pub spatial_covariance: Option<f64>,
    /// Standard deviation of the image's own noise.
    pub image_noise: f64,
    /// Standard deviation of the image's log colours.
    pub spread: f64,
}

/// The method that is tried if a single albedo does not explain the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Alternative {
    /// Registration by local contrast, for an orthographic image.
    LocalContrast,
    /// Registration by silhouettes, behind a pinhole.
    Silhouettes,
    /// Registration of the same shape in another unit of depth.
    DepthUnit,
}

/// The cause of an image's residuals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Diagnosis {
    /// Noise.
    Explained,
    /// More than noise, but nothing that the alternative would explain.
    ModelError,
    /// A varying albedo, or something that looks like it: cast shadows, light from other parts of the object.
    VaryingAlbedo,
}

impl Residuals {
    /// The diagnosis that decides whether an alternative is tried. For another unit of depth it is never [`Diagnosis::VaryingAlbedo`].
    #[must_use]
    pub fn diagnose(&self, against: Alternative) -> Diagnosis {
        let covary = |most: f64| self.spatial_covariance.is_some_and(|covariance| covariance > most);
        let (varies, is_explained) = match against {
            Alternative::LocalContrast if self.spatial_covariance.is_none() => {
                (self.noise > MIXED_NOISE, self.is_noise())
            }
            Alternative::LocalContrast => (covary(MODEL_COVARIANCE), self.is_noise()),
            Alternative::Silhouettes => {
                let purest = PURE_NOISE.max(PURE_SHARE * self.spread);
                (covary(PINHOLE_COVARIANCE) || self.noise > purest, self.is_noise())
            }
            Alternative::DepthUnit => (false, !covary(UNIT_COVARIANCE) && self.noise <= UNIT_NOISE * self.image_noise),
        };
        match (varies, is_explained) {
            (true, _) => Diagnosis::VaryingAlbedo,
            (false, true) => Diagnosis::Explained,
            (false, false) => Diagnosis::ModelError,
        }
    }

    /// Whether the residuals hardly exceed the image's own noise, whatever their spatial covariance is.
    #[must_use]
    pub fn is_noise(&self) -> bool {
        self.noise <= (NOISE_OF_IMAGE * self.image_noise).max(SHARE_OF_SPREAD * self.spread)
    }

    /// Whether the residuals are a negligible share of the spread.
    #[must_use]
    pub fn is_next_to_nothing(&self) -> bool {
        self.noise < SHARE_OF_SPREAD * self.spread
    }

    /// Whether these residuals have less spatial covariance than `share` of the others', and little enough for a single
    /// albedo.
    #[must_use]
    pub fn have_less_covariance(&self, share: f64, others: &Self) -> bool {
        let limit = others.spatial_covariance.map_or(MODEL_COVARIANCE, |theirs| MODEL_COVARIANCE.min(share * theirs));
        self.spatial_covariance.is_some_and(|covariance| covariance < limit)
    }
}

/// Whether residuals with these standard deviations along three axes of log colour may be noise and errors of normals alone.
#[must_use]
pub fn is_pure_noise(deviations: [f64; 3]) -> bool {
    deviations.iter().map(|deviation| deviation * deviation).sum::<f64>() < 3.0 * PURE_NOISE * PURE_NOISE
}

/// Noise as a multiple of [`PURE_NOISE`], clamped to two bounds.
#[must_use]
pub fn excess(noise: f64, [least, most]: [f64; 2]) -> f64 {
    (noise / PURE_NOISE).clamp(least, most)
}

/// Share of the variance of the residuals that errors of the model explain.
#[must_use]
pub fn share_of_model(residuals: f64, image_noise: f64) -> f64 {
    let of_image = MODEL_NOISE * image_noise / residuals;
    (1.0 - of_image * of_image).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use Alternative::{DepthUnit, LocalContrast, Silhouettes};
    use Diagnosis::{Explained, ModelError, VaryingAlbedo};

    /// Noise, covariance, the image's own noise and spread; the diagnosis for each alternative.
    const TABLE: [([f64; 4], [Diagnosis; 3]); 9] = [
        // Renders with noise, without noise, and with 3 % of noise.
        ([0.010, 0.0005, 0.011, 0.4], [Explained, Explained, Explained]),
        ([0.004, 0.0015, 0.000, 0.4], [Explained, Explained, ModelError]),
        ([0.030, 0.0043, 0.031, 0.3], [Explained, Explained, ModelError]),
        // Noisy normals leave more than noise, without spatial covariance.
        ([0.034, 0.0040, 0.010, 0.3], [ModelError, ModelError, ModelError]),
        // Noisy normals under a strong light.
        ([0.100, 0.0040, 0.010, 0.9], [ModelError, ModelError, ModelError]),
        // Cast shadows in a picture of shading.
        ([0.030, 0.0100, 0.010, 0.3], [VaryingAlbedo, ModelError, ModelError]),
        // Dark print, which spreads the colours so far that the noise is small in comparison.
        ([0.200, 0.1400, 0.010, 2.1], [VaryingAlbedo, VaryingAlbedo, ModelError]),
        // An object with varying albedo.
        ([0.150, 0.1000, 0.010, 0.4], [VaryingAlbedo, VaryingAlbedo, ModelError]),
        // Fine print, without spatial covariance.
        ([0.150, 0.0010, 0.010, 0.4], [ModelError, VaryingAlbedo, ModelError]),
    ];

    fn residuals([noise, covariance, image_noise, spread]: [f64; 4]) -> Residuals {
        Residuals { noise, spatial_covariance: Some(covariance), image_noise, spread }
    }

    #[test]
    fn each_kind_of_image_has_its_diagnosis() {
        for (numbers, expected) in TABLE {
            let found = [LocalContrast, Silhouettes, DepthUnit].map(|against| residuals(numbers).diagnose(against));
            assert_eq!(found, expected, "{numbers:?}");
        }
    }

    #[test]
    fn without_a_covariance_the_noise_alone_tells() {
        let only = |noise| {
            Residuals { noise, spatial_covariance: None, image_noise: 0.01, spread: 0.4 }.diagnose(LocalContrast)
        };
        assert_eq!([0.015, 0.06, 0.08].map(only), [Explained, ModelError, VaryingAlbedo]);
    }

    #[test]
    fn what_is_no_number_is_not_explained() {
        for against in [LocalContrast, Silhouettes, DepthUnit] {
            assert_eq!(residuals([f64::NAN, 0.0, 0.01, 0.4]).diagnose(against), ModelError, "{against:?}");
        }
    }

    #[test]
    fn another_unit_has_to_leave_less_covariance() {
        let [own, half, most] = [0.01, 0.0049, 0.0069].map(|covariance| residuals([0.02, covariance, 0.01, 0.4]));
        assert!(half.have_less_covariance(0.5, &own) && !most.have_less_covariance(0.5, &own));
        assert!(most.have_less_covariance(0.9, &residuals([0.02, 1.0, 0.01, 0.4])));
    }

    #[test]
    fn pure_noise_is_judged_over_three_axes() {
        assert!(is_pure_noise([0.034; 3]) && is_pure_noise([0.06, 0.0, 0.0]));
        assert!(!is_pure_noise([0.036; 3]) && !is_pure_noise([0.061, 0.0, 0.0]) && !is_pure_noise([f64::NAN; 3]));
    }

    #[test]
    fn grades_begin_where_noise_ends() {
        for (noise, expected) in [(0.01, 1.0), (0.035, 1.0), (0.0525, 1.5), (1.0, 2.0)] {
            assert!((excess(noise, [1.0, 2.0]) - expected).abs() < 1e-12, "{noise}");
        }
        assert_eq!(share_of_model(0.02, 0.01), 0.0);
        assert!((share_of_model(0.04, 0.01) - 0.75).abs() < 1e-12);
    }
}
