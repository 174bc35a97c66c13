//! The opening search: poses worth refining when nothing is known of where the views stand, the light known or not.
//!
//! maximise over R, s, tau: N (N / V) ln( det T / det E ) / 3, see [`judge`]: how much better the turned depth normals
//! explain the image's log colours than a constant does.
//!
//! Method: depth and image on a coarse grid. First a sweep: for rotations spread evenly, and scales where they are
//! free, the turned, visible cloud is laid over the grid and all translations are correlated by FFT; the best few are
//! judged exactly. Then the best rotations, no two alike, climb to their local maximum, halving their steps. What is
//! left after another suppression of twins is sorted by score. Order-2 harmonics are closed under rotation: for an
//! unknown light any rotation explains any colours of the same normals, so that only where the normals lie speaks for a
//! pose.
//!
//! A colour camera without intrinsics sees parallel rays: a pose moves in the image plane, its centre at z = 0. With
//! intrinsics the centre moves in the plane of its starting distance: that of the depth camera, or where the
//! silhouettes are as large. There scale and distance look alike: the scale is held and the distance varies instead.
//!
//! Measured on 160 scenes of 64x64 (eight surfaces, natural and colourful lights, up to 75 degrees with roll, 0.4 to
//! all of the columns, free scale, 1 % noise): a candidate within 10 degrees of the truth is first in 73 %, among the
//! first ten in 92 % and among all in 98 % for an unknown light; in 88, 98 and 100 % for a known one.
//!
//! Limits: tilt up to 100 degrees with roll up to 32, or any rotation up to 76 degrees. Poses end a few degrees from
//! the truth. What is lost are tilts beyond 60 degrees of half a depth map: too little is seen twice. Overlaps under
//! 0.15 are not seen. No shadows, one albedo.

mod cloud;
mod correlate;
mod judge;
mod rotations;
mod target;
mod task_results;
mod template;

use nalgebra::{Matrix3, Rotation3, Vector3};

use super::Similarity;
use crate::check::positive;
use crate::error::Result;
use crate::light::Light;
use crate::numeric::sort_descending;
use crate::view::{Camera, ColourView, DepthView, Normals, Size};
use cloud::Cloud;
use correlate::Correlator;
use judge::{FEWEST_CELLS, Prediction, judge};
use target::{Fourier, SIDE, Target};
pub(crate) use task_results::Slots;
use template::{Gaze, Template};

/// Distance of neighbouring rotations of the sweep in degrees. On 160 scenes with unknown light, before any climb, one
/// within 15 degrees of the truth was among the first 40 in 99 % at 17 and in 96 % at 20.
const SPACING: f64 = 16.0;
/// Scales of a free scale relative to s0, a cell apart at either end of the object; the climb reaches 0.7 and 1.4 and
/// closes the gaps. Six of them rank alike and take half as long again.
const FREE_SCALES: [f64; 4] = [0.74, 0.90, 1.09, 1.32];
/// Apparent sizes behind a pinhole whose scale is held: the distance is known only roughly.
const NEAR_SIZES: [f64; 3] = [0.87, 1.0, 1.15];
/// Pairs of a rotation and a scale in one slice of the sweep.
const SWEPT_AT_ONCE: usize = 8;
/// Slices of a single pair at the beginning: the very first call compiles what it needs, and until engines
/// have optimised that, a pair takes several times as long.
const WARMING_SLICES: usize = 30;
/// Rotations that climb.
const CLIMBERS: usize = 96;
/// Rotations of the sweep that are nearer to a better one than this many degrees do not climb: a climb goes farther.
const SWEEP_TWINS: f64 = 10.0;
/// Steps of the climb in degrees, one round each.
const TURNS: [f64; 2] = [8.0, 4.0];
/// Growth of the scale that goes with them, natural logarithm.
const GROWTHS: [f64; 2] = [0.07, 0.035];
/// Moves by one cell after each turn of a climber, at most.
const MOST_MOVES: usize = 3;
/// Candidates kept.
const KEPT: usize = 40;
/// Candidates nearer to a better one than this many degrees are its twins: a refinement would join them.
const TWINS: f64 = 5.0;

