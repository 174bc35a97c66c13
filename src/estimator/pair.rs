//! What a run is given and never changes: both views, the options, the prior over natural lights.

use super::memory;
use crate::error::Result;
use crate::light::{Light, LightPrior};
use crate::options::{LightSource, Options};
use crate::view::{ColourImage, ColourView, DepthMap, DepthView, Size};

pub struct ViewPair {
    pub image: ColourView,
    pub depth: DepthView,
    pub options: Options,
    pub prior: LightPrior,
}

impl ViewPair {
    /// Checks both views and the options, and asks whether the memory for them is granted.
    ///
    /// # Errors
    /// Any [`Error`](crate::Error) of the views or the options, naming the field.
    pub fn new(image: ColourImage, depth: &DepthMap, options: Options) -> Result<Self> {
        options.validate()?;
        memory::check(Size::new("image", image.width, image.height)?, Size::new("depth", depth.width, depth.height)?)?;
        let (image, depth) = (ColourView::new(image)?, DepthView::new(depth, options.trim)?);
        Ok(Self { image, depth, options, prior: LightPrior::natural() })
    }

    /// The same views with other options.
    pub fn with(&self, options: Options) -> Self {
        Self { image: self.image.clone(), depth: self.depth.clone(), options, prior: LightPrior::natural() }
    }

    /// The light, where it is known but for its exposure.
    pub const fn known_light(&self) -> Option<&Light> {
        match &self.options.light {
            LightSource::Known(light) => Some(light),
            LightSource::Estimate => None,
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
