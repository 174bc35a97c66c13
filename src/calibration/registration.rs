//! One round of the registration: all cues over all frames at one state, and the resulting step.
//!
//! Unknowns: [`super::unknowns`]. Objective: the sum of the log likelihoods of the cues, each weighted by the ratio of
//! its curvature to the scatter of its tiles ([`Evidence::weight`]), and the prior about the initial pose. Solver:
//! Gauss-Newton, with the bound of expectation maximisation for edges and finite differences for the other cues. These
//! have a small basin of convergence and take part in the last rounds only.

use nalgebra::Vector3;

use super::cue::Cue;
use super::discontinuities::Discontinuity;
use super::edges::{EdgeField, blur};
use super::evidence::{Evidence, Traces};
use super::frame::{Frame, Projection};
use super::patches::{Patches, Sight, group};
use super::planes::Planes;
use super::surface::{self, Sample};
use super::surfaces::Surfaces;
use super::unknowns::{BIAS, FOCAL, Matrix, SIDES, State, Units, Vector, solve};

/// Sigma of edges at each level, pixels of an image 640 wide: it falls from the error that the coarse search leaves to
/// the resolution of an image. It halves every two levels.
pub(super) const SIGMAS: [f64; 4] = [4.0, 2.8, 1.9, 1.3];
/// Number of poses that proceed after each level, the best by score.
pub(super) const SURVIVORS: [usize; 4] = [10, 6, 4, 3];
/// Maximum number of depth discontinuities, over all frames, that score an initial pose.
const MOST_DISCONTINUITIES_OF_STARTS: usize = 1200;
/// Rounds at each level.
pub(super) const ROUNDS: usize = 3;
/// Maximum number of rounds with all cues. The objective is rough, so more rounds would not settle.
pub(super) const MOST_SETTLING: usize = 8;
/// Maximum number of times that a step with all cues is halved.
const MOST_HALVINGS: usize = 5;
/// Largest decrease of the log posterior with which a step is accepted. The objective is rough on the scale of a pixel,
/// and a likelihood ratio of less than e is not evidence.
const ROUGHNESS: f64 = 1.0;
/// Move of the scene, in pixels, below which a step has converged.
pub(super) const ARRIVED: f64 = 0.02;
/// Longest step of a round with all cues, pixels, up to which finite differences are valid.
const LONGEST: f64 = 3.0;
/// Blur of the image for the cues over surfaces, pixels: about the size of a pixel of the depth map.
const SURFACE_BLUR: f32 = 1.2;
/// Maximum numbers of depth discontinuities and samples, for all frames together and for a single one.
const MOST_DISCONTINUITIES: usize = 6000;
const MOST_DISCONTINUITIES_OF_ONE: usize = 1500;
const MOST_SAMPLES: usize = 24000;
const MOST_SAMPLES_OF_ONE: usize = 8000;
/// Maximum number of points, over all frames, that represent the extent of the scene.
const MOST_POINTS: usize = 3000;

/// Sigma of the prior about a candidate: rotation about the colour camera, degrees, and shift, metres. Rigs measured by
/// hand are off by this much. The check finds larger errors too if the scene shows them.
const PRIOR_DEGREES: f64 = 4.0;
const PRIOR_METRES: f64 = 0.05;
/// Share of the scene's points on the image below which a pose cannot be judged. Even fields of view that hardly
/// overlap share more points.
const LEAST_SEEN: f64 = 0.02;
/// Sigma of the edge bias that all sides share, pixels.
const PRIOR_BIAS: f64 = 1.0;
/// Sigma of the change of the edge bias from side to side, pixels, if the maker may have registered the depth map. Such
/// a registration shifts the depth edges, and no pose that is estimated from them can undo the shift.
const PRIOR_SIDES: f64 = 0.5;
/// Prior information that keeps an unknown constant.
const HELD: f64 = 1e6;
/// Sigma of ln f if the focal length is unknown.
const PRIOR_FOCAL: f64 = 0.15;

/// All frames, and the quantities that do not depend on the state.
pub(super) struct Scene {
    pub frames: Vec<Frame>,
    pub samples: Vec<Vec<Sample>>,
    /// Some points of all frames, which represent the extent of the scene.
    sparse: Vec<Vector3<f64>>,
    pub surface_planes: Vec<Planes>,
    pub cues: Vec<Cue>,
    /// Whether the focal length is estimated.
    pub focal_is_free: bool,
    /// The first image's width over 640, at least one.
    pub scale: f64,
    /// Factor on the sigmas of the prior about the pose.
    pub prior_width: f64,
}