/// A pose worth refining.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// Carries points of the depth view into the colour view.
    pub pose: Similarity,
    /// Gain of log likelihood over a constant colour, in cells; comparable within one search only.
    pub score: f64,
}

/// How far a search has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Share of the work that is done: one when the candidates are ready.
    pub share: f64,
}

/// The image as a search looks at it, and how it was transformed.
pub(crate) struct ImageGrid {
    target: Target,
    fourier: Fourier,
}

impl ImageGrid {
    /// # Errors
    /// [`Degenerate`](crate::ErrorKind::Degenerate) where all colours are the same.
    pub fn new(image: &ColourView) -> Result<Self> {
        let mut fourier = Fourier::new();
        Ok(Self { target: Target::new(image, SIDE, &mut fourier)?, fourier })
    }
}

/// What is known beforehand of a pose to be searched.
#[derive(Clone, Copy)]
pub(crate) struct Known<'a> {
    pub light: Option<&'a Light>,
    pub scale: Option<f64>,
    pub unit_scale: f64,
    pub seed: u64,
}

/// A search in slices; owns all its memory.
pub struct Search {
    geometry: Geometry,
    cloud: Cloud,
    target: Target,
    template: Template,
    prediction: Option<Prediction>,
    correlator: Correlator,
    rotations: Vec<Matrix3<f64>>,
    sizes: Vec<f64>,
    sizes_vary: bool,
    /// Best places of each slice of the sweep.
    sweeps: Slots<Vec<Place>>,
    /// Chosen once the sweep is done, and where they end.
    climbers: Vec<Place>,
    climbs: Slots<Candidate>,
    found: Vec<Candidate>,
}

/// A slice of the search, which needs nothing but the search's own views and options: whoever has the same can do it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum SearchTask {
    /// Some pairs of rotation and size, by the number of their slice.
    Sweep(usize),
    /// The climb of one, and its number.
    Climb(usize, Place),
}

/// What became of a task.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum SearchFinding {
    /// The best places of a slice of the sweep.
    Swept(usize, Vec<Place>),
    /// Where a climber ended.
    Climbed(usize, Candidate),
}

/// A point of the search: a rotation, an apparent size relative to the start's, a translation in cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub rotation: Matrix3<f64>,
    pub size: f64,
    pub shift: [i32; 2],
    pub score: f64,
}

/// What carries places of the grid to poses.
struct Geometry {
    camera: Camera,
    image: Size,
    /// s where the apparent size is one.
    scale: f64,
    /// Of the centre of the cloud from a pinhole, in units of the colour view.
    distance: Option<f64>,
    ray: [f64; 2],
}

impl Search {
    /// Prepares a search of `depth` in `image` by its points and these `normals` of them. `light` in the colour view's
    /// frame, where it is known; `scale` holds s, `None` searches 0.7 .. 1.4 times `unit_scale`; `seed` turns the set of
    /// rotations.
    ///
    /// # Errors
    /// [`Range`](crate::ErrorKind::Range) for a scale out of range, [`Empty`](crate::ErrorKind::Empty) where too few
    /// pixels have a normal, [`Degenerate`](crate::ErrorKind::Degenerate) where all colours are the same.
    pub fn new(
        image: &ColourView,
        depth: &DepthView,
        normals: &Normals,
        light: Option<&Light>,
        scale: Option<f64>,
        unit_scale: f64,
        seed: u64,
    ) -> Result<Self> {
        let known = Known { light, scale, unit_scale, seed };
        Self::over(ImageGrid::new(image)?, image, depth, normals, known)
    }

