//! Photometric registration of a pair, for the finder, the registration stage and the check of the depth unit: the
//! normals it uses, and its memory.

use crate::error::{Error, ErrorKind, Result};
use crate::estimator::gauge;
use crate::estimator::pair::ViewPair;
use crate::pose::{
    ContrastProblem, Photometric, PhotometricOptions, PhotometricProblem, PhotometricReport, PosePrior, Similarity,
};
use crate::view::{ColourView, DepthView, Normals, cubic_normals};

/// Weight of the light's prior in the registration, one as in Bayes' rule. `lambda.light` weighs only the fit of the
/// light stage, but if it is zero, there is no prior here either.
const PRIOR_WEIGHT: f64 = 1.0;

/// Depth noise above which surfaces determine the pose better than normals, pixel lengths. Set on Mozart at 64x64
/// (docs/lab/thresholds.md).
const LARGEST_NOISE: f64 = 0.2;

/// Largest number of points, evenly spread, by which a candidate of the search is registered. The best candidate is
/// registered again by all points. With at most 33 unknowns, so many points average the noise well enough to distinguish
/// candidates, and large views take no longer.
pub const CANDIDATE_POINTS: usize = 2500;

/// Change of the apparent size (natural logarithm) beyond which a registration has collapsed: a cloud that shrinks onto
/// a few pixels fits easily. Candidates of the search lie within 0.1 of the right size.
pub const COLLAPSE: f64 = 0.3;

/// Image level at which candidates near an initial pose begin.
pub const FIRST_LEVEL_NEAR: usize = 1;

/// Progress of a candidate's registration.
pub enum Attempt {
    Ongoing,
    /// The report of the registration; `None` if the candidate cannot be registered, which is not an error of the pair.
    Ended(Option<Box<PhotometricReport>>),
}

/// Registers the measured depth view to the image; owns all memory.
pub struct PhotometricRegistration {
    photometric: Photometric,
    sharp: SharpNormals,
    surfaces_settle_pose: bool,
    /// An initial pose near which registrations are held, if a single albedo does not explain the image from there.
    near: Option<PosePrior>,
}

/// Third-order normals of the depth view, and the sigma of each in radians.
struct SharpNormals {
    normals: Normals,
    error: Vec<f32>,
    /// Standard deviation of the view's points, pixel lengths.
    noise: f64,
}

impl SharpNormals {
    /// The caller's normals are taken as exact.
    fn new(depth: &DepthView) -> Self {
        let mut normals = depth.normals.clone();
        let mut error = vec![0.0; depth.size.len()];
        let mut noise = 0.0;
        if !depth.normals_given {
            noise = cubic_normals::improve(depth.size, &depth.points, &mut normals, &mut error, depth.noise.is_white)
                .max(depth.noise.sigma);
        }
        Self { normals, error, noise }
    }

    // Not inlined, because each copy adds to the download.
    #[inline(never)]
    fn problem<'a>(
        &'a self,
        pair: &'a ViewPair,
        scale_is_held: bool,
        near: Option<PosePrior>,
    ) -> PhotometricProblem<'a> {
        PhotometricProblem {
            image: &pair.image,
            depth_size: pair.depth.size,
            points: &pair.depth.points,
            normals: &self.normals,
            normal_error: Some(&self.error),
            depth_noise: pair.depth.noise,
            light: pair.known_light(),
            prior: &pair.prior,
            prior_weight: if pair.options.weights.light > 0.0 { PRIOR_WEIGHT } else { 0.0 },
            scale_is_held,
            near,
        }
    }
}

impl PhotometricRegistration {
    #[inline(never)]
    pub fn new(pair: &ViewPair) -> Self {
        let sharp = SharpNormals::new(&pair.depth);
        Self {
            photometric: Photometric::new(&sharp.problem(pair, is_scale_held(pair), None)),
            near: None,
            surfaces_settle_pose: sharp.noise > LARGEST_NOISE && pair.known_light().is_some(),
            sharp,
        }
    }

    /// Holds the next registrations near an initial pose, or frees them.
    pub const fn keep_near(&mut self, prior: Option<PosePrior>) {
        self.near = prior;
    }

    /// Whether registrations are held near an initial pose.
    pub const fn is_kept_near(&self) -> bool {
        self.near.is_some()
    }

