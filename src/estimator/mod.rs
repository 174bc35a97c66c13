//! Algorithm 1: one iteration, stage by stage.
//!
//! light (Eq. 2) -> shading (Eq. 6 to 9) -> surface -> registration (Eq. 12 to 16) -> refinement (Eq. 17 to 19),
//! until the rotation settles. After each iteration the merit l + f + g of the new solution is compared with that of
//! the last one over the same depth points; a worse iteration is taken back, and the next one goes half the way.
//!
//! Where nothing is known of the pose, [`opening`] comes first: a search in slices, then registrations of its best
//! candidates by their colours. The joint registration has a cost of its own, so the merit never takes back a pose that
//! it moves.

mod anywhere;
mod gauge;
mod helper;
mod joint;
mod memory;
mod merit;
mod opening;
mod partner;
mod solution;
mod stages;
mod task;

use nalgebra::Vector3;

use crate::error::{Error, ErrorKind, Result};
use crate::light::{Light, LightFitter, LightPrior};
use crate::numeric::evenly_spread;
use crate::options::{LightSource, Options, Registration, Shading, Start};
use crate::pose::{Correspondences, Icp, ImageGrid, Similarity};
use crate::report::{Energy, Stage, Status, StepReport};
use crate::shape::{ImageShapeSolver, Refiner, STARTS, Scratch};
use crate::text::Fixed;
use crate::view::{ColourImage, ColourView, DepthMap, DepthView, Normals, Size};
pub use helper::Helper;
use joint::{Given, Joint};
use merit::Candidate;
use opening::{Look, Opening, Outcome};
use partner::Outlook;
pub use partner::RefinementTask;
use solution::{Kept, Solution};
pub use task::{Finding, Task};

/// Which surface [`Estimator::points`] returns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// The surface found in the image.
    Image,
    /// The refined depth view, carried by the pose.
    Depth,
}

/// Distance of the jury of the merit from the border of the mask, image pixels.
const JURY_MARGIN: f32 = 1.5;
/// Rejected iterations in a row after which nothing new is to be expected.
const MOST_REJECTIONS: u32 = 6;
/// Without a moving pose the loop has converged when the energy changes by less than this share.
const SETTLED_ENERGY: f64 = 1e-3;
/// Iterations after which shapes under a pose that stands have come as far as they will: they flicker by some tenths of
/// a percent.
const MOST_STILL: u32 = 8;
/// Overlap (share of valid depth pixels) below which a pose cannot be trusted.
const LEAST_OVERLAP: f64 = 0.05;
/// Fewer correspondences than this determine nothing.
const FEWEST_PAIRS: usize = 12;
/// Iterations before convergence is believed: the first has no predecessor.
const FIRST_VERDICT: u32 = 2;

/// The loop with all its memory. One value works on one pair of views.
///
/// ```
/// use bimodal_stereo::{scenes, Estimator, LightSource, Options, Status};
///
/// let relief = scenes::surface("bust")?;
/// let request = scenes::SampleRequest { light: scenes::light("colourful")?, ..Default::default() };
/// let sample = scenes::Scene::new(&relief)?.sample(&request)?;
/// let options = Options { light: LightSource::Known(sample.light), ..Options::default() };
/// let mut estimator = Estimator::new(sample.colour_image(), &sample.depth_map(), options)?;
/// while estimator.report().status == Status::Running {
///     estimator.step();
/// }
/// assert!(estimator.report().pose.degrees_to(&sample.pose) < 1.0);
/// # Ok::<(), bimodal_stereo::Error>(())
/// ```
pub struct Estimator {
    image: ColourView,
    depth: DepthView,
    options: Options,
    prior: LightPrior,
    /// The solution that the stages work on.
    solution: Solution,
    /// What was kept of the last iteration that was.
    kept: Kept,
    /// Depth points with a correspondence in `kept`.
    kept_points: Vec<u32>,
    correspondences: Correspondences,
    fitter: LightFitter,
    shape: ImageShapeSolver,
    icp: Icp,
    /// Only where the options ask for it: it holds splines of the image.
    joint: Option<Joint>,
    /// The image as the opening search will look at it, until that begins.
    grid: Option<ImageGrid>,
    opening: Option<Opening>,
    /// Points of ICP's pairs: depth view, image.
    paired_points: [Vec<Vector3<f64>>; 2],
    refiner: Refiner,
    outlook: Outlook,
    scratch: Scratch,
    /// Normals of the depth view at the image pixels, colour view's frame.
    carried_normals: Normals,
    residual: Vec<f32>,
    /// Share of the registration's step that is taken; halves with each rejection.
    trust: f64,
    rejections: u32,
    /// Iterations in a row whose registration moved nothing.
    still: u32,
    /// Exposure of the first look at the colours.
    first_exposure: f64,
    /// Median log residual that the fitted light leaves; zero for a known light.
    unexplained: f64,
    /// Whether the registration proposed nothing better than the pose it started from.
    refused: bool,
    /// The registration's own change of rotation, degrees, before it was shortened.
    proposed_change: f64,
    next: Stage,
    report: StepReport,
}