    /// [`new`](Self::new) over a grid of the image that is there already: half of the preparation.
    pub(crate) fn over(
        grid: ImageGrid,
        image: &ColourView,
        depth: &DepthView,
        normals: &Normals,
        Known { light, scale, unit_scale, seed }: Known<'_>,
    ) -> Result<Self> {
        positive("scale", scale.unwrap_or(unit_scale))?;
        let ImageGrid { target, fourier } = grid;
        let cloud = Cloud::new(depth.size, &depth.points, normals)?;
        let geometry = Geometry::new(image, depth, &target, &cloud, scale.unwrap_or(unit_scale));
        let sizes = match (scale, geometry.distance) {
            (None, _) => FREE_SCALES.to_vec(),
            (Some(_), Some(_)) => NEAR_SIZES.to_vec(),
            (Some(_), None) => vec![1.0],
        };
        let rotations = rotations::spread(SPACING, seed);
        Ok(Self {
            sweeps: Slots::new(slices(rotations.len() * sizes.len())),
            template: Template::new(SIDE, &cloud),
            prediction: light.map(|light| Prediction::new(light, &target)),
            correlator: Correlator::new(fourier),
            sizes_vary: sizes.len() > 1,
            climbers: Vec::new(),
            climbs: Slots::new(CLIMBERS),
            found: Vec::new(),
            geometry,
            cloud,
            target,
            rotations,
            sizes,
        })
    }

    /// One bounded slice of work: a few rotations of the sweep, or the climb of one. Does nothing once all is done.
    pub fn advance(&mut self) -> Progress {
        let sweep = self.sweeps.next(|_| true).map(SearchTask::Sweep);
        let task = sweep.or_else(|| self.climbs.next(|_| true).map(|index| self.climb_of(index)));
        if let Some(task) = task {
            let finding = self.perform(&task);
            self.accept(finding);
        }
        self.progress()
    }

    /// How much is done.
    #[must_use]
    pub fn progress(&self) -> Progress {
        let done = self.sweeps.done() + self.climbs.done();
        Progress { share: done as f64 / (self.sweeps.len() + self.climbs.len()) as f64 }
    }

    /// A slice for somebody else to do; `None` while none can be begun.
    pub(crate) fn take(&mut self) -> Option<SearchTask> {
        if !self.sweeps.is_complete() {
            return self.sweeps.take(|_| true).map(SearchTask::Sweep);
        }
        self.climbs.take(|_| true).map(|index| self.climb_of(index))
    }

    fn climb_of(&self, index: usize) -> SearchTask {
        SearchTask::Climb(index, self.climbers[index])
    }

    /// Does a slice, whoever it is for.
    pub(crate) fn perform(&mut self, task: &SearchTask) -> SearchFinding {
        match *task {
            SearchTask::Sweep(slice) => SearchFinding::Swept(slice, self.sweep(slice)),
            SearchTask::Climb(index, place) => SearchFinding::Climbed(index, self.climb(place)),
        }
    }

    /// Takes in what became of a slice, in any order.
    pub(crate) fn accept(&mut self, finding: SearchFinding) {
        let sweeping = !self.sweeps.is_complete();
        match finding {
            SearchFinding::Swept(slice, places) => self.sweeps.put(slice, places),
            SearchFinding::Climbed(index, candidate) => self.climbs.put(index, candidate),
        }
        if sweeping && self.sweeps.is_complete() {
            self.choose_climbers();
        }
        if self.is_done() && self.found.is_empty() {
            self.finish();
        }
    }

    /// Whether the candidates are ready.
    pub(crate) fn is_done(&self) -> bool {
        self.sweeps.is_complete() && self.climbs.is_complete()
    }

    /// The poses found, best first; none before the search is done.
    #[must_use]
    pub fn candidates(&self) -> &[Candidate] {
        &self.found
    }

    /// Lays the cloud over the grid; whether enough of it is seen.
    fn draw(&mut self, rotation: &Matrix3<f64>, size: f64) -> bool {
        self.template.draw(&self.cloud, rotation, &self.geometry.gaze(size, self.target.cell));
        if self.template.visible < FEWEST_CELLS {
            return false;
        }
        match &mut self.prediction {
            None => self.template.multiply(),
            Some(prediction) => prediction.shade(&self.template, &self.target),
        }
        true
    }

