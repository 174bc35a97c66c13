//! Algorithm 1: iterations, stage by stage.
//!
//! light (Eq. 2) -> shading (Eq. 6 to 9) -> surface -> registration (Eq. 12 to 16) -> refinement (Eq. 17 to 19), until
//! the rotation settles. After each iteration, the objective l + f + g (Eq. 1) of the new solution is compared with
//! that of the last accepted one over the same depth points. A worse iteration is rejected, and the next one takes half
//! the registration's step.
//!
//! If nothing is known about the pose, the [`finder`] runs first. If an initial pose does not explain the image, it
//! searches around that pose within the first iteration. Photometric registration has its own objective, so the loop
//! never takes back a pose that it moved.
//!
//! Each stage owns its memory, and its signature shows what it reads and writes ([`stages`]). This file holds the order
//! in which they run, [`ending`] the end of an iteration and of the run, [`reporting`] what it reports. The [`decision`]
//! of the finder names the method that the pose rests on; the stages, the verdict and the report follow it.

mod checks;
mod contrasted;
mod decision;
mod ending;
mod finder;
mod gauge;
mod memory;
mod objective;
mod pair;
mod photometric;
mod reporting;
mod run;
mod searching;
mod solution;
mod stages;
#[cfg(feature = "rayon")]
mod threads;
mod workers;

use crate::error::{Error, ErrorKind, Result};
use crate::options::{Options, Registration, Shading, Start};
use crate::pose::{Correspondences, Similarity};
use crate::reason::Reason;
use crate::report::{Stage, Status, StepReport};
use crate::shape::Scratch;
use crate::view::{ColourImage, DepthMap};
use ending::settling::{self, Settling};
use finder::HalvedPair;
use finder::initial_pose::first_pose;
pub use finder::task::{Finding, Task};
use pair::ViewPair;
use reporting::measurement::PixelResiduals;
pub use reporting::outputs::Surface;
use reporting::reported::Reported;
use run::{History, Run};
use solution::{Accepted, Solution};
pub use stages::RefinementTask;
use stages::{
    AlbedoStage, Inputs, LightStage, RefinementStage, Registered, Registering, RegistrationStage, ShapeStage, Stages,
};
pub use workers::Worker;

/// The loop with all its memory. An estimator works on one pair of views.
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
    pair: ViewPair,
    run: Run,
    stages: Stages,
    correspondences: Correspondences,
    residuals: PixelResiduals,
    /// Memory that the stages share.
    scratch: Scratch,
    /// The working solution of this iteration.
    solution: Solution,
    /// The last accepted iteration.
    accepted: Accepted,
    history: History,
    /// Which shapes have settled and are kept.
    settling: Settling,
    report: Reported,
    /// Threads that share the work, if there are any.
    #[cfg(feature = "rayon")]
    threads: Option<Box<threads::Threads>>,
}

/// The estimator taken apart for a stage: its input, the stages that take it, and what they change.
struct Parts<'a> {
    inputs: Inputs<'a>,
    albedo: &'a AlbedoStage,
    shape: &'a mut ShapeStage,
    registration: &'a mut RegistrationStage,
    refinement: &'a mut RefinementStage,
    accepted: &'a Accepted,
    scratch: &'a mut Scratch,
    solution: &'a mut Solution,
}

impl Estimator {
    /// Checks both views and the options, and prepares iteration zero.
    ///
    /// # Errors
    /// Any [`Error`] of the views or the options, naming the field.
    pub fn new(image: ColourImage, depth: &DepthMap, options: Options) -> Result<Self> {
        Self::of(ViewPair::new(image, depth, options)?)
    }

    fn of(pair: ViewPair) -> Result<Self> {
        let pose = first_pose(&pair);
        let light = pair.known_light().copied().unwrap_or_else(|| pair.prior.mean());
        // The parts that need much more memory during construction than afterwards come first.
        let registration = RegistrationStage::new(&pair, HalvedPair::is_called_for(&pair));
        let refinement = RefinementStage::new(&pair)?;
        let shape = ShapeStage::new(&pair)?;
        let [pixels, points] = pair.lengths();
        let domains = [refinement.domain(), shape.domain().unwrap_or(refinement.domain())];
        let scratch = Scratch::new(pixels.max(points), &domains);
        let solution = Solution::new(&pair, pose, light);
        let correspondences = Correspondences::new(&pair.image, &pair.depth);
        let mut estimator = Self {
            run: if pair.options.start == Start::Search { Run::Preparing(None) } else { Run::Iterating(Stage::Light) },
            stages: Stages {
                light: LightStage::new(pixels),
                albedo: AlbedoStage::new(),
                shape,
                registration,
                refinement,
            },
            correspondences: match pair.options.shading {
                Shading::Pixel => correspondences.of_points_alone(),
                Shading::Surface => correspondences,
            },
            residuals: PixelResiduals::new(pixels),
            scratch,
            accepted: Accepted::new(&solution, objective::MOST_POINTS),
            solution,
            history: History::default(),
            settling: Settling::new(settling::TOLERANCE),
            report: Reported::new(StepReport::at(pose)),
            #[cfg(feature = "rayon")]
            threads: None,
            pair,
        };
        estimator.prepare()?;
        estimator.translate_report();
        Ok(estimator)
    }

