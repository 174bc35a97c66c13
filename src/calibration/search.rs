//! Where to start: the image shifts and turns that bring rims onto edges.
//!
//! What a wrong calibration does to an image is mostly a shift, for a turn of the camera about its x and y as for a
//! shift of it, and a turn about the optical axis. Rims are laid onto the image's edges at all of them within reach, and
//! the best few that are no neighbours are starts for the registration, beside the candidate itself.
//!
//! score = mean over rims of s, s = |n . grad I| / (|grad I| + mean of |grad I| around), less half the squared shift in
//! sigmas of the prior.

use super::edges::EdgeField;
use super::frame::{Frame, Projection};
use super::planes::Planes;
use super::rims::Rim;
use super::unknowns::{State, Units, Vector};

/// Shifts to each side and their pace, pixels of an image 640 wide.
const REACH: f64 = 48.0;
const PACE: f64 = 2.0;
/// Turns about the optical axis, degrees; none first.
const TURNS: [f64; 5] = [0.0, -1.5, 1.5, -3.0, 3.0];
/// Rims of a frame that are laid onto its edges.
const MOST_RIMS: usize = 500;
/// Starts beside the candidate.
const STARTS: usize = 16;
/// Two starts differ by this much, pixels.
const APART: f64 = 8.0;
/// Blur of the image, pixels of an image 640 wide: half the pace of the search and some.
const BLUR: f64 = 1.6;
/// sigma of what counts as around, in the same pixels.
const AROUND: f64 = 6.0;
/// Gradients weaker than this are noise: sum of three encoded channels over two pixels.
const FAINTEST: f32 = 0.03;
/// sigma of a candidate's turn about the axis, degrees: half of the others', which a turn about the axis cannot hide.
const TURN_SIGMA: f64 = 2.0;
/// Weight of the prior against the mean score: a shift of one sigma costs what one rim of fifty on an edge is worth.
const PRIOR_WEIGHT: f64 = 0.02;

/// Gradient of lightness over its surroundings.
struct EdgeMap {
    width: usize,
    height: usize,
    gradient: Vec<[f32; 2]>,
}

impl EdgeMap {
    fn new(planes: &Planes, scale: f64) -> Self {
        let smooth = planes.blurred((BLUR * scale) as f32);
        let (width, height) = (planes.size.width, planes.size.height);
        let light: Vec<f32> = smooth.pixels.iter().map(|p| p[0] + p[1] + p[2]).collect();
        let mut gradient = vec![[0.0_f32; 2]; light.len()];
        for row in 1..height - 1 {
            for column in 1..width - 1 {
                let at = row * width + column;
                gradient[at] = [light[at + 1] - light[at - 1], light[at + width] - light[at - width]];
            }
        }
        let size: Vec<[f32; 3]> = gradient.iter().map(|[x, y]| [x.hypot(*y), 0.0, 0.0]).collect();
        let around = Planes { size: planes.size, pixels: size.clone() }.blurred((AROUND * scale) as f32);
        for (index, gradient) in gradient.iter_mut().enumerate() {
            let total = size[index][0] + around.pixels[index][0] + FAINTEST;
            *gradient = gradient.map(|value| value / total);
        }
        Self { width, height, gradient }
    }

    fn at(&self, [column, row]: [f64; 2], normal: [f64; 2]) -> f64 {
        let (column, row) = (column.round(), row.round());
        if column < 0.0 || row < 0.0 || column >= self.width as f64 || row >= self.height as f64 {
            return 0.0;
        }
        let [x, y] = self.gradient[row as usize * self.width + column as usize].map(f64::from);
        (x * normal[0] + y * normal[1]).abs()
    }
}

/// A start, with the rims of a state that differs from it by a shift alone.
pub(super) struct Found {
    pub state: State,
    pub from: State,
    pub rims: Vec<Vec<Rim>>,
}

/// The candidate and other starts near it, best first after it. `sigma` is the prior's, pixels.
pub(super) fn starts(frames: &[Frame], state: &State, units: &Units, scale: f64, sigma: f64) -> Vec<Found> {
    let maps: Vec<EdgeMap> = frames.iter().map(|frame| EdgeMap::new(&frame.planes, scale)).collect();
    let mut best: Vec<(f64, [f64; 2], usize)> = vec![];
    let mut views: Vec<(State, Vec<Vec<Rim>>)> = vec![];
    for turn in TURNS {
        // About the scene's middle, which a shift then moves.
        let mut step = Vector::zeros();
        step[2] = turn.to_radians() / units.of[2];
        let turned = units.step(state, &step);
        let rims: Vec<Vec<Rim>> =
            frames.iter().map(|frame| EdgeField::rims(frame, &Projection::new(frame, &turned), MOST_RIMS)).collect();
        let count: usize = rims.iter().map(Vec::len).sum();
        let side = (REACH / PACE) as isize;
        for down in -side..=side {
            for right in -side..=side {
                let shift = [right, down].map(|k| k as f64 * PACE * scale);
                let score: f64 = maps
                    .iter()
                    .zip(&rims)
                    .map(|(map, rims)| {
                        rims.iter()
                            .map(|rim| map.at([rim.pixel[0] + shift[0], rim.pixel[1] + shift[1]], rim.normal))
                            .sum::<f64>()
                    })
                    .sum();
                let far = (shift[0].powi(2) + shift[1].powi(2)) / (sigma * sigma) + (turn / TURN_SIGMA).powi(2);
                best.push((score / count.max(1) as f64 - 0.5 * PRIOR_WEIGHT * far, shift, views.len()));
            }
        }
        views.push((turned, rims));
    }
    crate::numeric::sort_descending(&mut best, |entry| entry.0);
    let mut chosen: Vec<([f64; 2], usize)> = vec![([0.0; 2], 0)];
    for (_, place, view) in best {
        let is_apart = |other: &([f64; 2], usize)| {
            (place[0] - other.0[0]).hypot(place[1] - other.0[1]) > APART * scale || view != other.1
        };
        if chosen.iter().all(is_apart) {
            chosen.push((place, view));
        }
        if chosen.len() > STARTS {
            break;
        }
    }
    let found = |(shift, view): ([f64; 2], usize)| {
        let (from, rims) = &views[view];
        let mut step = Vector::zeros();
        (step[3], step[4]) = (shift[0], shift[1]);
        Found { state: units.step(from, &step), from: *from, rims: rims.clone() }
    };
    chosen.into_iter().map(found).collect()
}
