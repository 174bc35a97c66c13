//! The decision near an initial pose, from what the registrations near it and the other methods found.

use super::registrations::InitialRegistrations;
use super::trust_region::TrustRegion;
use crate::error::Result;
use crate::estimator::decision::{Decision, Method, Staying};
use crate::estimator::finder::candidates::problem;
use crate::estimator::finder::local_optima::Choice;
use crate::estimator::finder::second_search::evidence;
use crate::estimator::finder::{local_contrast, silhouettes};
use crate::estimator::gauge;
use crate::estimator::pair::ViewPair;
use crate::estimator::photometric::PhotometricRegistration;
use crate::pose::{PhotometricReport, Search, SilhouetteReport, Similarity};

/// Lead in evidence from which a photometric pose counts although the albedo varies: odds of twenty to one.
const CLEAR_LEAD: f64 = 3.0;

/// What is known about the surroundings of an initial pose.
pub struct InitialEvidence {
    pub region: TrustRegion,
    /// The pose registered from the initial one, if it leaves no more than the image's own noise.
    noisy: Option<Similarity>,
    /// The pose from silhouettes, if they constrain it.
    pub silhouettes: Option<Box<SilhouetteReport>>,
}

impl InitialEvidence {
    /// The region of an initial pose, with the registration from that pose if it ended there.
    pub fn new(pair: &ViewPair, region: TrustRegion, plain: Option<&PhotometricReport>) -> Self {
        let noisy = plain.filter(|found| pair.residuals(found).is_noise()).map(|found| found.pose);
        Self { region, noisy, silhouettes: None }
    }

    /// Whether to repeat the registrations near the initial pose: once, and only if a single albedo does not explain the image.
    pub fn begins_again(&self, pair: &ViewPair, photometric: &PhotometricRegistration, choice: &Choice) -> bool {
        let is_explained = choice.best.as_ref().is_some_and(|best| !silhouettes::has_varying_albedo(pair, best));
        !photometric.is_kept_near() && !is_explained && self.region.prior(pair).is_some()
    }

    /// Repeats the registrations, held near the initial pose.
    pub fn begin_again(&mut self, pair: &ViewPair, photometric: &mut PhotometricRegistration) -> InitialRegistrations {
        photometric.keep_near(self.region.prior(pair));
        InitialRegistrations::again(pair, self.region.clone(), self.silhouettes.take())
    }

    /// Takes the first pose within the trust region: from local contrast, the image or silhouettes. Otherwise keeps the initial pose.
    pub fn conclude(
        &mut self,
        pair: &ViewPair,
        photometric: &mut PhotometricRegistration,
        Choice { best, mut rivals, ends }: Choice,
        found: Option<Decision>,
    ) -> Result<Decision> {
        let region = &self.region;
        let is_near = |found: &Decision| found.pose().is_some_and(|pose| region.holds(pair, pose));
        if let Some(mut found) = found.filter(is_near) {
            if let (Method::Contrast(contrast), Some(rivals)) = (&found.by, &mut found.rivals) {
                // A pose that leaves only the image's own noise is a rival, however large the spatial covariance of its residuals.
                local_contrast::add_rival(&contrast.report, rivals, self.noisy);
            }
            return Ok(found);
        }
        let silhouettes = self.silhouettes.take();
        let varies = best.as_deref().is_some_and(|best| silhouettes::has_varying_albedo(pair, best));
        let lead = match (&best, &silhouettes) {
            (Some(best), Some(found)) if varies || !pair.residuals(best).is_noise() => {
                Some(self.lead(pair, photometric, best, found))
            }
            _ => None,
        };
        // Silhouettes do not depend on the albedo, so they decide where it varies, unless the image has clearly more evidence.
        let is_beaten = varies && lead.is_some_and(|lead| lead < CLEAR_LEAD);
        let Some(mut best) = best.filter(|_| !is_beaten) else {
            return Ok(Decision::of(silhouettes.map_or_else(|| stay(pair, photometric, region), Method::Silhouettes)));
        };
        // A single albedo can explain the colours at a wrong pose, too, but leaves more than noise there. If silhouettes have
        // more evidence, their pose is a rival.
        if lead.is_some_and(|lead| lead < 0.0) {
            rivals.extend(silhouettes.as_ref().map(|found| found.pose));
        }
        // Candidates are registered on a sample of the points; all points follow.
        let sampled = best.pose;
        photometric.register_again(pair, &mut best, &sampled, &ends)?;
        if region.holds(pair, &best.pose) {
            let by_contrast = varies && lead.is_some();
            return Ok(Decision { by: Method::Photometric(best), rivals: Some(rivals), ends, by_contrast });
        }
        let near = silhouettes.filter(|found| region.holds(pair, &found.pose));
        Ok(Decision::of(near.map_or_else(|| stay(pair, photometric, region), Method::Silhouettes)))
    }