    fn judge(&self, shift: [i32; 2]) -> f64 {
        judge(&self.template, self.prediction.as_ref(), &self.target, shift).unwrap_or(f64::NEG_INFINITY)
    }

    /// The best places of one slice.
    fn sweep(&mut self, slice: usize) -> Vec<Place> {
        let pairs = self.rotations.len() * self.sizes.len();
        let slice = slice_start(slice).min(pairs)..slice_start(slice.saturating_add(1)).min(pairs);
        let pair = |pair| (self.rotations[pair / self.sizes.len()], self.sizes[pair % self.sizes.len()]);
        let pairs: Vec<_> = slice.map(pair).collect();
        pairs.into_iter().filter_map(|(rotation, size)| self.look(rotation, size)).collect()
    }

    /// The best place of a rotation and a size.
    fn look(&mut self, rotation: Matrix3<f64>, size: f64) -> Option<Place> {
        if !self.draw(&rotation, size) {
            return None;
        }
        let proposals = self.correlator.proposals(&self.template, self.prediction.as_ref(), &self.target);
        let judged = proposals.map(|shift| Place { rotation, size, shift, score: self.judge(shift) });
        judged.max_by(|a, b| a.score.total_cmp(&b.score)).filter(|place| place.score.is_finite())
    }

    /// The best places of the sweep, no two rotations alike.
    fn choose_climbers(&mut self) {
        self.climbers = self.sweeps.results().flatten().copied().collect();
        sort_descending(&mut self.climbers, |place| place.score);
        keep_apart(&mut self.climbers, CLIMBERS, SWEEP_TWINS, |place| &place.rotation);
        self.climbs = Slots::new(self.climbers.len());
    }

    fn climb(&mut self, start: Place) -> Candidate {
        let mut best = start;
        for (turn, growth) in TURNS.into_iter().zip(GROWTHS) {
            let centre = best;
            let mut vertex = [0.0; 4];
            let unknowns = if self.sizes_vary { 4 } else { 3 };
            for (axis, vertex) in vertex.iter_mut().enumerate().take(unknowns) {
                let mut scores = [0.0; 2];
                for (score, sign) in scores.iter_mut().zip([-1.0, 1.0]) {
                    let mut step = [0.0; 4];
                    step[axis] = sign;
                    let place = self.settle(moved(&centre, step, turn, growth));
                    *score = place.score;
                    best = better(best, place);
                }
                *vertex = peak(scores[0], centre.score, scores[1]);
            }
            best = better(best, self.settle(moved(&centre, vertex, turn, growth)));
        }
        Candidate { pose: self.geometry.pose(&best, &self.cloud, &self.target), score: best.score }
    }

    /// The place with its score, moved to the best translation next to it.
    fn settle(&mut self, mut place: Place) -> Place {
        place.score = f64::NEG_INFINITY;
        if !self.draw(&place.rotation, place.size) {
            return place;
        }
        place.score = self.judge(place.shift);
        for _ in 0..MOST_MOVES {
            let [column, row] = place.shift;
            let beside = [[column - 1, row], [column + 1, row], [column, row - 1], [column, row + 1]];
            let moved = beside.map(|shift| Place { shift, score: self.judge(shift), ..place });
            let best = moved.into_iter().fold(place, better);
            if best.shift == place.shift {
                break;
            }
            place = best;
        }
        place
    }

    fn finish(&mut self) {
        self.found = self.climbs.results().filter(|candidate| candidate.score.is_finite()).copied().collect();
        sort_descending(&mut self.found, |candidate| candidate.score);
        keep_apart(&mut self.found, KEPT, TWINS, |candidate| &candidate.pose.rotation);
    }
}

