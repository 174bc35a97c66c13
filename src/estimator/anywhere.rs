//! Pose from anywhere: the opening search, the registration by colours, and when to doubt their answer.

use super::{Estimator, Finding, Given, Joint, Look, Opening, Outcome, Task, gauge, memory};
use crate::error::{Error, ErrorKind, Result};
use crate::light::LightPrior;
use crate::options::{LightSource, Options, Registration};
use crate::pose::{ImageGrid, PhotometricReport, Search, SearchProblem, Similarity};
use crate::report::Status;
use crate::text::Fixed;
use crate::view::{ColourView, DepthView};

/// A rotation less certain than this about any axis is no answer, degrees (one sigma). Found poses of the random scenes
/// stay below 3.
const LARGEST_SIGMA: f64 = 5.0;
/// A rotation less certain than this about any axis is not observable at all, degrees (one sigma).
const UNOBSERVABLE: f64 = 30.0;
/// A rotation less certain than this is no single answer, degrees (one sigma): two sigmas pass the three degrees within
/// which a pose counts as found. One in 300 random scenes is so uncertain, and all photographs that end over 4 degrees
/// off are, by 2.2 or more.
const DOUBTFUL_SIGMA: f64 = 1.5;
/// Growth of the scale beyond which, or below whose inverse, a registration has collapsed: shrunk onto a few pixels a
/// cloud is easily explained. The search looks from 0.7 to 1.4.
const LARGEST_GROWTH: f64 = 2.0;
/// Share of the colours' spread that a trusted pose may leave unexplained. Renders leave 0.01 to 0.1.
const LARGEST_UNEXPLAINED: f64 = 0.3;
/// Share of the points within the robust scale that a trusted pose has at least.
const FEWEST_INLIERS: f64 = 0.4;

impl Estimator {
    /// The registration that this pair asks for: noisy depth is found by its colours and settled by its surface.
    pub(super) fn registration(&self) -> Registration {
        let settled_by_surface = |joint: &Joint| joint.is_coarse(&self.options.light) && joint.found().is_some();
        match self.options.registration {
            Registration::Joint if self.joint.as_ref().is_some_and(settled_by_surface) => Registration::Icp,
            asked => asked,
        }
    }

    /// What the registration by colours has found, where light and pose are its own.
    pub(super) fn colours_found(&self) -> Option<&PhotometricReport> {
        self.joint.as_ref().filter(|joint| !joint.is_coarse(&self.options.light)).and_then(Joint::found)
    }

    /// One slice of the opening search.
    pub(super) fn search(&mut self) -> Result<()> {
        let Self { image, depth, prior, options, grid, opening, joint, .. } = self;
        let given = given(image, depth, prior, options);
        let joint = joint.as_mut().ok_or_else(|| nowhere("the search has no registration"))?;
        let Some(opening) = opening else {
            // Each view's preparation is a slice of its own.
            match grid.take() {
                None => *grid = Some(ImageGrid::new(image)?),
                Some(grid) => *opening = Some(Opening::new(&given, search(&given, grid, options, joint)?)),
            }
            self.report.message = Some("0 %: preparing the search".into());
            return Ok(());
        };
        match opening.advance(joint, &given) {
            Look::Ongoing(share, what) => {
                self.report.message = Some(format!("{} %: {what}", Fixed(100.0 * share, 0)));
                Ok(())
            }
            Look::Done(outcome) => {
                self.opening = None;
                let outcome = outcome.ok_or_else(|| {
                    nowhere(match gauge::held_scale(image, options) {
                        Some(_) => "no pose explains the colours by the depth map's normals",
                        None => {
                            "no pose explains the colours by the depth map's normals at 0.7 to 1.4 times the scale \
                             that the units give; `scale` or `start.scale` takes another one"
                        }
                    })
                })?;
                self.open(outcome);
                Ok(())
            }
        }
    }

    /// How many [`Helper`](super::Helper)s may work beside this estimator within the memory of a pair.
    #[must_use]
    pub fn helpers_afforded(&self) -> u32 {
        memory::helpers_afforded(self.image.size, self.depth.size)
    }

    /// A part of the opening search for a [`Helper`](super::Helper) elsewhere; `None` while there is none to give away.
    /// Whatever scouts do or fail to do, steps go on and the outcome is the same.
    pub fn take_task(&mut self) -> Option<Task> {
        self.opening.as_mut()?.take()
    }

    /// Takes in what a scout has found. What is no longer needed is passed over.
    pub fn accept(&mut self, finding: Finding) {
        if let Some(opening) = &mut self.opening {
            opening.accept(finding);
        }
    }

    /// Starts the loop from what the search found.
    fn open(&mut self, Outcome { best, rivals }: Outcome) {
        self.adopt(&best);
        if let Some(joint) = &mut self.joint {
            joint.adopt(*best);
        }
        self.report.message = Some(match rivals.len() {
            0 => "100 %: one pose explains the colours best".into(),
            count => format!("100 %: {count} other poses explain the colours as well"),
        });
        self.report.rivals = rivals;
        self.report.pose = self.solution.pose;
        self.update_correspondences();
        self.kept.keep(&self.solution);
        self.measure();
    }

