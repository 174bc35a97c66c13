//! The constant input of a run: both views, the options, the prior over lights.

use super::memory;
use super::reporting::units;
use crate::diagnosis::Residuals;
use crate::error::Result;
use crate::light::{Light, LightPrior};
use crate::options::{LightSource, Options};
use crate::pose::PhotometricReport;
use crate::view::{ColourImage, ColourView, DepthMap, DepthView, Size, WorkingSize};

#[derive(Clone)]
pub struct ViewPair {
    pub image: ColourView,
    pub depth: DepthView,
    pub options: Options,
    pub prior: LightPrior,
    /// Converts between the caller's image and the working image; `None` if they are the same.
    pub resizing: Option<WorkingSize>,
}

impl ViewPair {
    /// Checks both views and the options, and whether there is memory for them.
    ///
    /// # Errors
    /// Any [`Error`](crate::Error) of the views or the options, naming the field.
    pub fn new(image: ColourImage, depth: &DepthMap, options: Options) -> Result<Self> {
        options.validate()?;
        let prior = options.light_prior()?;
        let size = Size::new("depth", depth.width, depth.height)?;
        // A depth map that is too large for any image is refused before anything is read.
        memory::check(Size { width: 0, height: 0 }, size)?;
        let (image, resizing) = WorkingSize::of(image, depth, memory::most_image_pixels(size))?;
        memory::check(image.size, size)?;
        let depth = DepthView::new(depth, options.trim)?;
        Ok(Self { image, depth, options: units::options_in(resizing.as_ref(), options), prior, resizing })
    }

    /// The same views with other options.
    ///
    /// # Errors
    /// [`ErrorKind::Range`](crate::ErrorKind) or `Size` for a prior that is not a Gaussian over lights.
    pub fn with(&self, options: Options) -> Result<Self> {
        let prior = options.light_prior()?;
        let resizing = self.resizing.clone();
        let options = units::options_in(resizing.as_ref(), options);
        Ok(Self { image: self.image.clone(), depth: self.depth.clone(), options, prior, resizing })
    }

    /// The light, if it is known up to its exposure.
    pub const fn known_light(&self) -> Option<&Light> {
        match &self.options.light {
            LightSource::Known(light) => Some(light),
            LightSource::Estimate => None,
        }
    }

    /// The residuals of a registration.
    pub fn residuals(&self, found: &PhotometricReport) -> Residuals {
        Residuals { spatial_covariance: Some(found.spatial_covariance), ..self.residuals_of_noise(found.noise) }
    }

    /// The residuals if only their noise was measured.
    pub fn residuals_of_noise(&self, noise: f64) -> Residuals {
        Residuals {
            noise,
            spatial_covariance: None,
            image_noise: self.image.log_noise(),
            spread: self.image.log_spread(),
        }
    }

    /// log S of R, G, B.
    pub fn log(&self) -> [&[f32]; 3] {
        self.image.log.each_ref().map(Vec::as_slice)
    }

    /// Number of image pixels and of depth pixels.
    pub const fn lengths(&self) -> [usize; 2] {
        [self.image.size.len(), self.depth.size.len()]
    }
}
