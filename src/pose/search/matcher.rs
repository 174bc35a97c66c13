//! Matches the cloud of the depth view to the grid of the image: the score of a hypothesis, and the best translations.

use nalgebra::Matrix3;

use super::cloud::Cloud;
use super::correlate::Correlator;
use super::geometry::Geometry;
use super::hypothesis::Hypothesis;
use super::problem::{Candidate, SearchProblem};
use super::score::{FEWEST_CELLS, Prediction, score};
use super::target::{Fourier, SIDE, Target};
use super::template::{GridProjection, Template};
use crate::error::Result;
use crate::pose::similarity::Similarity;
use crate::view::ColourView;

/// Maximum number of moves by one cell after each change of rotation or size.
const MOST_MOVES: usize = 3;

/// The image on the search grid, and the memory of its transforms.
pub(crate) struct ImageGrid {
    target: Target,
    fourier: Fourier,
}

impl ImageGrid {
    /// # Errors
    /// [`Degenerate`](crate::ErrorKind::Degenerate) if all colours are the same.
    pub fn new(image: &ColourView) -> Result<Self> {
        Self::with(image, false)
    }

    /// The grid of the image's local contrast.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn of_contrast(image: &ColourView) -> Result<Self> {
        Self::with(image, true)
    }

    fn with(image: &ColourView, by_contrast: bool) -> Result<Self> {
        let mut fourier = Fourier::new();
        Ok(Self { target: Target::new(image, SIDE, &mut fourier, by_contrast)?, fourier })
    }
}

/// Both views on one grid; owns its memory.
pub struct Matcher {
    geometry: Geometry,
    cloud: Cloud,
    target: Target,
    template: Template,
    /// The colours of a known light, if the light is known.
    prediction: Option<Prediction>,
    correlator: Correlator,
}

impl Matcher {
    /// # Errors
    /// [`Empty`](crate::ErrorKind::Empty) if too few pixels have a normal.
    pub fn new(problem: &SearchProblem<'_>, ImageGrid { target, fourier }: ImageGrid) -> Result<Self> {
        let by_contrast = target.by_contrast;
        let cloud = Cloud::new(problem.depth.size, &problem.depth.points, problem.normals, by_contrast)?;
        Ok(Self {
            geometry: Geometry::new(problem, &target, &cloud),
            template: Template::new(SIDE, &cloud, by_contrast),
            prediction: problem.light.map(|light| Prediction::new(light, &target)),
            correlator: Correlator::new(fourier),
            cloud,
            target,
        })
    }

    /// Takes the distance from a given pose.
    pub fn place_at(&mut self, initial: &Similarity) {
        self.geometry.place_at(initial, &self.cloud);
    }

    /// Takes the distance at which both silhouettes have the same area.
    pub const fn place_by_area(&mut self) {
        self.geometry.place_by_area();
    }

    /// Whether the distance varies instead of the scale.
    pub const fn has_distance(&self) -> bool {
        self.geometry.has_distance()
    }

    /// The best translation for a rotation and a size; `None` if too little of the cloud is visible.
    pub fn best_shift(&mut self, rotation: Matrix3<f64>, size: f64) -> Option<Hypothesis> {
        if !self.draw(&rotation, &self.projection(size)) {
            return None;
        }
        let proposals = self.correlator.proposals(&self.template, self.prediction.as_ref(), &self.target);
        let scored = proposals.map(|shift| Hypothesis { rotation, size, shift, score: self.score(shift) });
        scored.max_by(|a, b| a.score.total_cmp(&b.score)).filter(|best| best.score.is_finite())
    }

    /// Scores the hypothesis and moves it to the best translation nearby.
    pub fn best_shift_nearby(&mut self, mut hypothesis: Hypothesis) -> Hypothesis {
        hypothesis.score = f64::NEG_INFINITY;
        if !self.draw(&hypothesis.rotation, &self.projection(hypothesis.size)) {
            return hypothesis;
        }
        hypothesis.score = self.score(hypothesis.shift);
        for _ in 0..MOST_MOVES {
            let [column, row] = hypothesis.shift;
            let beside = [[column - 1, row], [column + 1, row], [column, row - 1], [column, row + 1]];
            let moved = beside.map(|shift| Hypothesis { shift, score: self.score(shift), ..hypothesis });
            let best = moved.into_iter().fold(hypothesis, Hypothesis::better);
            if best.shift == hypothesis.shift {
                break;
            }
            hypothesis = best;
        }
        hypothesis
    }

    /// The pose of a hypothesis, with its score.
    pub fn candidate(&self, hypothesis: &Hypothesis) -> Candidate {
        let pose = self.geometry.pose(hypothesis, &self.cloud, &self.target);
        Candidate { pose, score: hypothesis.score }
    }

    /// The score of a pose behind a pinhole, between cells; `None` if too little overlaps.
    pub fn score_of(&mut self, pose: &Similarity) -> Option<f64> {
        let (size, place) = self.geometry.size_and_place(pose, &self.cloud, &self.target)?;
        let whole = place.map(f64::round);
        let offset = [0, 1].map(|axis| (place[axis] - whole[axis]) as f32);
        let projection = GridProjection { offset, ..self.projection(size) };
        self.draw(&pose.rotation, &projection).then(|| self.score(whole.map(|cells| cells as i32)))
    }

    fn projection(&self, size: f64) -> GridProjection {
        self.geometry.projection(size, self.target.cell)
    }

    /// Draws the rotated cloud as a template. Returns whether enough of the cloud is visible.
    fn draw(&mut self, rotation: &Matrix3<f64>, projection: &GridProjection) -> bool {
        self.template.draw(&self.cloud, rotation, projection);
        if self.template.visible < FEWEST_CELLS {
            return false;
        }
        match &mut self.prediction {
            None => self.template.multiply(),
            Some(prediction) => prediction.shade(&self.template, &self.target),
        }
        true
    }

    /// The exact score of the template at a translation.
    fn score(&self, shift: [i32; 2]) -> f64 {
        score(&self.template, self.prediction.as_ref(), &self.target, shift).unwrap_or(f64::NEG_INFINITY)
    }
}