impl Geometry {
    fn new(image: &ColourView, depth: &DepthView, target: &Target, cloud: &Cloud, scale: f64) -> Self {
        let ray = image.camera.ray(image.size, target.middle);
        let seen = image.mask.iter().filter(|&&inside| inside).count();
        let distance = image.camera.focal_length().map(|focal_length| match depth.camera {
            Camera::Pinhole(_) => scale * cloud.centre.z,
            Camera::Orthographic => focal_length * scale * (depth.valid() as f64 / seen as f64).sqrt(),
        });
        let ray = if distance.is_some() { ray } else { [0.0; 2] };
        Self { camera: image.camera, image: image.size, scale, distance, ray }
    }

    fn gaze(&self, size: f64, cell: f64) -> Gaze {
        let (pixels, closeness) = match (self.camera.focal_length(), self.distance) {
            (Some(focal_length), Some(distance)) => (focal_length * self.scale / distance, self.scale / distance),
            _ => (self.scale, 0.0),
        };
        Gaze {
            magnification: (size * pixels / cell) as f32,
            ray: self.ray.map(|value| value as f32),
            closeness: (size * closeness) as f32,
        }
    }

    fn pose(&self, place: &Place, cloud: &Cloud, target: &Target) -> Similarity {
        let pixel = [0, 1].map(|axis| target.middle[axis] + f64::from(place.shift[axis]) * target.cell);
        let (scale, distance) = match self.distance {
            None => (self.scale * place.size, 0.0),
            Some(distance) => (self.scale, distance / place.size),
        };
        let centre = Vector3::from(self.camera.point(self.image, pixel, distance));
        Similarity { scale, rotation: place.rotation, translation: centre - scale * (place.rotation * cloud.centre) }
    }
}

/// Slices of a sweep over so many pairs of rotation and size.
const fn slices(pairs: usize) -> usize {
    match pairs.checked_sub(WARMING_SLICES) {
        Some(others) => WARMING_SLICES + others.div_ceil(SWEPT_AT_ONCE),
        None => pairs,
    }
}

/// The first pair of a slice.
const fn slice_start(slice: usize) -> usize {
    match slice.checked_sub(WARMING_SLICES) {
        Some(others) => WARMING_SLICES.saturating_add(others.saturating_mul(SWEPT_AT_ONCE)),
        None => slice,
    }
}

/// Turned about x, y, z and grown by as many steps.
fn moved(place: &Place, [x, y, z, grown]: [f64; 4], turn: f64, growth: f64) -> Place {
    let rotation = Rotation3::new(Vector3::new(x, y, z) * turn.to_radians()).into_inner() * place.rotation;
    Place { rotation, size: place.size * (grown * growth).exp(), ..*place }
}

/// Where the parabola through scores at -1, 0 and 1 is highest, within these bounds.
fn peak(before: f64, here: f64, after: f64) -> f64 {
    let bend = before - 2.0 * here + after;
    if bend < 0.0 && bend.is_finite() {
        return (0.5 * (before - after) / bend).clamp(-1.0, 1.0);
    }
    if after > before { 1.0 } else { -1.0 }
}

fn better(a: Place, b: Place) -> Place {
    if b.score > a.score { b } else { a }
}

/// Of a list sorted by merit keeps the first `most` whose rotations are `degrees` apart.
fn keep_apart<T>(list: &mut Vec<T>, most: usize, degrees: f64, rotation: impl Fn(&T) -> &Matrix3<f64>) {
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

    #[test]
    fn slices_hold_every_pair_once() {
        for pairs in [0, 5, 12, 13, 100, 2792] {
            let starts: Vec<usize> = (0..=slices(pairs)).map(|slice| slice_start(slice).min(pairs)).collect();
            assert!(starts.windows(2).all(|pair| pair[0] < pair[1]) && starts[0] == 0 && starts.last() == Some(&pairs));
        }
        assert!(slice_start(usize::MAX) >= 2792);
    }
}
