//! The search in slices: a sweep over all rotations and sizes, then ascents from the best hypotheses.

use nalgebra::Matrix3;

use super::ascent::ascend;
use super::hypothesis::Hypothesis;
use super::matcher::{ImageGrid, Matcher};
use super::problem::{Candidate, Progress, SearchProblem};
use super::sweep::Sweep;
use super::task_results::TaskResults;
use crate::check::positive;
use crate::error::Result;
use crate::pose::similarity::Similarity;

/// Maximum number of ascents.
const MOST_ASCENTS: usize = 96;
/// Smallest distance between hypotheses of the sweep, degrees. Of two closer ones the worse is left out, because an
/// ascent reaches farther.
const SWEEP_SEPARATION: f64 = 10.0;
/// Maximum number of candidates.
const MOST_CANDIDATES: usize = 40;
/// Smallest distance between candidates, degrees. Of two closer ones the worse is a duplicate, because registration
/// would join them.
const CANDIDATE_SEPARATION: f64 = 5.0;

/// A search in slices; owns its memory.
pub struct Search {
    matcher: Matcher,
    sweep: Sweep,
    /// Best hypotheses of each slice of the sweep.
    swept: TaskResults<Vec<Hypothesis>>,
    /// Initial hypotheses of the ascents, chosen after the sweep, and the ends of the ascents.
    starts: Vec<Hypothesis>,
    ascents: TaskResults<Candidate>,
    candidates: Vec<Candidate>,
    /// The best of all hypotheses so far.
    best: Option<Candidate>,
}

/// A slice of the search. It depends only on the problem of the search, so that another search of the same problem can
/// run it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum SearchTask {
    /// Some pairs of rotation and size, by the index of their slice.
    Sweep(usize),
    /// An ascent, by its index, from one hypothesis.
    Ascend(usize, Hypothesis),
}

/// The result of a task.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum SearchFinding {
    /// The best hypotheses of a slice of the sweep.
    Swept(usize, Vec<Hypothesis>),
    /// The end of an ascent.
    Ascended(usize, Candidate),
}

impl Search {
    /// Prepares a search.
    ///
    /// # Errors
    /// [`Range`](crate::ErrorKind::Range) for a scale out of range, [`Empty`](crate::ErrorKind::Empty) if too few
    /// pixels have a normal, [`Degenerate`](crate::ErrorKind::Degenerate) if all colours are the same.
    pub fn new(problem: &SearchProblem<'_>) -> Result<Self> {
        Self::with_grid(problem, ImageGrid::new(problem.image)?)
    }

    /// As [`new`](Self::new), with the image's grid made in advance, which saves half of the preparation.
    pub(crate) fn with_grid(problem: &SearchProblem<'_>, grid: ImageGrid) -> Result<Self> {
        positive("scale", problem.scale.unwrap_or(problem.unit_scale))?;
        let matcher = Matcher::new(problem, grid)?;
        let sweep = Sweep::new(problem.scale.is_none(), matcher.has_distance(), problem.seed);
        Ok(Self {
            swept: TaskResults::new(sweep.slices()),
            starts: Vec::new(),
            ascents: TaskResults::new(MOST_ASCENTS),
            candidates: Vec::new(),
            best: None,
            matcher,
            sweep,
        })
    }

    /// Restricts the search to rotations within `degrees` of a given pose, and takes the distance from that pose. To be
    /// called before the first slice.
    pub(crate) fn narrow(&mut self, initial: &Similarity, degrees: f64) {
        self.matcher.place_at(initial);
        self.sweep.narrow(&initial.rotation, degrees);
        self.swept = TaskResults::new(self.sweep.slices());
    }