/// A round of the registration: a state, the initial state on which the prior is centred, the sigma of edges, and the sums
/// that determine the weights of the cues.
#[derive(Clone, Copy, Debug)]
pub(super) struct Round {
    pub state: State,
    pub initial: State,
    /// The state from which the scene is seen: visible discontinuities and samples are those of this state.
    pub seen_from: State,
    pub sigma: f64,
    /// Sums over the rounds so far, by cue: the scatter of few tiles is too uncertain for the weights of a single round.
    pub traces: [Traces; Cue::ALL.len()],
}

impl Round {
    /// The first round from a state.
    pub fn from(state: State, initial: State) -> Self {
        Self { state, initial, seen_from: initial, sigma: 0.0, traces: Default::default() }
    }
}

/// The depth discontinuities and the samples that are visible from a state.
struct Seen {
    discontinuities: Vec<Vec<Discontinuity>>,
    patches: Vec<Patches>,
}

/// What a round with all cues leaves to the next one if visibility stays the same.
pub(super) struct Kept {
    seen: Seen,
    /// The curvatures of the cues over surfaces, for each frame.
    curvatures: Vec<Vec<Matrix>>,
}

/// An initial pose during its registration, with the depth discontinuities that are seen.
pub(super) struct Start {
    pub round: Round,
    pub discontinuities: Vec<Vec<Discontinuity>>,
    pub score: f64,
}

impl Start {
    /// An initial pose whose discontinuities have yet to be found.
    pub const fn at(round: Round) -> Self {
        Self { round, discontinuities: vec![], score: 0.0 }
    }
}

/// The evidence of all cues at a state.
pub(super) struct Findings {
    pub units: Units,
    pub prior: Matrix,
    /// The cues, each with its weight.
    pub cues: Vec<(Cue, Evidence, f64)>,
    pub total: Evidence,
    pub traces: [Traces; Cue::ALL.len()],
    /// Step from the initial state, on which the prior is centred, to this state.
    pub back: Vector,
}

impl Findings {
    /// The weight of each cue.
    pub fn weights(&self) -> Vec<f64> {
        self.cues.iter().map(|cue| cue.2).collect()
    }
}

impl Scene {
    pub fn new(frames: Vec<Frame>, cues: Vec<Cue>, focal_is_free: bool) -> Self {
        let scale = (frames[0].planes.size.width as f64 / 640.0).max(1.0);
        let most = MOST_SAMPLES_OF_ONE.min(MOST_SAMPLES / frames.len());
        // Edges need neither samples nor a blurred image.
        let has_surfaces = cues != [Cue::Edges];
        let samples = |frame| if has_surfaces { surface::samples(frame, most) } else { vec![] };
        let mut samples: Vec<Vec<Sample>> = frames.iter().map(samples).collect();
        samples.iter_mut().for_each(|samples| group(samples));
        let blur = if has_surfaces { SURFACE_BLUR } else { 0.0 };
        let surface_planes = frames.iter().map(|frame| frame.planes.blurred(blur)).collect();
        let sparse = frames.iter().flat_map(|frame| frame.sparse(MOST_POINTS / frames.len())).collect();
        Self { frames, samples, sparse, surface_planes, cues, focal_is_free, scale, prior_width: 1.0 }
    }

    /// Some points of all frames in the colour camera's frame.
    pub fn cloud(&self, state: &State) -> Vec<Vector3<f64>> {
        self.sparse.iter().map(|point| state.pose.apply(*point)).collect()
    }

    /// Share of the scene's points that a state projects onto the image.
    pub fn overlap(&self, state: &State) -> f64 {
        let frame = &self.frames[0];
        let camera = state.camera(&frame.camera);
        let seen = self.sparse.iter().filter(|point| {
            let pixel = camera.project(state.pose.apply(**point).into());
            pixel.is_some_and(|[x, y]| {
                let size = frame.planes.size;
                x >= 0.0 && y >= 0.0 && x < size.width as f64 && y < size.height as f64
            })
        });
        seen.count() as f64 / self.sparse.len().max(1) as f64
    }

    /// Whether a state projects enough of the scene's points onto the image for a judgement.
    pub fn is_seen(&self, state: &State) -> bool {
        self.overlap(state) >= LEAST_SEEN
    }