    /// Prepares iteration zero: fills holes, places points, and finds correspondences and light under the first pose.
    fn prepare(&mut self) -> Result<()> {
        self.stages.refinement.fill_holes(&self.pair, &mut self.scratch, &mut self.solution.depth)?;
        self.solution.light.exposure = self.stages.light.find_first_exposure(&self.pair);
        self.find_correspondences();
        // Nearly flat relief does not determine a light. The prior's light stays until a pose is tried.
        self.fit_light().or_else(|error| if error.kind() == ErrorKind::Range { Ok(()) } else { Err(error) })?;
        self.accepted.accept(&self.solution);
        self.measure();
        Ok(())
    }

    /// Restarts at iteration zero with other options on the same views.
    ///
    /// # Errors
    /// [`ErrorKind::Range`] for an invalid option, [`ErrorKind::Unsupported`] if `trim` differs: it is applied to the
    /// views.
    pub fn reset(&mut self, options: Options) -> Result<()> {
        options.validate()?;
        if options.trim != self.pair.options.trim {
            return Err(Error::new(
                ErrorKind::Unsupported,
                "options.trim",
                "is applied when the views are read; make a new estimator to change it",
            ));
        }
        let next = Self::of(self.pair.with(options)?)?;
        #[cfg(feature = "rayon")]
        let next = next.with_threads_of(self);
        *self = next;
        Ok(())
    }

    /// Runs one iteration, the rest of one begun by [`step_stage`](Self::step_stage), or a slice of the finder. Changes
    /// nothing once the status is no longer [`Status::Running`].
    pub fn step(&mut self) -> &StepReport {
        #[cfg(feature = "rayon")]
        if self.step_in_threads() {
            return self.report();
        }
        if self.is_searching() {
            return self.step_stage();
        }
        let iteration = self.report.iteration;
        while self.report.status == Status::Running && self.report.iteration == iteration {
            self.step_stage();
        }
        self.report()
    }

    /// Whether the next step is a slice of the search that precedes the first iteration.
    #[must_use]
    pub const fn is_searching(&self) -> bool {
        match &self.run {
            Run::Preparing(_) => true,
            Run::Searching(finder) => !finder.is_near(),
            Run::Iterating(_) | Run::Ended => false,
        }
    }

    /// Runs one stage of an iteration, or a slice of the finder.
    pub fn step_stage(&mut self) -> &StepReport {
        let outcome = match self.run {
            Run::Preparing(_) => self.prepare_search().map_err(Reason::from),
            Run::Searching(_) => self.search(),
            Run::Iterating(stage) => self.iterate(stage),
            Run::Ended => Ok(()),
        };
        if let Err(reason) = outcome {
            self.end(Status::Lost, Some(reason));
        }
        self.translate_report();
        self.report()
    }

    /// Runs one stage of Algorithm 1, and ends the iteration after the last. Settled shapes are kept.
    fn iterate(&mut self, stage: Stage) -> std::result::Result<(), Reason> {
        self.report.stage = stage;
        self.run = Run::Iterating(stage.next());
        match stage {
            Stage::Light if !self.settling.keeps_all() => self.fit_light()?,
            Stage::Shading if !self.settling.keeps_image() => self.find_normals(),
            Stage::Surface if !self.settling.keeps_image() => self.find_surface()?,
            Stage::Search | Stage::Light | Stage::Shading | Stage::Surface => {}
            Stage::Registration => self.register()?,
            Stage::Refinement => {
                if !self.settling.keeps_depth() {
                    self.refine();
                }
                self.finish_iteration();
            }
        }
        Ok(())
    }

    /// Light (Eq. 2). The light that photometric registration found with the pose replaces the fit, and the light found
    /// with a varying albedo replaces both.
    fn fit_light(&mut self) -> Result<()> {
        self.find_albedo();
        let colours = self.stages.albedo.colours(&self.pair);
        let fitted = self.stages.light.fit(&self.pair, colours, &self.solution, &self.correspondences)?;
        if let Some(light) = fitted {
            self.solution.light.light = light;
        }
        if let Some(found) = self.stages.registration.found_photometrically() {
            (self.solution.light.light, self.solution.light.exposure) = (found.light, found.exposure);
        }
        if let Some(found) = self.stages.albedo.found() {
            self.solution.light = found.light;
        }
        Ok(())
    }

    /// Finds the albedo once the pose has settled, or if pose and albedo are found in turn, unless it is already known for
    /// this pose.
    fn find_albedo(&mut self) {
        let Solution { pose, .. } = &self.solution;
        if self.stages.registration.requires_albedo(&self.pair, pose) && !self.stages.albedo.knows(&self.pair, pose) {
            let normals = self.stages.registration.measured_normals(&self.pair);
            self.stages.light.bring_normals(&self.pair, normals, pose, &self.correspondences);
            self.stages.albedo.find(&self.pair, pose, self.stages.light.depth_normals());
        }
    }