impl Estimator {
    /// Checks both views and the options, and prepares iteration zero.
    ///
    /// # Errors
    /// Any [`Error`] of the views or the options, naming the field.
    pub fn new(image: ColourImage, depth: &DepthMap, options: Options) -> Result<Self> {
        let (image, depth) = views(image, depth, &options)?;
        Self::from_views(image, depth, options)
    }

    fn from_views(image: ColourView, depth: DepthView, options: Options) -> Result<Self> {
        let prior = LightPrior::natural();
        let pose = gauge::first_pose(&image, &depth, &options);
        let light = match options.light {
            LightSource::Known(light) => light,
            LightSource::Estimate => prior.mean(),
        };
        // What takes much memory only while it is made comes first.
        let registers_colours = options.start == Start::Search || options.registration == Registration::Joint;
        let joint = registers_colours.then(|| Joint::new(&anywhere::given(&image, &depth, &prior, &options)));
        let refiner = Refiner::new(&depth, &image)?;
        let shape = match options.shading {
            Shading::Surface => ImageShapeSolver::as_a_whole(&image)?,
            Shading::Pixel => ImageShapeSolver::by_integration(),
        };
        let (pixels, points) = (image.size.len(), depth.size.len());
        let domains = [refiner.domain(), shape.domain().unwrap_or(refiner.domain())];
        let mut estimator = Self {
            scratch: Scratch::new(pixels.max(points), &domains),
            solution: Solution::new(&image, &depth, pose, light),
            kept: Kept::new(pose, light),
            kept_points: Vec::with_capacity(merit::MOST_JURORS),
            correspondences: Correspondences::new(&image, &depth),
            fitter: LightFitter::default(),
            shape,
            icp: Icp::new(),
            joint,
            grid: None,
            opening: None,
            paired_points: [Vec::new(), Vec::new()],
            refiner,
            outlook: Outlook::new(points),
            carried_normals: Normals::missing(pixels),
            residual: vec![f32::NAN; pixels],
            trust: 1.0,
            rejections: 0,
            still: 0,
            first_exposure: 0.0,
            unexplained: 0.0,
            refused: false,
            proposed_change: 0.0,
            next: if options.start == Start::Search { Stage::Search } else { Stage::Light },
            report: StepReport::at(pose),
            image,
            depth,
            options,
            prior,
        };
        estimator.prepare()?;
        Ok(estimator)
    }

    /// Starts again from iteration zero with other options on the same views.
    ///
    /// # Errors
    /// [`ErrorKind::Range`] for a bad option, [`ErrorKind::Unsupported`] where `trim` differs: it belongs to the views.
    pub fn reset(&mut self, options: Options) -> Result<()> {
        options.validate()?;
        if options.trim != self.options.trim {
            return Err(Error::new(
                ErrorKind::Unsupported,
                "options.trim",
                "is applied when the views are read; make a new estimator to change it",
            ));
        }
        *self = Self::from_views(self.image.clone(), self.depth.clone(), options)?;
        Ok(())
    }

    /// One iteration, the rest of one that was begun by [`step_stage`](Self::step_stage), or a slice of the opening
    /// search. Changes nothing once the status is no longer [`Status::Running`].
    pub fn step(&mut self) -> &StepReport {
        if self.is_searching() {
            return self.step_stage();
        }
        let iteration = self.report.iteration;
        while self.report.status == Status::Running && self.report.iteration == iteration {
            self.step_stage();
        }
        &self.report
    }

    /// Whether the next step is a slice of the opening search.
    #[must_use]
    pub fn is_searching(&self) -> bool {
        self.next == Stage::Search
    }

    /// One stage of an iteration, or a slice of the opening search.
    pub fn step_stage(&mut self) -> &StepReport {
        if self.report.status != Status::Running {
            return &self.report;
        }
        let stage = self.next;
        self.report.stage = stage;
        let outcome = match stage {
            Stage::Search => self.search(),
            Stage::Light => self.fit_light(),
            Stage::Shading => self.shade(),
            Stage::Surface => self.raise_surface(),
            Stage::Registration => self.register(),
            Stage::Refinement => {
                self.refine();
                self.finish_iteration();
                Ok(())
            }
        };
        if let Err(error) = outcome {
            self.end(Status::Lost, error.to_string());
        }
        let searching = stage == Stage::Search && (self.grid.is_some() || self.opening.is_some());
        self.next = if searching { stage } else { stage.next() };
        &self.report
    }