    /// The memory of a pair, made now if it does not exist yet.
    #[inline(never)]
    pub fn prepared<'a>(memory: &'a mut Option<Self>, pair: &ViewPair) -> &'a mut Self {
        memory.get_or_insert_with(|| Self::new(pair))
    }

    /// Normals of the depth view that registration uses.
    pub const fn normals(&self) -> &Normals {
        &self.sharp.normals
    }

    /// The best pose near `start` by photometric registration in another version of the image.
    pub fn register_in(&self, pair: &ViewPair, image: &ColourView, start: &Similarity) -> Option<PhotometricReport> {
        let problem = PhotometricProblem { image, ..self.sharp.problem(pair, is_scale_held(pair), self.near) };
        let found = Photometric::new(&problem).register(&problem, start, &options(pair)).ok()?;
        Some(found).filter(|found| gauge::growth(pair, &found.pose, start) < COLLAPSE)
    }

    /// The problem of a registration by local contrast, with a version of the pair's image.
    pub fn contrast_problem<'a>(&'a self, pair: &'a ViewPair, image: &'a ColourView) -> ContrastProblem<'a> {
        ContrastProblem {
            image,
            object: pair.image.object(),
            depth: &pair.depth,
            normals: &self.sharp.normals,
            normal_error: &self.sharp.error,
            unit_scale: gauge::unit_scale(pair),
            scale_is_held: is_scale_held(pair),
        }
    }

    /// Whether the depth is so noisy that its normals determine the pose only roughly. Matching surfaces then
    /// determines the pose, because this averages the noise of whole surfaces. False under an unknown light, where the
    /// image's surface depends on the pose and cannot determine it.
    pub const fn surfaces_settle_pose(&self) -> bool {
        self.surfaces_settle_pose
    }

    /// Whether the depth is clean enough for its normals to reveal varying albedo. Noisy normals leave residuals as
    /// large as those of varying albedo.
    pub fn has_clean_normals(&self) -> bool {
        self.sharp.noise <= LARGEST_NOISE
    }

    /// The best pose near `start`.
    pub fn register(&mut self, pair: &ViewPair, start: &Similarity) -> Result<PhotometricReport> {
        self.register_anew(pair, start, &options(pair))
    }

    /// Registers all points again near `start`, after the registration `found`. One that starts where the last one ended
    /// is not repeated: the measured normals do not change, so neither would its end. The spread of `ends` adds to the
    /// sigmas.
    pub fn register_again(
        &mut self,
        pair: &ViewPair,
        found: &mut PhotometricReport,
        start: &Similarity,
        ends: &[Similarity],
    ) -> Result<()> {
        if ended_in(found, start) {
            return Ok(());
        }
        // A registration by a sample of the points ends so close that the sharp level is enough for all of them.
        let first_level = if found.sampled { 0 } else { options(pair).first_level };
        *found = self.register_anew(pair, start, &PhotometricOptions { first_level, ..options(pair) })?;
        found.uncertainty.add_spread(&found.pose, ends);
        Ok(())
    }

    /// Completes the sigmas of a candidate that becomes the decision: its registration did without the jackknife. One of
    /// sampled points is registered again with all of them, which includes it.
    pub fn complete_sigmas(&mut self, pair: &ViewPair, found: &mut PhotometricReport) {
        if found.sampled {
            return;
        }
        let problem = self.sharp.problem(pair, is_scale_held(pair), self.near);
        if let Ok(complete) = self.photometric.with_jackknife(&problem, found) {
            *found = complete;
        }
    }

    fn register_anew(
        &mut self,
        pair: &ViewPair,
        start: &Similarity,
        options: &PhotometricOptions,
    ) -> Result<PhotometricReport> {
        let scale_is_held = is_scale_held(pair);
        match self.photometric.register(&self.sharp.problem(pair, scale_is_held, self.near), start, options) {
            Ok(found) if gauge::growth(pair, &found.pose, start) < COLLAPSE => Ok(found),
            Ok(_) if scale_is_held && !pair.image.camera.is_orthographic() => Err(collapsed()),
            found if scale_is_held => found,
            _ => self.register_scale_last(pair, start, options),
        }
    }

    /// Registers with a held scale first, and frees the scale last, at the noise of the sharp image. With a free scale,
    /// a registration from a coarse level may shrink the cloud onto a few pixels, where it fits easily.
    fn register_scale_last(
        &mut self,
        pair: &ViewPair,
        start: &Similarity,
        options: &PhotometricOptions,
    ) -> Result<PhotometricReport> {
        let near = self.photometric.register(&self.sharp.problem(pair, true, self.near), start, options)?;
        let options = PhotometricOptions { first_level: 0, annealing: false, ..*options };
        self.photometric.register(&self.sharp.problem(pair, is_scale_held(pair), self.near), &near.pose, &options)
    }

    /// A step of a candidate's registration; `anew` states that it is the first. Near an initial pose the registration
    /// begins with a slightly blurred image. There are many candidates close together, and in a strongly blurred image
    /// all would end in one place.
    pub fn step_candidate(&mut self, pair: &ViewPair, start: &Similarity, anew: bool) -> Attempt {
        let first_level = if self.near.is_some() { FIRST_LEVEL_NEAR } else { options(pair).first_level };
        self.step_from(pair, start, first_level, anew)
    }

    /// A step of a candidate's registration that begins at a given level of the image.
    pub fn step_from(&mut self, pair: &ViewPair, start: &Similarity, first_level: usize, anew: bool) -> Attempt {
        let outcome = if anew { self.begin(pair, start, first_level).map(|()| None) } else { self.advance(pair) };
        match outcome {
            Ok(None) => Attempt::Ongoing,
            outcome => {
                let found = outcome.ok().flatten();
                Attempt::Ended(found.filter(|found| gauge::growth(pair, &found.pose, start) < COLLAPSE).map(Box::new))
            }
        }
    }

    /// Runs all steps of a candidate's registration.
    pub fn register_candidate(&mut self, pair: &ViewPair, start: &Similarity) -> Option<Box<PhotometricReport>> {
        let mut attempt = self.step_candidate(pair, start, true);
        while matches!(attempt, Attempt::Ongoing) {
            attempt = self.step_candidate(pair, start, false);
        }
        let Attempt::Ended(found) = attempt else { return None };
        found
    }

    /// Registers a candidate by few points.
    pub fn register_roughly(
        &mut self,
        pair: &ViewPair,
        start: &Similarity,
        most_points: usize,
    ) -> Option<Box<PhotometricReport>> {
        let options = PhotometricOptions { most_points, jackknife: false, ..options(pair) };
        let problem = self.sharp.problem(pair, is_scale_held(pair), self.near);
        let found = self.photometric.register(&problem, start, &options).ok()?;
        Some(found).filter(|found| gauge::growth(pair, &found.pose, start) < COLLAPSE).map(Box::new)
    }

    /// The photometric report of a pose that stays as it is, with the light fitted to it.
    pub fn judge(&mut self, pair: &ViewPair, pose: &Similarity) -> Option<Box<PhotometricReport>> {
        let options =
            PhotometricOptions { most_points: CANDIDATE_POINTS, first_level: 0, jackknife: false, ..options(pair) };
        let problem = self.sharp.problem(pair, is_scale_held(pair), self.near);
        self.photometric.begin(&problem, pose, &options).ok()?;
        self.photometric.report(&problem).ok().map(Box::new)
    }

    /// Registers relief scaled by `unit`, on the points that take part, in at most this many rounds.
    pub fn register_relief(
        &mut self,
        pair: &ViewPair,
        pose: &Similarity,
        unit: f32,
        most_rounds: usize,
    ) -> Option<PhotometricReport> {
        let (mut points, mut normals) = (pair.depth.points.clone(), self.sharp.normals.clone());
        let middle = pair.depth.points.centroid().z as f32;
        for index in self.photometric.points() {
            points.z[index] = middle + unit * (points.z[index] - middle);
            let [x, y, z] = normals.get(index);
            let length = (unit * unit * (x * x + y * y) + z * z).sqrt();
            normals.set(index, [unit * x, unit * y, z].map(|part| part / length));
        }
        let options = PhotometricOptions {
            first_level: 0,
            annealing: false,
            most_rounds,
            points_stay: true,
            jackknife: false,
            ..PhotometricOptions::default()
        };
        let problem = self.sharp.problem(pair, is_scale_held(pair), self.near);
        let problem = PhotometricProblem { points: &points, normals: &normals, ..problem };
        self.photometric.register(&problem, pose, &options).ok()
    }

    fn begin(&mut self, pair: &ViewPair, start: &Similarity, first_level: usize) -> Result<()> {
        // Near an initial pose the sigmas decide between this pose and that from silhouettes.
        let jackknife = self.near.is_some();
        let options = PhotometricOptions { most_points: CANDIDATE_POINTS, first_level, jackknife, ..options(pair) };
        self.photometric.begin(&self.sharp.problem(pair, is_scale_held(pair), self.near), start, &options)
    }

    /// One step, or the report once no step is left; the report takes about as long as a step.
    fn advance(&mut self, pair: &ViewPair) -> Result<Option<PhotometricReport>> {
        let problem = self.sharp.problem(pair, is_scale_held(pair), self.near);
        if self.photometric.is_done() {
            return self.photometric.report(&problem).map(Some);
        }
        self.photometric.step(&problem).map(|_| None)
    }
}

/// Whether a registration of all points ended in `pose`. t_z may have changed since, because it is a gauge.
pub fn ended_in(found: &PhotometricReport, pose: &Similarity) -> bool {
    let free = |pose: &Similarity| (pose.scale, pose.rotation, pose.translation.xy());
    !found.sampled && free(&found.pose) == free(pose)
}

/// The error for an object that moved so far away or so close that only a few pixels are compared.
fn collapsed() -> Error {
    Error::new(ErrorKind::Degenerate, "start", "the image moves the object too far along the line of sight")
}

fn options(pair: &ViewPair) -> PhotometricOptions {
    PhotometricOptions { annealing: pair.options.annealing, ..PhotometricOptions::default() }
}

fn is_scale_held(pair: &ViewPair) -> bool {
    gauge::held_scale(pair).is_some()
}
