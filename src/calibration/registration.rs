//! One round of the registration: all cues over all frames at one state, and the resulting step.
//!
//! Unknowns: [`super::unknowns`]. Objective: the sum of the log likelihoods of the cues, each weighted by the ratio of
//! its curvature to the scatter of its tiles ([`Evidence::weight`]), and the prior about the initial pose. Solver:
//! Gauss-Newton, with the bound of expectation maximisation for edges and finite differences for the other cues. These
//! have a small basin of convergence and take part in the last rounds only.

use nalgebra::Vector3;

use super::cue::Cue;
use super::differences::differences;
use super::edges::{EdgeField, blur};
use super::evidence::{Evidence, Share, Tiles};
use super::frame::{Frame, Projection};
use super::information::Information;
use super::patches::{Patches, Sight};
use super::planes::Planes;
use super::rims::Rim;
use super::shading::Shading;
use super::silhouette::Silhouette;
use super::surface::{self, Sample};
use super::unknowns::{FOCAL, LOSS, Matrix, State, Units, Vector, solve};

/// Sigma of edges at each level, pixels of an image 640 wide: from the error that the coarse search leaves of a few
/// degrees to the resolution of an image. It halves every two levels.
pub(super) const SIGMAS: [f64; 4] = [4.0, 2.8, 1.9, 1.3];
/// How many poses proceed after each level, the best by score.
pub(super) const SURVIVORS: [usize; 4] = [10, 6, 4, 3];
/// Maximum number of depth discontinuities, over all frames, that score an initial pose.
pub(super) const MOST_RIMS_OF_STARTS: usize = 1200;
/// Rounds at each level.
pub(super) const ROUNDS: usize = 3;
/// Maximum number of rounds with all cues.
pub(super) const MOST_SETTLING: usize = 8;
/// A step that moves the scene by less than this has converged, pixels.
pub(super) const ARRIVED: f64 = 0.02;
/// Longest step of a round with all cues, pixels: finite differences are valid no farther.
const LONGEST: f64 = 3.0;
/// Blur of the image for the cues over surfaces, pixels: about the size of a pixel of the depth map.
const SURFACE_BLUR: f32 = 1.2;
/// Maximum numbers of depth discontinuities and samples, for all frames together and for a single one.
const MOST_RIMS: usize = 6000;
const MOST_RIMS_OF_ONE: usize = 1500;
const MOST_SAMPLES: usize = 24000;
const MOST_SAMPLES_OF_ONE: usize = 8000;
/// Maximum number of points, over all frames, that represent the extent of the scene.
const MOST_POINTS: usize = 3000;

/// Sigma of the prior about a candidate: rotation about the colour camera, degrees, and shift, metres. Rigs measured by
/// hand are off by this much. The check finds larger errors too if the scene shows them.
const PRIOR_DEGREES: f64 = 4.0;
const PRIOR_METRES: f64 = 0.05;
/// Share of the scene's points on the image below which a pose cannot be judged; fields of view that hardly overlap have
/// more.
const LEAST_SEEN: f64 = 0.02;
/// Sigma of the edge bias, pixels, and of ln f if the focal length is unknown.
const PRIOR_LOSS: f64 = 1.0;
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
}

/// A state, the initial state that the prior is about, and the sigma of edges.
#[derive(Clone, Copy, Debug)]
pub(super) struct Round {
    pub state: State,
    pub told: State,
    pub sigma: f64,
}

/// An initial pose during its registration, with depth discontinuities that were found at one of its states.
pub(super) struct Start {
    pub round: Round,
    pub found: State,
    pub rims: Vec<Vec<Rim>>,
    pub score: f64,
}

/// The evidence of all cues at a state.
pub(super) struct Findings {
    pub units: Units,
    pub prior: Matrix,
    /// The cues, each with its weight.
    pub cues: Vec<(Cue, Evidence, f64)>,
    pub total: Evidence,
    /// Step from the initial state of the prior to the state.
    pub back: Vector,
}

impl Scene {
    pub fn new(frames: Vec<Frame>, cues: Vec<Cue>, focal_is_free: bool) -> Self {
        let scale = (frames[0].planes.size.width as f64 / 640.0).max(1.0);
        let most = MOST_SAMPLES_OF_ONE.min(MOST_SAMPLES / frames.len());
        let samples = frames.iter().map(|frame| surface::samples(frame, most)).collect();
        let surface_planes = frames.iter().map(|frame| frame.planes.blurred(SURFACE_BLUR)).collect();
        let sparse = frames.iter().flat_map(|frame| frame.sparse(MOST_POINTS / frames.len())).collect();
        Self { frames, samples, sparse, surface_planes, cues, focal_is_free, scale }
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
        for k in 0..3 {
            rows[(k, k)] = 1.0 / PRIOR_DEGREES.to_radians();
            rows[(3 + k, 3 + k)] = 1.0 / PRIOR_METRES;
            (0..3).for_each(|j| rows[(3 + k, j)] = cross[(k, j)] / PRIOR_METRES);
        }
        rows[(LOSS, LOSS)] = 1.0 / PRIOR_LOSS;
        // A known focal length is held with a sigma of a millionth.
        rows[(FOCAL, FOCAL)] = if self.focal_is_free { 1.0 / PRIOR_FOCAL } else { 1e6 };
        let rows = rows * Matrix::from_diagonal(&units.of);
        rows.transpose() * rows
    }