    /// What the last stage left.
    #[must_use]
    pub fn report(&self) -> &StepReport {
        &self.report
    }

    /// Normals of the image surface, colour view's frame, NaN off the mask.
    #[must_use]
    pub fn image_normals(&self) -> &Normals {
        &self.solution.image_normals
    }

    /// Depth of the image surface, NaN off the mask; pixels with median zero for an orthographic image.
    #[must_use]
    pub fn image_depth(&self) -> &[f32] {
        &self.solution.image_points.z
    }

    /// Refined normals of the depth view, its own frame.
    #[must_use]
    pub fn depth_normals(&self) -> &Normals {
        &self.solution.depth_normals
    }

    /// Refined depth of the depth view, holes filled.
    #[must_use]
    pub fn refined_depth(&self) -> &[f32] {
        &self.solution.depth_points.z
    }

    /// For each image pixel the index of its depth pixel, or -1.
    #[must_use]
    pub fn correspondence(&self) -> &[i32] {
        self.correspondences.depth_of_pixel()
    }

    /// |log S - predicted| of each image pixel, NaN off the mask: predicted from the measured normal of the depth view
    /// where it reaches, from the image's own normal elsewhere.
    #[must_use]
    pub fn residual(&self) -> &[f32] {
        &self.residual
    }

    /// The light, known or estimated. The exposure of a known light is [`exposure`](Self::exposure).
    #[must_use]
    pub fn light(&self) -> Light {
        self.solution.light
    }

    /// Offset of log S on top of [`light`](Self::light).
    #[must_use]
    pub fn exposure(&self) -> f64 {
        self.solution.exposure
    }

    /// The checked colour view.
    #[must_use]
    pub fn image(&self) -> &ColourView {
        &self.image
    }

    /// The checked depth view.
    #[must_use]
    pub fn depth(&self) -> &DepthView {
        &self.depth
    }

    /// Points of a surface in the colour view's frame: x, y, z of each valid pixel in turn.
    #[must_use]
    pub fn points(&self, surface: Surface) -> Vec<f32> {
        match surface {
            Surface::Image => {
                let points = &self.solution.image_points;
                (0..points.len()).filter(|&i| points.is_valid(i)).flat_map(|i| points.get(i)).collect()
            }
            Surface::Depth => {
                let valid = (0..self.depth.size.len()).filter(|&i| self.solution.depth_points.is_valid(i));
                valid.flat_map(|i| <[f64; 3]>::from(self.solution.carried(i)).map(|value| value as f32)).collect()
            }
        }
    }

    /// The working solution under `light`, its own.
    fn candidate<'a>(&'a self, light: &'a Light) -> Candidate<'a> {
        let solution = &self.solution;
        Candidate {
            pose: &solution.pose,
            light,
            normals: &solution.image_normals,
            points: &solution.image_points,
            depth_points: &solution.depth_points,
            pixel_length: self.pixel_length(),
        }
    }

    /// Compares the new solution with the kept one, keeps the better, and decides whether the loop goes on.
    fn finish_iteration(&mut self) {
        self.report.iteration += 1;
        let first = self.report.iteration == 1;
        if first {
            self.list_points();
        }
        let light = self.solution.exposed_light();
        let energy = self.energy(&light);
        // Since it was measured neither the kept solution nor its points have changed.
        let before = if first { None } else { Some(self.report.energy) };
        let change = self.kept.pose.degrees_to(&self.solution.pose);
        // The joint registration has a cost of its own: a pose that it moves is not for the merit to take back.
        let judged = self.registration() != Registration::Joint || change < self.options.stop_degrees;
        let rejected = judged && before.is_some_and(|before| merit::worsens(before.total(), energy.total(), change));
        self.report.message = None;
        if let (true, Some(before)) = (rejected, before) {
            self.reject(before, energy);
        } else {
            self.report.rotation_change = change;
            self.rejections = if self.refused { self.rejections + 1 } else { 0 };
            if self.refused {
                self.report.message = Some("the registration found no pose better than the present one".into());
            }
            self.keep();
            // Over its own points.
            self.report.energy = self.energy(&light);
        }
        self.report.pose = self.kept.pose;
        self.measure();
        self.decide(rejected, before);
        self.trust = if rejected { 0.5 * self.trust } else { (2.0 * self.trust).min(1.0) };
        self.look_ahead();
    }

    /// Energy of the working solution over the points that were kept.
    fn energy(&self, light: &Light) -> Energy {
        merit::energy(&self.image, &self.depth, &self.kept_points, self.candidate(light))
    }

