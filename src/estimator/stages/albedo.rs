//! Albedo, fitted once the pose has settled: the image without it, and the part that is reported.
//!
//! Under a wrong pose, the wrong normals explain the image, and the residuals look like albedo. Albedo is therefore
//! fitted only if the pose will not move any more, and to the measured normals, because refined ones already follow the
//! colours. The paper's own registration never settles and assumes a single albedo, as in the paper.

use crate::estimator::pair::ViewPair;
use crate::estimator::solution::ExposedLight;
use crate::light::{AlbedoFitter, VaryingAlbedo};
use crate::pose::Similarity;
use crate::view::{ColourView, Normals};

/// Fits the albedo; owns the result.
pub struct AlbedoStage {
    fitter: AlbedoFitter,
    /// The pose under which it was fitted.
    pose: Option<Similarity>,
    found: Option<FittedAlbedo>,
}

/// A light and the albedo under it, pixel by pixel.
pub struct FittedAlbedo {
    pub light: ExposedLight,
    /// Offset of log S in R, G, B under a known light, whose colour may differ from the image's; zero if the light was
    /// estimated.
    pub tint: [f64; 3],
    /// Log albedo of R, G, B, mean zero over the mask, NaN off it.
    pub albedo: [Vec<f32>; 3],
    /// The image without the albedo of its regions, from which shape is found. Finer albedo stays, because it may be
    /// shape.
    colours: ColourView,
}

impl AlbedoStage {
    pub fn new() -> Self {
        Self { fitter: AlbedoFitter::new(), pose: None, found: None }
    }

    /// Whether the albedo was fitted under this pose; t_z of an orthographic image is ignored as a gauge.
    pub fn knows(&self, pair: &ViewPair, pose: &Similarity) -> bool {
        let free = |pose: &Similarity| {
            let z = if pair.image.camera.is_orthographic() { 0.0 } else { pose.translation.z };
            (pose.scale, pose.rotation, pose.translation.xy(), z)
        };
        self.pose.as_ref().is_some_and(|known| free(known) == free(pose))
    }

    /// Fits the albedo under `pose`, with the measured `normals` of the image's pixels.
    pub fn find(&mut self, pair: &ViewPair, pose: &Similarity, normals: &Normals) {
        let prior = (&pair.prior, pair.options.weights.light);
        let found = self.fitter.fit(normals, pair.log(), prior, pair.known_light());
        self.pose = Some(*pose);
        self.found = found.map(|found| FittedAlbedo::of(pair, normals, &found));
    }

    /// The varying albedo, if there is any.
    pub const fn found(&self) -> Option<&FittedAlbedo> {
        self.found.as_ref()
    }

    /// The image without any of its albedo, if that varies.
    pub fn without_albedo(&self, pair: &ViewPair) -> Option<ColourView> {
        let albedo = &self.found.as_ref()?.albedo;
        let mut image = pair.image.clone();
        for (log, albedo) in image.log.iter_mut().flatten().zip(albedo.iter().flatten()) {
            *log -= albedo;
        }
        Some(image)
    }

    /// The image from which shape is found: without the albedo.
    pub fn colours<'a>(&'a self, pair: &'a ViewPair) -> &'a ColourView {
        self.found.as_ref().map_or(&pair.image, |found| &found.colours)
    }
}

impl FittedAlbedo {
    fn of(pair: &ViewPair, normals: &Normals, found: &VaryingAlbedo) -> Self {
        let mut albedo = [(); 3].map(|()| vec![f32::NAN; pair.image.size.len()]);
        let mut colours = pair.image.clone();
        let light = found.light();
        let (mut mean, mut count) = ([0.0; 3], 0.0);
        for pixel in (0..pair.image.size.len()).filter(|&pixel| pair.image.mask[pixel]) {
            let shading = normals.is_valid(pixel).then(|| light.shade(normals.get(pixel).map(f64::from)));
            let found = found.of_pixel(pair.image.log_at(pixel).map(f64::from), shading);
            count += 1.0;
            for channel in 0..3 {
                albedo[channel][pixel] = found.fine[channel] as f32;
                colours.log[channel][pixel] -= found.region[channel] as f32;
                mean[channel] += found.fine[channel];
            }
        }
        let mean = mean.map(|sum| sum / f64::max(count, 1.0));
        let (light, tint) = split(pair, found, mean);
        for channel in 0..3 {
            albedo[channel].iter_mut().for_each(|log| *log -= mean[channel] as f32);
            let shift = (mean[channel] - tint[channel]) as f32;
            colours.log[channel].iter_mut().for_each(|log| *log += shift);
        }
        Self { light, tint, albedo, colours }
    }
}

/// The light with the `mean` of the albedo. A known light takes its exposure, and its colour becomes the tint.
fn split(pair: &ViewPair, found: &VaryingAlbedo, mean: [f64; 3]) -> (ExposedLight, [f64; 3]) {
    let total = found.light().tinted(mean);
    let Some(&light) = pair.known_light() else { return (ExposedLight { light: total, exposure: 0.0 }, [0.0; 3]) };
    let offsets = total.offsets_to(&light);
    let exposure = offsets.iter().sum::<f64>() / 3.0;
    (ExposedLight { light, exposure }, offsets.map(|offset| offset - exposure))
}