    /// Pose and light together from the colours.
    pub(super) fn register_colours(&mut self, start: &Similarity) -> Result<()> {
        let Self { image, depth, prior, options, joint, .. } = self;
        let Some(joint) = joint else { return Ok(()) };
        let found = joint.register(&given(image, depth, prior, options), start)?.clone();
        if found.pose.growth_from(start) > LARGEST_GROWTH.ln() {
            let message = "the colours pull the scale away from the start's: their ratio must stay between 0.5 and 2";
            return Err(nowhere(message).value(found.pose.scale / start.scale));
        }
        self.adopt(&found);
        Ok(())
    }

    fn adopt(&mut self, found: &PhotometricReport) {
        // t_z of an orthographic image is a gauge that the loop has settled already.
        let depth = self.solution.pose.translation.z;
        self.solution.pose = found.pose;
        if self.image.camera.is_orthographic() {
            self.solution.pose.translation.z = depth;
        }
        self.solution.light = found.light;
        // Normals that noise has flattened mislead about the exposure; the stages find it anew.
        if self.joint.as_ref().is_none_or(|joint| !joint.is_coarse(&self.options.light)) {
            self.solution.exposure = found.exposure;
        }
        self.report.uncertainty = Some(found.uncertainty.clone());
    }

    /// Turns the end of the loop into "ambiguous" or "lost" where the answer can't be trusted.
    pub(super) fn doubt(&mut self) {
        if let Some(reason) = self.reason_to_doubt() {
            self.end(Status::Lost, reason);
        } else if !self.report.rivals.is_empty() {
            let nearest = self.report.rivals.iter().map(|rival| rival.degrees_to(&self.report.pose));
            let nearest = nearest.fold(f64::INFINITY, f64::min);
            let count = self.report.rivals.len();
            self.end(
                Status::Ambiguous,
                format!(
                    "{count} other poses explain the colours as well, the nearest {} degrees away",
                    Fixed(nearest, 0)
                ),
            );
        } else if let Some(sigma) = self.largest_sigma().filter(|&sigma| sigma > DOUBTFUL_SIGMA) {
            let weakest = self.report.uncertainty.as_ref().map_or("", |uncertainty| &uncertainty.weakest);
            let message = format!("the rotation is uncertain by {} degrees (one sigma): {weakest}", Fixed(sigma, 1));
            self.end(Status::Ambiguous, message);
        }
    }

    /// Of the rotation that the colours have found, degrees.
    fn largest_sigma(&self) -> Option<f64> {
        let found = self.colours_found()?;
        Some(found.uncertainty.rotation_degrees.into_iter().fold(0.0, f64::max))
    }

    fn reason_to_doubt(&self) -> Option<String> {
        let found = self.colours_found()?;
        let uncertainty = &found.uncertainty;
        let sigma = uncertainty.rotation_degrees.into_iter().fold(0.0, f64::max);
        if sigma.is_nan() || sigma > UNOBSERVABLE {
            return Some(format!(
                "{} is not observable: as far as the noise lets see, changing it changes no colour",
                uncertainty.weakest
            ));
        }
        if sigma > LARGEST_SIGMA {
            return Some(format!("the rotation is uncertain by {} degrees: {}", Fixed(sigma, 0), uncertainty.weakest));
        }
        let unexplained = found.noise / self.image.log_spread();
        if unexplained.is_nan() || unexplained > LARGEST_UNEXPLAINED {
            let share = Fixed(100.0 * unexplained, 0);
            return Some(format!("light and normals leave {share} % of the colours' spread unexplained"));
        }
        let share = Fixed(100.0 * found.inliers, 0);
        (found.inliers < FEWEST_INLIERS).then(|| format!("only {share} % of the points agree with the pose"))
    }
}

/// What registrations by colours look at.
pub(super) fn given<'a>(
    image: &'a ColourView,
    depth: &'a DepthView,
    prior: &'a LightPrior,
    options: &'a Options,
) -> Given<'a> {
    let light = match &options.light {
        LightSource::Known(light) => Some(light),
        LightSource::Estimate => None,
    };
    let scale_is_held = gauge::held_scale(image, options).is_some();
    let has_prior = options.weights.light > 0.0;
    Given { image, depth, prior, has_prior, light, scale_is_held, annealing: options.annealing }
}

/// The search of a pair, by the normals that registrations go by.
pub(super) fn search(given: &Given<'_>, grid: ImageGrid, options: &Options, joint: &Joint) -> Result<Search> {
    let Given { image, depth, light, .. } = *given;
    let (scale, unit_scale) = (gauge::held_scale(image, options), gauge::unit_scale(image, depth));
    let (normals, seed) = (joint.normals(), options.seed);
    Search::with_grid(&SearchProblem { image, depth, normals, light, scale, unit_scale, seed }, grid)
}

fn nowhere(message: &'static str) -> Error {
    Error::new(ErrorKind::Degenerate, "start", message)
}