    /// Takes the iteration back.
    fn reject(&mut self, before: Energy, after: Energy) {
        self.rejections += 1;
        self.solution.restore(&self.kept, &self.image, &self.depth);
        self.outlook.change();
        self.update_correspondences();
        self.report.rotation_change = 0.0;
        self.report.message = Some(format!(
            "iteration taken back: the merit would have risen from {} to {}; the next one goes half as far",
            Fixed(before.total(), 4),
            Fixed(after.total(), 4)
        ));
    }

    /// Makes the new solution the one to beat.
    fn keep(&mut self) {
        self.kept.keep(&self.solution);
        self.list_points();
    }

    /// The jury of the next comparison, from the present correspondences.
    fn list_points(&mut self) {
        let mut points = std::mem::take(&mut self.kept_points);
        points.clear();
        points.extend(self.jury());
        self.kept_points = points;
    }

    /// Depth points that have a correspondence and a measured normal. Those near the border of the mask stay out: they
    /// would enter and leave it with every small step.
    fn jury(&self) -> impl Iterator<Item = u32> {
        let (image, depth) = (&self.image, &self.depth);
        let [columns, rows] = self.correspondences.position();
        let inside = move |index: usize| {
            [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]].iter().all(|[right, down]| {
                let column = columns[index] + JURY_MARGIN * right;
                let row = rows[index] + JURY_MARGIN * down;
                !image.size.bilinear(&image.log[0], column, row).is_nan()
            })
        };
        let jury = evenly_spread(merit::MOST_JURORS, || self.correspondences.visible_points());
        jury.filter(move |&index| depth.normals.is_valid(index) && inside(index)).map(|index| index as u32)
    }

    fn decide(&mut self, rejected: bool, before: Option<Energy>) {
        self.still = if self.proposed_change < self.options.stop_degrees { self.still + 1 } else { 0 };
        let registration = self.registration();
        let first_verdict = match self.options.shading {
            Shading::Pixel => FIRST_VERDICT,
            Shading::Surface => STARTS,
        };
        let steady = before.is_some_and(|before| {
            let change = (self.report.energy.total() - before.total()).abs();
            change < SETTLED_ENERGY * before.total().max(f64::MIN_POSITIVE)
        });
        let settled = match registration {
            _ if before.is_none() => false,
            Registration::Fixed => steady && !rejected,
            // Shapes that get no better have settled, too.
            Registration::Joint => self.still > 0 && (steady || rejected || self.still >= MOST_STILL),
            Registration::Icp => {
                self.proposed_change < self.options.stop_degrees && self.trust >= 1.0 && !self.refused && !rejected
            }
        };
        if self.correspondences.count() < FEWEST_PAIRS || self.report.overlap < LEAST_OVERLAP {
            let share = Fixed(100.0 * self.report.overlap, 1);
            self.end(Status::Lost, format!("only {share} % of the depth pixels have a counterpart in the image"));
        } else if settled && self.report.iteration >= first_verdict {
            self.conclude();
        } else if rejected && registration == Registration::Fixed {
            // With the pose held the next iteration would be this one again.
            self.end(Status::MaxIterations, "another iteration would worsen the shapes under this pose".into());
        } else if self.rejections >= MOST_REJECTIONS {
            let message =
                format!("{MOST_REJECTIONS} iterations in a row brought no better pose: none lowers the merit any more");
            self.end(Status::MaxIterations, message);
        } else if self.report.iteration >= self.options.max_iterations {
            self.end(
                Status::MaxIterations,
                format!("the cap of {} iterations was reached", self.options.max_iterations),
            );
        }
        if self.report.status == Status::MaxIterations {
            self.doubt();
        }
    }

    /// The loop has settled: converged, unless there is reason to doubt.
    fn conclude(&mut self) {
        self.report.status = Status::Converged;
        // What became of the last iteration is no news once the answer stands.
        self.report.message = None;
        self.doubt();
    }

    fn end(&mut self, status: Status, message: String) {
        self.report.status = status;
        self.report.message = Some(message);
    }

    /// The pose of the working solution, for stages that look at it.
    fn pose(&self) -> Similarity {
        self.solution.pose
    }
}

/// Both views, checked, with the options and the memory that they ask for.
fn views(image: ColourImage, depth: &DepthMap, options: &Options) -> Result<(ColourView, DepthView)> {
    options.validate()?;
    memory::check(Size::new("image", image.width, image.height)?, Size::new("depth", depth.width, depth.height)?)?;
    Ok((ColourView::new(image)?, DepthView::new(depth, options.trim)?))
}