    /// The parts for a stage of this iteration.
    fn parts(&mut self) -> Parts<'_> {
        let Self { pair, stages, correspondences, scratch, solution, accepted, report, .. } = self;
        let Stages { light, albedo, shape, registration, refinement } = stages;
        let inputs = Inputs::of(pair, albedo, light, correspondences, report.iteration);
        Parts { inputs, albedo, shape, registration, refinement, accepted, scratch, solution }
    }

    /// Normals of the image (Eq. 6 to 9), and the exposure of a known light unless the registration found it.
    fn find_normals(&mut self) {
        let exposure_is_free =
            self.pair.known_light().is_some() && self.stages.registration.found_photometrically().is_none();
        let Parts { inputs, shape, solution: Solution { light, image, .. }, .. } = self.parts();
        shape.find_normals(inputs, exposure_is_free, light, &mut image.normals);
    }

    /// Heights of the image, then the gauges that neither view determines: t_z of an orthographic image, the distance
    /// of a pinhole image's surface.
    fn find_surface(&mut self) -> Result<()> {
        let Parts { inputs, shape, scratch, solution, .. } = self.parts();
        shape.find_surface(inputs, &solution.light.total(), scratch, &mut solution.image)?;
        gauge::fix_depth_of_surface(&self.pair, &self.correspondences, &mut self.scratch.spare, &mut self.solution);
        Ok(())
    }

    /// Pose (Eq. 12 to 16), then its correspondences.
    fn register(&mut self) -> std::result::Result<(), Reason> {
        if gauge::pixel_length(&self.pair.image, &self.solution) <= 0.0 {
            return Err(Reason::BehindCamera);
        }
        let Parts { inputs, albedo, registration, solution, .. } = self.parts();
        match registration.register(inputs, albedo, solution)? {
            Registering::Done(registered) => self.finish_registration(registered.map(|registered| *registered)),
            Registering::Finding(finder) => self.find(finder),
        }
        Ok(())
    }

    /// Adopts the pose of a registration and finds its correspondences.
    fn finish_registration(&mut self, registered: Option<Registered>) {
        let start = self.solution.pose;
        (self.history.proposed_degrees, self.history.improved) = (0.0, true);
        if let Some(registered) = registered {
            self.history.improved = registered.improved;
            self.adopt(registered);
            self.history.proposed_degrees = start.degrees_to(&self.solution.pose);
            if self.stages.registration.kind(&self.pair) == Registration::Icp {
                self.shorten_step(&start);
            }
        }
        if !self.settling.keeps_all() {
            gauge::fix_depth_of_pose(&self.pair, &self.correspondences, &mut self.scratch.spare, &mut self.solution);
            self.find_correspondences();
        }
    }

    /// Adopts a pose, its uncertainty and rivals, and the light if it was found with the pose.
    fn adopt(&mut self, found: Registered) {
        self.solution.pose = found.pose;
        self.solution.light.light = found.light.unwrap_or(self.solution.light.light);
        self.solution.light.exposure = found.exposure.unwrap_or(self.solution.light.exposure);
        if let Some(mut uncertainty) = found.uncertainty {
            if !self.pair.image.camera.is_orthographic() {
                uncertainty.add_focal_length(found.pose.apply(self.pair.depth.points.centroid()).z);
            }
            self.report.uncertainty = Some(uncertainty);
        }
        self.report.rivals = found.rivals.unwrap_or_else(|| std::mem::take(&mut self.report.rivals));
    }

    /// After rejections, takes only a fraction of the step from matching surfaces. Behind a pinhole the pose keeps its
    /// scale, and the image's surface takes up the change of scale.
    fn shorten_step(&mut self, start: &Similarity) {
        let Solution { pose, image, depth, .. } = &mut self.solution;
        if self.history.step_fraction < 1.0 {
            *pose = start.towards(pose, self.history.step_fraction, depth.points.centroid());
        }
        let Some(held) = gauge::held_scale(&self.pair) else { return };
        let factor = held / pose.scale;
        if !self.pair.image.camera.is_orthographic() && factor != 1.0 {
            pose.scale = held;
            pose.translation *= factor;
            image.scale_depth(factor);
            image.place_image_points(&self.pair.image);
        }
    }

    /// Normals and depth of the depth view (Eq. 17 to 19).
    fn refine(&mut self) {
        let Parts { inputs, refinement, accepted, scratch, solution, .. } = self.parts();
        refinement.refine(inputs, accepted, scratch, solution);
    }

    /// Projects the depth points, hides the occluded ones, and drops those too far from the image surface.
    fn find_correspondences(&mut self) {
        let problem = stages::correspondence_problem(&self.pair, &self.solution);
        self.correspondences.update(&problem);
    }
}