    pub fn units(&self, state: &State) -> Units {
        Units::new(&self.cloud(state), &state.camera(&self.frames[0].camera))
    }

    /// The images, blurred for edges of this sigma.
    pub fn planes(&self, sigma: f64) -> Vec<Planes> {
        self.frames.iter().map(|frame| frame.planes.blurred(blur(sigma) as f32)).collect()
    }

    /// Information of the prior: w and t of the candidate deviate by their sigmas, and t = v + c x w.
    pub fn prior(&self, units: &Units) -> Matrix {
        let cross = units.middle.cross_matrix();
        let mut rows = Matrix::zeros();
        let [turn, shift] = [PRIOR_DEGREES.to_radians(), PRIOR_METRES].map(|sigma| self.prior_width * sigma);
        for k in 0..3 {
            rows[(k, k)] = 1.0 / turn;
            rows[(3 + k, 3 + k)] = 1.0 / shift;
            (0..3).for_each(|j| rows[(3 + k, j)] = cross[(k, j)] / shift);
        }
        rows[(BIAS, BIAS)] = 1.0 / PRIOR_BIAS;
        let may_be_registered = self.frames.iter().any(|frame| frame.may_be_registered);
        (1..SIDES).for_each(|k| rows[(BIAS + k, BIAS + k)] = if may_be_registered { 1.0 / PRIOR_SIDES } else { HELD });
        rows[(FOCAL, FOCAL)] = if self.focal_is_free { 1.0 / PRIOR_FOCAL } else { HELD };
        let rows = rows * Matrix::from_diagonal(&units.of);
        rows.transpose() * rows
    }

    /// Maximum number of depth discontinuities of a frame.
    pub fn most_discontinuities(&self) -> usize {
        MOST_DISCONTINUITIES_OF_ONE.min(MOST_DISCONTINUITIES / self.frames.len())
    }

    fn seen(&self, state: &State) -> Seen {
        let most = self.most_discontinuities();
        let (mut discontinuities, mut patches) = (vec![], vec![]);
        for (frame, samples) in self.frames.iter().zip(&self.samples) {
            let projection = Projection::new(frame, state);
            discontinuities.push(EdgeField::discontinuities(frame, &projection, most));
            patches.push(Patches::new(samples, &projection, frame));
        }
        Seen { discontinuities, patches }
    }

    /// The cues over the surfaces of each frame, at the state of a round.
    fn surfaces<'a>(&'a self, round: &Round, seen: &'a Seen) -> Vec<Surfaces<'a>> {
        let of_frame = |((frame, planes), patches): ((&'a Frame, &'a Planes), &'a Patches)| {
            Surfaces::new(&self.cues, patches, Sight { frame, planes }, &round.state)
        };
        self.frames.iter().zip(&self.surface_planes).zip(&seen.patches).map(of_frame).collect()
    }

    /// The edges of each frame at a state, with the discontinuities that a round sees. Not inlined, to keep the .wasm file small.
    #[inline(never)]
    fn fields(&self, round: &Round, units: &Units, planes: &[Planes], seen: &[Vec<Discontinuity>]) -> Vec<EdgeField> {
        let field = |((frame, planes), discontinuities): ((&Frame, &Planes), &Vec<Discontinuity>)| {
            let moved = EdgeField::moved(frame, discontinuities, &round.seen_from, &round.state);
            EdgeField::new(Sight { frame, planes }, &moved, &round.state, units, round.sigma)
        };
        self.frames.iter().zip(planes).zip(seen).map(field).collect()
    }

    /// The log likelihood of the edges of all frames at a state, and the number of independent depth discontinuities.
    fn edges(&self, round: &Round, units: &Units, planes: &[Planes], seen: &[Vec<Discontinuity>]) -> (Evidence, f64) {
        let (mut evidence, mut count) = (Evidence::default(), 0.0);
        for field in self.fields(round, units, planes, seen) {
            evidence.shares.extend(field.shares());
            count += field.weight();
        }
        (evidence, count)
    }

    /// The share of each tile in the mean log likelihood of a depth discontinuity.
    pub fn mean_by_tile(&self, Start { round, discontinuities, .. }: &Start, planes: &[Planes]) -> Vec<f64> {
        let (evidence, count) = self.edges(round, &self.units(&round.state), planes, discontinuities);
        evidence.shares.iter().map(|share| share.value / f64::max(count, 1.0)).collect()
    }