    /// Evidence for a photometric pose, less that for the pose from silhouettes.
    fn lead(
        &self,
        pair: &ViewPair,
        photometric: &mut PhotometricRegistration,
        best: &PhotometricReport,
        found: &SilhouetteReport,
    ) -> f64 {
        let mut search = Search::for_parts(&problem(pair, photometric)).ok();
        let mut of_image = |judged: &PhotometricReport| {
            search.as_mut().and_then(|search| evidence(pair, search, judged)).unwrap_or(0.0)
        };
        let lead = of_image(best) - photometric.judge(pair, &found.pose).map_or(0.0, |judged| of_image(&judged));
        let normals = photometric.normals();
        let of_silhouettes = |prior| silhouettes::lead_near(pair, normals, prior, found, &best.pose);
        lead - self.region.prior(pair).map_or(0.0, of_silhouettes)
    }
}

/// Keeps the initial pose.
fn stay(pair: &ViewPair, photometric: &mut PhotometricRegistration, region: &TrustRegion) -> Method {
    // An object shrunk to a few pixels fits any image, so its size must be plausible as well.
    let of_size = Similarity { scale: gauge::unit_scale(pair), ..region.initial };
    let explains = |found: Box<PhotometricReport>| found.noise < pair.image.log_spread();
    let has_size = gauge::keeps_size(pair, &region.initial, &of_size);
    Method::Initial(match has_size && photometric.judge(pair, &region.initial).is_some_and(explains) {
        true => Staying::Explains,
        false => Staying::ExplainsNothing,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::{Options, Start};
    use crate::pose::{Angles, SilhouetteProblem, SilhouetteRegistration};
    use crate::scenes::{SampleRequest, Scene, light, surface};
    use crate::view::{Camera, ColourSamples, Lens, Pinhole, Size};

    /// A bust with dark waves of albedo behind a pinhole, its true pose given, and a pose seven degrees off.
    fn pair_and_wrong_pose() -> (ViewPair, Similarity) {
        let camera = Camera::Pinhole(Pinhole { fx: 288.0, fy: 288.0, cx: 47.5, cy: 35.5, lens: Lens::None });
        let sample = Scene::new(&surface("bust").unwrap()).unwrap().sample(&SampleRequest {
            size: Size { width: 96, height: 72 },
            light: light("colourful").unwrap(),
            rotation: Angles { alpha: -5.0, beta: 20.0, gamma: 5.0 }.rotation(),
            image_camera: camera,
            depth_camera: camera,
            ..SampleRequest::default()
        });
        let sample = sample.unwrap();
        let mut image = sample.colour_image();
        let painted = |index: usize| {
            let (column, row) = sample.image.size.position(index);
            let wave = (-0.4 * (0.5 * column as f32 + 0.3 * row as f32).sin()).exp();
            [0, 1, 2].map(|channel| wave * (0.05 + sample.image.colours[3 * index + channel]))
        };
        image.samples = ColourSamples::RgbLinear((0..sample.image.size.len()).flat_map(painted).collect());
        let Similarity { rotation, scale, translation } = sample.pose;
        let start = Start::Pose { rotation, scale: Some(scale), translation: Some(translation) };
        let pair = ViewPair::new(image, &sample.depth_map(), Options { start, ..Options::default() }).unwrap();
        let middle = pair.depth.points.centroid();
        let turned = sample.pose.rotation * Angles { beta: 7.0, ..Angles::default() }.rotation();
        let shifted = sample.pose.apply(middle) - scale * (turned * middle);
        (pair, Similarity { rotation: turned, scale, translation: shifted })
    }

    #[test]
    fn evidence_decides_between_image_and_silhouettes_and_their_sigmas_do_not() {
        let (pair, wrong) = pair_and_wrong_pose();
        let region = TrustRegion::of(&pair).unwrap();
        let (truth, prior) = (region.initial, region.prior(&pair).unwrap());
        for (of_image, of_silhouettes) in [(truth, wrong), (wrong, truth)] {
            let mut photometric = PhotometricRegistration::new(&pair);
            let mut best = photometric.judge(&pair, &of_image).unwrap();
            assert!(silhouettes::has_varying_albedo(&pair, &best));
            let normals = photometric.normals();
            let problem = SilhouetteProblem { image: &pair.image, depth: &pair.depth, normals, prior };
            let mut found = Box::new(SilhouetteRegistration::new(&problem).judge(&problem, &of_silhouettes));
            let [sure, unsure] = [[0.1; 3], [9.0; 3]];
            let is_right = of_image == truth;
            best.uncertainty.rotation_degrees = if is_right { unsure } else { sure };
            found.uncertainty.rotation_degrees = if is_right { sure } else { unsure };
            let mut evidence = InitialEvidence { region: region.clone(), noisy: None, silhouettes: Some(found) };
            let choice = Choice { best: Some(best), ..Choice::default() };
            let decision = evidence.conclude(&pair, &mut photometric, choice, None).unwrap();
            assert_eq!(decision.photometric().is_some(), is_right);
            // Colours that a single albedo does not explain only cap the status, because the albedo is known to vary.
            assert_eq!(decision.by_contrast, is_right);
            assert!(decision.pose().unwrap().degrees_to(&truth) < 3.0);
        }
    }
}