    /// A search behind a pinhole by local contrast, in which the depth map may show only a part of the object: the
    /// distance follows from the size of the mask. It does not use a known light.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub(crate) fn for_parts(problem: &SearchProblem<'_>) -> Result<Self> {
        let problem = SearchProblem { light: None, ..*problem };
        let mut search = Self::with_grid(&problem, ImageGrid::of_contrast(problem.image)?)?;
        search.matcher.place_by_area();
        search.sweep.seek_parts();
        search.swept = TaskResults::new(search.sweep.slices());
        Ok(search)
    }

    /// The score of any pose behind a pinhole; `None` if too little overlaps.
    pub(crate) fn score_of(&mut self, pose: &Similarity) -> Option<f64> {
        self.matcher.score_of(pose).filter(|score| score.is_finite())
    }

    /// The best translation for a fixed rotation; `None` if too little of the cloud is visible.
    pub(crate) fn shifted(&mut self, rotation: &Matrix3<f64>) -> Option<Similarity> {
        let Self { matcher, sweep, .. } = self;
        let shifted = sweep.sizes().iter().filter_map(|&size| matcher.best_shift(*rotation, size));
        let best = shifted.max_by(|a, b| a.score.total_cmp(&b.score))?;
        Some(self.matcher.candidate(&best).pose)
    }

    /// Runs one bounded slice of work: a few rotations of the sweep, or one ascent. Does nothing once all is done.
    pub fn advance(&mut self) -> Progress {
        let sweep = self.swept.next(|_| true).map(SearchTask::Sweep);
        let task = sweep.or_else(|| self.ascents.next(|_| true).map(|index| self.ascent(index)));
        if let Some(task) = task {
            let finding = self.perform(&task);
            self.accept(finding);
        }
        self.progress()
    }

    /// The progress so far.
    #[must_use]
    pub fn progress(&self) -> Progress {
        let done = self.swept.done() + self.ascents.done();
        Progress { share: done as f64 / (self.swept.len() + self.ascents.len()) as f64 }
    }

    /// A slice for a worker; `None` if no slice can begin at present.
    pub(crate) fn take(&mut self) -> Option<SearchTask> {
        if !self.swept.is_complete() {
            return self.swept.take(|_| true).map(SearchTask::Sweep);
        }
        self.ascents.take(|_| true).map(|index| self.ascent(index))
    }

    fn ascent(&self, index: usize) -> SearchTask {
        SearchTask::Ascend(index, self.starts[index])
    }

    /// Runs a slice of this search, or of another one of the same problem.
    pub(crate) fn perform(&mut self, task: &SearchTask) -> SearchFinding {
        match *task {
            SearchTask::Sweep(slice) => SearchFinding::Swept(slice, self.best_of_slice(slice)),
            SearchTask::Ascend(index, start) => {
                let end = ascend(&mut self.matcher, start, self.sweep.varies_size());
                SearchFinding::Ascended(index, self.matcher.candidate(&end))
            }
        }
    }

    /// Stores the result of a slice; results may come in any order.
    pub(crate) fn accept(&mut self, finding: SearchFinding) {
        let sweeping = !self.swept.is_complete();
        match finding {
            SearchFinding::Swept(slice, hypotheses) => {
                hypotheses.iter().for_each(|hypothesis| self.compare(self.matcher.candidate(hypothesis)));
                self.swept.put(slice, hypotheses);
            }
            SearchFinding::Ascended(index, candidate) => {
                self.compare(candidate);
                self.ascents.put(index, candidate);
            }
        }
        if sweeping && self.swept.is_complete() {
            self.choose_starts();
        }
        if self.is_done() && self.candidates.is_empty() {
            self.choose_candidates();
        }
    }

    /// Stores a hypothesis that is better than all earlier ones.
    fn compare(&mut self, candidate: Candidate) {
        if candidate.score.is_finite() && self.best.is_none_or(|best| candidate.score > best.score) {
            self.best = Some(candidate);
        }
    }

    /// The best hypothesis up to now.
    pub(crate) const fn best(&self) -> Option<&Candidate> {
        self.best.as_ref()
    }

    /// Whether the candidates are ready.
    pub(crate) fn is_done(&self) -> bool {
        self.swept.is_complete() && self.ascents.is_complete()
    }

    /// The poses found, best first; empty until the search is done.
    #[must_use]
    pub fn candidates(&self) -> &[Candidate] {
        &self.candidates
    }

    /// The poses of the sweep before any ascent. Each rotation occurs once, with its best size.
    #[must_use]
    pub fn swept_poses(&self) -> Vec<Similarity> {
        self.swept_rotations().iter().map(|hypothesis| self.matcher.candidate(hypothesis).pose).collect()
    }

    /// All rotations so far, of the sweep and of the ends of ascents, with their scores.
    pub(crate) fn scores(&self) -> Vec<(Matrix3<f64>, f64)> {
        let swept = self.swept_rotations().into_iter().map(|hypothesis| (hypothesis.rotation, hypothesis.score));
        swept.chain(self.ascents.results().map(|end| (end.pose.rotation, end.score))).collect()
    }

    /// The hypotheses of the sweep. Each rotation occurs once, with its best size.
    fn swept_rotations(&self) -> Vec<Hypothesis> {
        let mut rotations: Vec<Hypothesis> = Vec::new();
        for hypothesis in self.swept.results().flatten() {
            match rotations.last_mut().filter(|last| last.rotation == hypothesis.rotation) {
                Some(last) => *last = last.better(*hypothesis),
                None => rotations.push(*hypothesis),
            }
        }
        rotations
    }

    /// The best translation for each pair of a slice.
    fn best_of_slice(&mut self, slice: usize) -> Vec<Hypothesis> {
        let Self { matcher, sweep, .. } = self;
        sweep.slice(slice).filter_map(|(rotation, size)| matcher.best_shift(rotation, size)).collect()
    }

    /// Chooses the best hypotheses of the sweep, without similar rotations.
    fn choose_starts(&mut self) {
        self.starts = self.swept.results().flatten().copied().collect();
        self.starts.sort_by(|a, b| b.score.total_cmp(&a.score));
        suppress_duplicates(&mut self.starts, MOST_ASCENTS, SWEEP_SEPARATION, |start| &start.rotation);
        self.ascents = TaskResults::new(self.starts.len());
    }

    /// Chooses the best ends of the ascents, without similar rotations.
    fn choose_candidates(&mut self) {
        let ends = self.ascents.results().filter(|candidate| candidate.score.is_finite());
        self.candidates = ends.copied().collect();
        self.candidates.sort_by(|a, b| b.score.total_cmp(&a.score));
        suppress_duplicates(&mut self.candidates, MOST_CANDIDATES, CANDIDATE_SEPARATION, |one| &one.pose.rotation);
    }
}

