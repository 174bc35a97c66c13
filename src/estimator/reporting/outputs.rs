//! The results of a run so far.

use std::borrow::Cow;

use nalgebra::Vector3;

use super::{measurement, units};
use crate::error::Result;
use crate::estimator::Estimator;
use crate::light::Light;
use crate::picture::{self, ColourMap, Layer};
use crate::report::StepReport;
use crate::view::{ColourView, DepthView, Normals, Size, WorkingSize};

/// Which surface [`Estimator::points`] returns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// The surface found in the image.
    Image,
    /// The refined depth view, transformed by the pose.
    Depth,
}

impl Estimator {
    /// The report of the last stage.
    #[must_use]
    pub fn report(&self) -> &StepReport {
        self.report.given_out()
    }

    /// The registration that found the pose, in words, for tests of the whole.
    #[doc(hidden)]
    #[must_use]
    pub fn registered_by(&self) -> &'static str {
        self.stages.registration.engine(&self.pair)
    }

    /// Normals of the image surface, colour view's frame, NaN off the mask.
    #[must_use]
    pub fn image_normals(&self) -> Cow<'_, Normals> {
        let own = &self.solution.image.normals;
        self.pair.resizing.as_ref().map_or(Cow::Borrowed(own), |resizing| Cow::Owned(resizing.carry_normals(own)))
    }

    /// Depth of the image surface, NaN off the mask; in pixels with median zero for an orthographic image.
    #[must_use]
    pub fn image_depth(&self) -> Cow<'_, [f32]> {
        let own = &self.solution.image.points.z;
        self.pair
            .resizing
            .as_ref()
            .map_or(Cow::Borrowed(own), |resizing| Cow::Owned(resizing.carry(own, resizing.unit())))
    }

    /// Refined normals of the depth view, in its own frame.
    #[must_use]
    pub const fn depth_normals(&self) -> &Normals {
        &self.solution.depth.normals
    }

    /// Refined depth of the depth view, holes filled.
    #[must_use]
    pub fn refined_depth(&self) -> &[f32] {
        &self.solution.depth.points.z
    }

    /// Draws a result as screen pixels, row by row, replacing the content of `rgba`. `range` and `map` apply to numbers
    /// and not to normals.
    ///
    /// # Errors
    /// A range that is empty or not finite.
    pub fn draw(&self, layer: Layer, range: Option<[f64; 2]>, map: ColourMap, rgba: &mut Vec<u8>) -> Result<Size> {
        match layer {
            Layer::Normals => picture::draw_normals(&self.image_normals(), rgba),
            Layer::RefinedNormals => picture::draw_normals(self.depth_normals(), rgba),
            Layer::Depth => picture::draw_numbers(&self.image_depth(), range, map, rgba)?,
            Layer::Residual => picture::draw_numbers(&self.residual(), range, map, rgba)?,
            Layer::Refined => picture::draw_numbers(self.refined_depth(), range, map, rgba)?,
        }
        let image = || self.pair.resizing.as_ref().map_or(self.image().size, WorkingSize::full);
        Ok(match layer {
            Layer::Normals | Layer::Depth | Layer::Residual => image(),
            Layer::Refined | Layer::RefinedNormals => self.depth().size,
        })
    }

    /// The index of the depth pixel for each image pixel, or -1.
    #[must_use]
    pub fn correspondence(&self) -> Cow<'_, [i32]> {
        let own = self.correspondences.depth_of_pixel();
        self.pair.resizing.as_ref().map_or(Cow::Borrowed(own), |resizing| Cow::Owned(resizing.carry_indices(own)))
    }

    /// |log S - predicted| of each image pixel, NaN off the mask: predicted from the measured normal of the
    /// corresponding depth point, or
    /// else from the image's own normal.
    #[must_use]
    pub fn residual(&self) -> Cow<'_, [f32]> {
        let own = self.residuals.of_pixels();
        self.pair.resizing.as_ref().map_or(Cow::Borrowed(own), |resizing| Cow::Owned(resizing.carry(own, 1.0)))
    }

    /// Log albedo of each image pixel, R, G, B interleaved: mean zero over the mask in each channel, NaN off it. Zero
    /// if a single albedo explains the image, and before the pose has settled.
    #[must_use]
    pub fn albedo(&self) -> Vec<f32> {
        let mask = &self.pair.image.mask;
        self.carried(match self.stages.albedo.found() {
            Some(found) => {
                (0..mask.len()).flat_map(|pixel| [0, 1, 2].map(|channel: usize| found.albedo[channel][pixel])).collect()
            }
            None => mask.iter().flat_map(|&inside| [if inside { 0.0 } else { f32::NAN }; 3]).collect(),
        })
    }

    /// Log shading of each image pixel, R, G, B interleaved, NaN off the mask. The length of log S minus
    /// [`albedo`](Self::albedo) and shading is [`residual`](Self::residual).
    #[must_use]
    pub fn shading(&self) -> Vec<f32> {
        self.carried(measurement::shading(&self.pair, &self.stages.albedo, &self.solution, &self.correspondences))
    }

    /// Converts the report of the last stage to the caller's units.
    pub(in crate::estimator) fn translate_report(&mut self) {
        self.report.translate(self.pair.resizing.as_ref());
    }

    /// Converts colours of the working view to the caller's pixels.
    fn carried(&self, interleaved: Vec<f32>) -> Vec<f32> {
        match &self.pair.resizing {
            Some(resizing) => resizing.carry_colours(&interleaved),
            None => interleaved,
        }
    }

    /// The light, known or estimated. The exposure of a known light is [`exposure`](Self::exposure).
    #[must_use]
    pub const fn light(&self) -> Light {
        self.solution.light.light
    }

    /// Offset of log S on top of [`light`](Self::light).
    #[must_use]
    pub const fn exposure(&self) -> f64 {
        self.solution.light.exposure
    }

    /// The checked colour view that the estimator works on: a smaller one if the photograph is much finer than the
    /// depth map.
    #[must_use]
    pub const fn image(&self) -> &ColourView {
        &self.pair.image
    }

    /// The checked depth view.
    #[must_use]
    pub const fn depth(&self) -> &DepthView {
        &self.pair.depth
    }

    /// Points of a surface in the colour view's frame: x, y, z of each valid pixel in turn.
    #[must_use]
    pub fn points(&self, surface: Surface) -> Vec<f32> {
        let points = match surface {
            Surface::Image => &self.solution.image.points,
            Surface::Depth => &self.solution.depth.points,
        };
        let valid = (0..points.len()).filter(|&index| points.is_valid(index)).map(|index| points.get(index));
        let place = |point: [f32; 3]| {
            let point = Vector3::from(point.map(f64::from));
            let point = if surface == Surface::Depth { self.solution.pose.apply(point) } else { point };
            let point = self.pair.resizing.as_ref().map_or(point, |resizing| units::point_out(resizing, point));
            <[f64; 3]>::from(point).map(|value| value as f32)
        };
        valid.flat_map(place).collect()
    }
}