    /// The log likelihood of edges by tiles.
    fn edges(&self, round: &Round, units: &Units, planes: &[Planes], projections: &[Projection]) -> Evidence {
        let most = MOST_RIMS_OF_ONE.min(MOST_RIMS / self.frames.len());
        let mut evidence = Evidence::default();
        for ((frame, planes), projection) in self.frames.iter().zip(planes).zip(projections) {
            let found = EdgeField::rims(frame, projection, most);
            add_edges(Sight { frame, planes }, &found, round, units, &mut evidence);
        }
        evidence
    }

    /// The log likelihood of one of the cues over surfaces by tiles.
    fn surfaces(&self, cue: Cue, state: &State, units: &Units, patches: &[Patches]) -> Evidence {
        let mut evidence = Evidence::default();
        for ((frame, planes), patches) in self.frames.iter().zip(&self.surface_planes).zip(patches) {
            let sight = Sight { frame, planes };
            let count = Tiles::new(planes.size).count();
            evidence.shares.extend(match cue {
                Cue::Information => {
                    let cue = Information(patches);
                    differences(units, state, count, |state, out| cue.evaluate(&sight, state, out))
                }
                Cue::Shading => {
                    let cue = Shading::new(patches, &sight, state);
                    differences(units, state, count, |state, out| cue.evaluate(&sight, state, out))
                }
                Cue::Silhouette => match Silhouette::new(patches, &sight) {
                    Some(cue) => differences(units, state, count, |state, out| cue.evaluate(&sight, state, out)),
                    None => vec![Share::none(); count],
                },
                Cue::Edges => vec![Share::none(); count],
            });
        }
        evidence
    }

    /// The evidence of all cues at the state of a round.
    pub fn findings(&self, round: &Round, planes: &[Planes]) -> Findings {
        let units = self.units(&round.state);
        let projections: Vec<_> = self.frames.iter().map(|frame| Projection::new(frame, &round.state)).collect();
        let seen = self.samples.iter().zip(&projections).zip(&self.frames);
        let patches: Vec<_> =
            seen.map(|((samples, projection), frame)| Patches::new(samples, projection, frame)).collect();
        let mut total = Evidence::default();
        let mut cues = vec![];
        for &cue in &self.cues {
            let evidence = match cue {
                Cue::Edges => self.edges(round, &units, planes, &projections),
                _ => self.surfaces(cue, &round.state, &units, &patches),
            };
            let trust = if cue == Cue::Edges { 1.0 } else { SURFACE_TRUST };
            let weight = trust * evidence.weight();
            evidence.add_to(&mut total, weight);
            cues.push((cue, evidence, weight));
        }
        let back = units.between(&round.told, &round.state);
        Findings { prior: self.prior(&units), units, cues, total, back }
    }

    /// Refines an initial pose by edges alone with its depth discontinuities fixed, and updates its score.
    pub fn approach(&self, start: &mut Start, sigma: f64, planes: &[Planes]) {
        start.round.sigma = sigma;
        for _ in 0..ROUNDS {
            let state = start.round.state;
            let units = self.units(&state);
            let (mut evidence, mut count) = (Evidence::default(), 0.0);
            for ((frame, planes), rims) in self.frames.iter().zip(planes).zip(&start.rims) {
                let moved = EdgeField::moved(frame, rims, &start.found, &state);
                count += add_edges(Sight { frame, planes }, &moved, &start.round, &units, &mut evidence);
            }
            let mean = evidence.value() / f64::max(count, 1.0);
            let mut total = Evidence::default();
            evidence.add_to(&mut total, evidence.weight());
            let back = units.between(&start.round.told, &state);
            let prior = self.prior(&units);
            start.score = mean - 0.5 * SCORE_PRIOR * back.dot(&(prior * back));
            start.round.state = units.step(&state, &step(&total, &prior, &back));
        }
    }

    /// The depth discontinuities of all frames as a state sees them.
    pub fn rims(&self, state: &State, most: usize) -> Vec<Vec<Rim>> {
        self.frames
            .iter()
            .map(|frame| EdgeField::rims(frame, &Projection::new(frame, state), most / self.frames.len()))
            .collect()
    }

    /// Takes one round with all cues and returns the length of its step, pixels.
    pub fn settle(&self, round: &mut Round, planes: &[Planes]) -> f64 {
        let findings = self.findings(round, planes);
        let step = step(&findings.total, &findings.prior, &findings.back);
        round.state = findings.units.step(&round.state, &(step * (LONGEST / step.norm()).min(1.0)));
        step.norm()
    }
}

/// Factor of the weight of cues over surfaces. Shadows, half-occluded strips and varying albedo move the maxima of all
/// tiles alike, so that the scatter of tiles does not show these errors. In scenes without edges the remaining weight
/// still determines the pose.
const SURFACE_TRUST: f64 = 0.25;

/// Mean log likelihood of a depth discontinuity that one sigma of the prior is worth: neighbouring discontinuities count
/// as one, so that about a hundred of the thousands in a scene are independent.
const SCORE_PRIOR: f64 = 0.01;

/// Adds the evidence of a frame's edges, and returns the number of independent depth discontinuities on its image.
fn add_edges(sight: Sight<'_>, rims: &[Rim], round: &Round, units: &Units, evidence: &mut Evidence) -> f64 {
    let mut shares = vec![Share::none(); Tiles::new(sight.planes.size).count()];
    let field = EdgeField::new(sight, rims, &round.state, units, round.sigma);
    field.evidence(&mut shares);
    evidence.shares.extend(shares);
    field.weight()
}

fn step(total: &Evidence, prior: &Matrix, back: &Vector) -> Vector {
    let gradient = total.gradient() - prior * back;
    // If sums overflow, the state stays.
    let solution = solve(&(total.curvature() + prior), &gradient).filter(|step| step.norm().is_finite());
    solution.unwrap_or_else(Vector::zeros)
}