/// Non-maximum suppression: from a list sorted by score, keeps the first `most` whose rotations are at least `degrees`
/// apart.
fn suppress_duplicates<T>(list: &mut Vec<T>, most: usize, degrees: f64, rotation: impl Fn(&T) -> &Matrix3<f64>) {
    // |R - R'|_F^2 = 8 sin^2(angle / 2)
    let least = 8.0 * (degrees.to_radians() / 2.0).sin().powi(2);
    let mut kept = 0;
    for index in 0..list.len() {
        let apart = |other: &T| (rotation(other) - rotation(&list[index])).norm_squared() >= least;
        if kept < most && list[..kept].iter().all(apart) {
            list.swap(kept, index);
            kept += 1;
        }
    }
    list.truncate(kept);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::Angles;
    use crate::scenes::{Sample, SampleRequest, Scene, light, surface};
    use crate::view::{Camera, ColourSamples, ColourView, DepthView, Lens, Pinhole, Size};

    const SIZE: Size = Size { width: 96, height: 72 };

    /// The bust in two pinhole cameras 25 degrees apart, with an albedo whose contrast is larger than that of the shading.
    fn pair() -> (Sample, ColourView, DepthView) {
        let camera = Camera::Pinhole(Pinhole { fx: 288.0, fy: 288.0, cx: 47.5, cy: 35.5, lens: Lens::None });
        let request = SampleRequest {
            size: SIZE,
            light: light("window").unwrap(),
            rotation: Angles { beta: 25.0, ..Angles::default() }.rotation(),
            noise: 0.01,
            image_camera: camera,
            depth_camera: camera,
            ..SampleRequest::default()
        };
        let sample = Scene::new(&surface("bust").unwrap()).unwrap().sample(&request).unwrap();
        let mut image = sample.colour_image();
        let ColourSamples::RgbLinear(colours) = &mut image.samples else { panic!("renders are linear") };
        for (index, rgb) in colours.chunks_exact_mut(3).enumerate() {
            let (column, row) = SIZE.position(index);
            let albedo = (3.0 * (0.09 * column as f32 - 5.0).sin() + 1.5 * (0.1 * row as f32).cos()).exp();
            rgb.iter_mut().for_each(|value| *value *= albedo);
        }
        let (image, depth) = (ColourView::new(image).unwrap(), DepthView::new(&sample.depth_map(), true).unwrap());
        (sample, image, depth)
    }

    #[test]
    fn the_first_candidate_by_local_contrast_is_near_the_truth() {
        let (sample, image, depth) = pair();
        let problem = SearchProblem {
            image: &image,
            depth: &depth,
            normals: &depth.normals,
            // Not used, because it predicts colours and not their local contrast.
            light: Some(&sample.light),
            scale: Some(1.0),
            unit_scale: 1.0,
            seed: 1,
        };
        let mut search = Search::for_parts(&problem).unwrap();
        while !search.is_done() {
            search.advance();
        }
        let best = search.candidates()[0];
        let off = best.pose.degrees_to(&sample.pose);
        assert!(off < 10.0, "{off} degrees");
        // The score of any pose is that of the search where the pose puts the centre of the cloud on a cell.
        let score = search.score_of(&best.pose).unwrap();
        assert!((score - best.score).abs() < 1e-3 * best.score, "{score} {}", best.score);
    }
}
