//! Paint, once the pose is settled: what the colours are without it, and what is shown of it.
//!
//! Under a wrong pose the wrong normals explain the colours, and what they leave looks like paint. So it is looked for
//! where the pose will not move any more, by the measured normals: refined ones have followed the colours already. The
//! paper's own registration, which never comes to rest, has one albedo, as in the paper.

use crate::estimator::pair::ViewPair;
use crate::estimator::solution::ExposedLight;
use crate::light::{Paint, PaintFitter};
use crate::pose::Similarity;
use crate::view::{ColourView, Normals};

/// Looks for paint; owns what it finds.
pub struct PaintStage {
    fitter: PaintFitter,
    /// The pose that it was looked for under.
    pose: Option<Similarity>,
    found: Option<FoundPaint>,
}

/// A light and the paint under it, pixel by pixel.
pub struct FoundPaint {
    pub light: ExposedLight,
    /// What is added to log S of R, G, B under a known light, whose colour is not its own: zero where it was estimated.
    pub tint: [f64; 3],
    /// Log paint of R, G, B, mean zero over the mask, NaN off it.
    pub albedo: [Vec<f32>; 3],
    /// The image without the paint of its regions: what shape is found from. Finer paint stays in, for it may as well
    /// be shape.
    colours: ColourView,
}

impl PaintStage {
    pub fn new() -> Self {
        Self { fitter: PaintFitter::new(), pose: None, found: None }
    }

    /// Whether paint has been looked for under this pose; t_z of an orthographic image is a gauge.
    pub fn knows(&self, pair: &ViewPair, pose: &Similarity) -> bool {
        let free = |pose: &Similarity| {
            let z = if pair.image.camera.is_orthographic() { 0.0 } else { pose.translation.z };
            (pose.scale, pose.rotation, pose.translation.xy(), z)
        };
        self.pose.as_ref().is_some_and(|known| free(known) == free(pose))
    }

    /// Looks for paint under `pose`, by the measured `normals` of the image's pixels.
    pub fn find(&mut self, pair: &ViewPair, pose: &Similarity, normals: &Normals) {
        let prior = (&pair.prior, pair.options.weights.light);
        let paint = self.fitter.fit(normals, pair.log(), prior, pair.known_light());
        self.pose = Some(*pose);
        self.found = paint.map(|paint| FoundPaint::of(pair, normals, &paint));
    }

    /// What there is of paint, where there is any.
    pub const fn found(&self) -> Option<&FoundPaint> {
        self.found.as_ref()
    }

    /// The image without all of its paint, where there is any.
    pub fn without_albedo(&self, pair: &ViewPair) -> Option<ColourView> {
        let albedo = &self.found.as_ref()?.albedo;
        let mut image = pair.image.clone();
        for (log, paint) in image.log.iter_mut().flatten().zip(albedo.iter().flatten()) {
            *log -= paint;
        }
        Some(image)
    }

    /// The image as shape is found from it: without paint.
    pub fn colours<'a>(&'a self, pair: &'a ViewPair) -> &'a ColourView {
        self.found.as_ref().map_or(&pair.image, |found| &found.colours)
    }
}

impl FoundPaint {
    fn of(pair: &ViewPair, normals: &Normals, paint: &Paint) -> Self {
        let mut albedo = [(); 3].map(|()| vec![f32::NAN; pair.image.size.len()]);
        let mut colours = pair.image.clone();
        let light = paint.light();
        let (mut mean, mut count) = ([0.0; 3], 0.0);
        for pixel in (0..pair.image.size.len()).filter(|&pixel| pair.image.mask[pixel]) {
            let shading = normals.is_valid(pixel).then(|| light.shade(normals.get(pixel).map(f64::from)));
            let found = paint.of_pixel(pair.image.log_at(pixel).map(f64::from), shading);
            count += 1.0;
            for channel in 0..3 {
                albedo[channel][pixel] = found.fine[channel] as f32;
                colours.log[channel][pixel] -= found.region[channel] as f32;
                mean[channel] += found.fine[channel];
            }
        }
        let mean = mean.map(|sum| sum / f64::max(count, 1.0));
        let (light, tint) = split(pair, paint, mean);
        for channel in 0..3 {
            albedo[channel].iter_mut().for_each(|log| *log -= mean[channel] as f32);
            let shift = (mean[channel] - tint[channel]) as f32;
            colours.log[channel].iter_mut().for_each(|log| *log += shift);
        }
        Self { light, tint, albedo, colours }
    }
}

/// The light that carries the `mean` of the paint. A known one takes its exposure; its colour is left to a tint.
fn split(pair: &ViewPair, paint: &Paint, mean: [f64; 3]) -> (ExposedLight, [f64; 3]) {
    let total = paint.light().tinted(mean);
    let Some(&light) = pair.known_light() else { return (ExposedLight { light: total, exposure: 0.0 }, [0.0; 3]) };
    let offsets = total.offsets_to(&light);
    let exposure = offsets.iter().sum::<f64>() / 3.0;
    (ExposedLight { light, exposure }, offsets.map(|offset| offset - exposure))
}