    /// The log likelihood of each cue by tiles, with its derivatives at the state of a round.
    fn evidence(
        &self,
        round: &Round,
        units: &Units,
        planes: &[Planes],
        seen: &Seen,
        surfaces: &[Surfaces],
        curvatures: &mut [Vec<Matrix>],
    ) -> Vec<Evidence> {
        let mut evidence = vec![Evidence::default(); self.cues.len()];
        for (surfaces, curvatures) in surfaces.iter().zip(curvatures) {
            let of_frame = surfaces.shares(units, &round.state, curvatures);
            evidence.iter_mut().zip(of_frame).for_each(|(evidence, shares)| evidence.shares.extend(shares));
        }
        if let Some(edges) = self.cues.iter().position(|cue| *cue == Cue::Edges) {
            evidence[edges] = self.edges(round, units, planes, &seen.discontinuities).0;
        }
        evidence
    }

    /// The evidence of all cues at the state of a round. What edges have by chance is subtracted.
    pub fn findings(&self, round: &Round, planes: &[Planes]) -> Findings {
        self.findings_with(round, planes, vec![])
    }

    /// The evidence of all cues at the state of a round, of which only the values are right.
    pub fn values(&self, round: &Round, planes: &[Planes]) -> Findings {
        self.findings_with(round, planes, vec![Matrix::zeros(); self.cues.len()])
    }

    fn findings_with(&self, round: &Round, planes: &[Planes], curvatures: Vec<Matrix>) -> Findings {
        let seen = self.seen(&round.seen_from);
        let mut curvatures = vec![curvatures; self.frames.len()];
        let mut findings = self.findings_of(round, planes, &seen, &self.surfaces(round, &seen), &mut curvatures);
        if let Some((_, edges, _)) = findings.cues.iter_mut().find(|(cue, ..)| *cue == Cue::Edges) {
            let fields = self.fields(round, &findings.units, planes, &seen.discontinuities);
            let by_chance = fields.iter().flat_map(EdgeField::by_chance);
            edges.shares.iter_mut().zip(by_chance).for_each(|(share, by_chance)| share.value -= by_chance);
        }
        findings
    }

    fn findings_of(
        &self,
        round: &Round,
        planes: &[Planes],
        seen: &Seen,
        surfaces: &[Surfaces],
        curvatures: &mut [Vec<Matrix>],
    ) -> Findings {
        let units = self.units(&round.state);
        let mut total = Evidence::default();
        let mut cues = vec![];
        let mut traces = round.traces;
        let evidence = self.evidence(round, &units, planes, seen, surfaces, curvatures);
        for ((&cue, evidence), traces) in self.cues.iter().zip(evidence).zip(&mut traces) {
            *traces += evidence.traces();
            let trust = if cue == Cue::Edges { 1.0 } else { SURFACE_TRUST };
            let weight = trust * traces.weight();
            evidence.add_to(&mut total, weight);
            cues.push((cue, evidence, weight));
        }
        let back = units.between(&round.initial, &round.state);
        Findings { prior: self.prior(&units), units, cues, total, traces, back }
    }

    /// Log posteriors of states, with the visible samples of a round's state and the weights of its findings.
    fn posterior<'a>(
        &'a self,
        round: &'a Round,
        planes: &'a [Planes],
        seen: &'a Seen,
        surfaces: &'a [Surfaces],
        findings: &'a Findings,
    ) -> impl Fn(&State) -> f64 + 'a {
        let weights = findings.weights();
        let edges: f64 = findings.cues.iter().filter(|cue| cue.0 == Cue::Edges).map(|cue| cue.2).sum();
        move |state| {
            let moved = Round { state: *state, ..*round };
            let (evidence, _) = self.edges(&moved, &findings.units, planes, &seen.discontinuities);
            let back = findings.units.between(&round.initial, state);
            let prior = 0.5 * back.dot(&(findings.prior * back));
            let surfaces: f64 = surfaces.iter().map(|surfaces| surfaces.sum(state, &weights)).sum();
            surfaces + edges * evidence.value() - prior
        }
    }

    /// Refines an initial pose by edges alone with its depth discontinuities fixed, and updates its score.
    pub fn approach(&self, start: &mut Start, sigma: f64, planes: &[Planes]) {
        start.round.sigma = sigma;
        for _ in 0..ROUNDS {
            let state = start.round.state;
            let units = self.units(&state);
            let (evidence, count) = self.edges(&start.round, &units, planes, &start.discontinuities);
            let mean = evidence.value() / f64::max(count, 1.0);
            let mut total = Evidence::default();
            evidence.add_to(&mut total, evidence.traces().weight());
            let back = units.between(&start.round.initial, &state);
            let prior = self.prior(&units);
            start.score = mean - 0.5 * SCORE_PRIOR * back.dot(&(prior * back));
            let next = units.step(&state, &step(&total, &prior, &back));
            start.round.state = self.on_lattice(&start.round.initial, &next);
        }
    }

    /// The registration of a pose by its edges, level by level, with the images blurred for each level.
    pub fn registered(&self, round: Round, sigmas: &[f64], planes: &[Vec<Planes>]) -> Start {
        let mut start = Start::at(round);
        for (sigma, planes) in sigmas.iter().zip(planes) {
            self.find_anew(&mut start);
            self.approach(&mut start, sigma * self.scale, planes);
        }
        start
    }

    /// An initial pose whose visibility is computed at its own state.
    pub fn start(&self, state: State, initial: State) -> Start {
        let round = Round { seen_from: state, ..Round::from(state, initial) };
        Start { round, discontinuities: self.discontinuities(&state, MOST_DISCONTINUITIES_OF_STARTS), score: 0.0 }
    }

    /// Finds the depth discontinuities of an initial pose anew if the pose moved.
    pub fn find_anew(&self, start: &mut Start) {
        if self.look(&mut start.round) || start.discontinuities.is_empty() {
            start.discontinuities = self.discontinuities(&start.round.seen_from, MOST_DISCONTINUITIES_OF_STARTS);
        }
    }

    /// The depth discontinuities of all frames that a state sees.
    pub fn discontinuities(&self, state: &State, most: usize) -> Vec<Vec<Discontinuity>> {
        self.frames
            .iter()
            .map(|frame| EdgeField::discontinuities(frame, &Projection::new(frame, state), most / self.frames.len()))
            .collect()
    }

    /// Takes one round with all cues and returns the length of its step, pixels. A step that lowers the posterior is
    /// halved. `kept` is what the last round left, if this is not the first.
    pub fn settle(&self, round: &mut Round, kept: &mut Option<Kept>, planes: &[Planes]) -> f64 {
        if self.look(round) {
            *kept = None;
        }
        let anew = || Kept { seen: self.seen(&round.seen_from), curvatures: vec![vec![]; self.frames.len()] };
        let Kept { seen, curvatures } = kept.get_or_insert_with(anew);
        let surfaces = self.surfaces(round, seen);
        let findings = self.findings_of(round, planes, seen, &surfaces, curvatures);
        let step = step(&findings.total, &findings.prior, &findings.back);
        let step = step * (LONGEST / step.norm()).min(1.0);
        let from = *round;
        let posterior = self.posterior(&from, planes, seen, &surfaces, &findings);
        let here = findings.total.value() - 0.5 * findings.back.dot(&(findings.prior * findings.back));
        let mut step = step;
        let mut state = findings.units.step(&round.state, &step);
        let mut halvings = 0;
        while posterior(&state) < here - ROUGHNESS {
            if halvings == MOST_HALVINGS {
                (step, state) = (Vector::zeros(), round.state);
                break;
            }
            step *= 0.5;
            state = findings.units.step(&round.state, &step);
            halvings += 1;
        }
        *round = Round { state, traces: findings.traces, ..*round };
        step.norm()
    }
}

/// Factor on the weight of the cues that compare surfaces. Shadows, half-occluded strips and varying albedo move the maxima of all
/// tiles alike, so that the scatter of tiles does not show these errors. In scenes without edges the remaining weight
/// still determines the pose.
const SURFACE_TRUST: f64 = 0.25;

/// Change of the mean log likelihood of a depth discontinuity that counts as much as one sigma of the prior.
/// Neighbouring discontinuities share errors, so that about a hundred of the thousands in a scene are independent.
const SCORE_PRIOR: f64 = 0.01;

fn step(total: &Evidence, prior: &Matrix, back: &Vector) -> Vector {
    let gradient = total.gradient() - prior * back;
    // If sums overflow, the state stays.
    let solution = solve(&(total.curvature() + prior), &gradient).filter(|step| step.norm().is_finite());
    solution.unwrap_or_else(Vector::zeros)
}
