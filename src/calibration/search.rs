//! The coarse search for initial poses: a lattice of possible errors of a candidate.
//!
//! The prior states the expected error of a candidate. The eigenvectors of J^T J in sigmas of the prior, with J the
//! motion of the depth discontinuities, are the errors that move the image the most. Two of them are shifts of the
//! image; one sigma of these moves it by tens of pixels. A rotation about the optical axis, a shift along it and an
//! unknown focal length move it less, and rotations and shifts that cancel at one depth but not at another move it by a
//! few pixels. A lattice covers all of these errors with the same pace in pixels, and discontinuities move on straight
//! lines along its directions. The best places that are not neighbours become initial poses of the registration.
//!
//! score = mean over discontinuities of s - PRIOR_WEIGHT / 2 * squared distance in sigmas of the prior,
//! s = |n . grad I| / (|grad I| + mean of |grad I| in the surroundings + FAINTEST)

use super::discontinuities::Discontinuity;
use super::frame::Frame;
use super::planes::Planes;
use super::registration::Scene;
use super::unknowns::{Matrix, State, UNKNOWNS, Units, Vector, add_square, spectral};
use crate::numeric::descending;
use crate::numeric::eigen::symmetric_eigen;

/// Distance between neighbouring poses of the lattice: the root mean square motion of the depth discontinuities, in pixels
/// of an image 640 wide.
const PACE: f64 = 4.0;
/// Maximum number of places, which take a few tenths of a second. If the lattice has more, the pace grows.
const MOST_PLACES: f64 = 6e4;
/// Maximum number of depth discontinuities, over all frames, that are compared with image edges.
const MOST_DISCONTINUITIES: usize = 400;
/// Number of initial poses besides the candidate itself.
const STARTS: usize = 16;
/// Least distance between two initial poses, paces.
const APART: f64 = 1.5;
/// Sigma of the image's blur, paces, so that an edge is visible from half a pace away.
const BLUR: f64 = 0.5;
/// Sigma of the surroundings of a gradient, paces.
const AROUND: f64 = 2.0;
/// Gradients weaker than this are noise: sum of three encoded channels, difference over two pixels.
const FAINTEST: f32 = 0.03;
/// Weight of the prior against the mean score. One sigma costs 0.01, the gain of the score if one discontinuity in
/// fifty lies on an edge with s = 0.5.
const PRIOR_WEIGHT: f64 = 0.02;

/// Gradient of lightness relative to its surroundings.
struct EdgeMap {
    width: usize,
    height: usize,
    gradient: Vec<[f32; 2]>,
}

impl EdgeMap {
    fn new(planes: &Planes, pace: f64) -> Self {
        let smooth = planes.blurred((BLUR * pace) as f32);
        let (width, height) = (planes.size.width, planes.size.height);
        let light: Vec<f32> = smooth.pixels.iter().map(|p| p[0] + p[1] + p[2]).collect();
        let mut gradient = vec![[0.0_f32; 2]; light.len()];
        for row in 1..height - 1 {
            for column in 1..width - 1 {
                let at = row * width + column;
                gradient[at] = [light[at + 1] - light[at - 1], light[at + width] - light[at - width]];
            }
        }
        // The gradient is zero beside pixels that are not used.
        gradient.iter_mut().filter(|[x, y]| (x + y).is_nan()).for_each(|gradient| *gradient = [0.0; 2]);
        let size: Vec<[f32; 3]> = gradient.iter().map(|[x, y]| [x.hypot(*y), 0.0, 0.0]).collect();
        let around = Planes { size: planes.size, pixels: size.clone() }.blurred((AROUND * pace) as f32);
        for (index, gradient) in gradient.iter_mut().enumerate() {
            let total = size[index][0] + around.pixels[index][0] + FAINTEST;
            *gradient = gradient.map(|value| value / total);
        }
        Self { width, height, gradient }
    }

    fn at(&self, [column, row]: [f32; 2], normal: [f32; 2]) -> f32 {
        // The position is rounded to the nearest pixel, because half a pixel is added and the cast truncates.
        let (column, row) = (column + 0.5, row + 0.5);
        if column < 0.0 || row < 0.0 || column >= self.width as f32 || row >= self.height as f32 {
            return 0.0;
        }
        let [x, y] = self.gradient[row as usize * self.width + column as usize];
        (x * normal[0] + y * normal[1]).abs()
    }
}

/// A depth discontinuity as the candidate projects it, and its motion by one pace along each direction.
struct Mark {
    frame: usize,
    pixel: [f32; 2],
    normal: [f32; 2],
    motion: [[f32; 2]; UNKNOWNS],
}

/// Places k_0 .. k_7, each from -reach to reach, in paces along directions. The first directions move the discontinuities
/// the most.
struct Lattice {
    /// A step of one pace along each direction.
    steps: [Vector; UNKNOWNS],
    /// Sigmas of the prior in a pace along each direction.
    sigmas: [f64; UNKNOWNS],
    reach: [i8; UNKNOWNS],
}

type Place = [i8; UNKNOWNS];

/// The depth discontinuities that are visible from `state`, and initial poses near it, of which `state` is the first. `reach` is the half
/// width of the lattice, sigmas of the prior.
pub(super) fn starts(scene: &Scene, state: &State, reach: f64) -> (Vec<Vec<Discontinuity>>, Vec<State>) {
    let units = scene.units(state);
    let discontinuities = scene.discontinuities(state, MOST_DISCONTINUITIES);
    let rows: Vec<(usize, Discontinuity, [Vector; 2])> = rows(&scene.frames, state, &units, &discontinuities);
    let mut pace = PACE * scene.scale;
    let Some(lattice) = Lattice::new(&rows, &scene.prior(&units), reach, &mut pace) else {
        return (discontinuities, vec![*state]);
    };
    let marks: Vec<Mark> = rows.iter().map(|row| lattice.mark(row)).collect();
    let maps: Vec<EdgeMap> = scene.frames.iter().map(|frame| EdgeMap::new(&frame.planes, pace)).collect();
    let step = |place: &Place| {
        let parts = place.iter().zip(&lattice.steps).map(|(&k, step)| step * f64::from(k));
        units.step(state, &parts.sum())
    };
    let states = lattice.best(&maps, &marks).iter().map(step).collect();
    (discontinuities, states)
}

/// Derivatives of the pixel of each discontinuity with respect to the unknowns.
fn rows(
    frames: &[Frame],
    state: &State,
    units: &Units,
    discontinuities: &[Vec<Discontinuity>],
) -> Vec<(usize, Discontinuity, [Vector; 2])> {
    let of_frame = |(index, (frame, discontinuities)): (usize, (&Frame, &Vec<Discontinuity>))| -> Vec<_> {
        let camera = state.camera(&frame.camera);
        let row = |discontinuity: &Discontinuity| {
            let (_, rows) = units.rows(&state.pose.apply(frame.point(discontinuity.index)?), &camera)?;
            Some((index, *discontinuity, rows))
        };
        discontinuities.iter().filter_map(row).collect()
    };
    frames.iter().zip(discontinuities).enumerate().flat_map(of_frame).collect()
}

impl Lattice {
    /// `pace` is in pixels, and grows if the lattice would have too many places.
    fn new(rows: &[(usize, Discontinuity, [Vector; 2])], prior: &Matrix, sigmas: f64, pace: &mut f64) -> Option<Self> {
        let mut squares = Matrix::zeros();
        rows.iter().flat_map(|(_, _, rows)| rows).for_each(|row| add_square(&mut squares, row, 1.0));
        let motion = squares / (rows.len() as f64).max(1.0);
        let root = spectral(&symmetric_eigen(prior)?, |value| 1.0 / value.max(f64::MIN_POSITIVE).sqrt());
        let eigen = symmetric_eigen(&(root * motion * root))?;
        let order = descending(eigen.eigenvalues.as_slice());
        // Pixels by which one sigma moves the discontinuities along each direction.
        let lengths: [f64; UNKNOWNS] =
            std::array::from_fn(|k| eigen.eigenvalues[order[k]].max(f64::MIN_POSITIVE).sqrt());
        let reach = |pace: f64| lengths.map(|length| (sigmas * length / pace).min(f64::from(i8::MAX)) as i8);
        while reach(*pace).iter().map(|&k| 2.0 * f64::from(k) + 1.0).product::<f64>() > MOST_PLACES {
            *pace *= 1.1;
        }
        let reach = reach(*pace);
        // A direction that moves no discontinuity has no places: a step of one pace along it would overflow.
        let sigmas: [f64; UNKNOWNS] = std::array::from_fn(|k| if reach[k] > 0 { *pace / lengths[k] } else { 0.0 });
        let steps = std::array::from_fn(|k| root * eigen.eigenvectors.column(order[k]) * sigmas[k]);
        Some(Self { steps, sigmas, reach })
    }

    fn mark(&self, (frame, discontinuity, rows): &(usize, Discontinuity, [Vector; 2])) -> Mark {
        let narrow = |pair: [f64; 2]| pair.map(|value| value as f32);
        let motion = std::array::from_fn(|k| [0, 1].map(|axis| rows[axis].dot(&self.steps[k]) as f32));
        Mark { frame: *frame, pixel: narrow(discontinuity.pixel), normal: narrow(discontinuity.normal), motion }
    }

    /// The best places that are not neighbours, after the centre.
    fn best(&self, maps: &[EdgeMap], marks: &[Mark]) -> Vec<Place> {
        let (mut scores, mut places): (Vec<f64>, Vec<Place>) = (vec![], vec![]);
        let mut pixels = vec![[0.0; 2]; marks.len()];
        let mut place = self.reach.map(|k| -k);
        loop {
            // The motion along all but the first two directions is the same for a whole plane of places.
            for (pixel, mark) in pixels.iter_mut().zip(marks) {
                *pixel = (2..UNKNOWNS).fold(mark.pixel, |at, k| moved(at, mark.motion[k], place[k]));
            }
            for across in -self.reach[0]..=self.reach[0] {
                for down in -self.reach[1]..=self.reach[1] {
                    (place[0], place[1]) = (across, down);
                    scores.push(self.score(maps, marks, &pixels, &place));
                    places.push(place);
                }
            }
            let Some(next) = (2..UNKNOWNS).find(|&k| place[k] < self.reach[k]) else { break };
            place[next] += 1;
            (2..next).for_each(|k| place[k] = -self.reach[k]);
        }
        let mut chosen = vec![[0; UNKNOWNS]];
        for place in descending(&scores).into_iter().map(|index| places[index]) {
            if chosen.iter().all(|other| squared_distance(other, &place) > APART * APART) {
                chosen.push(place);
            }
            if chosen.len() > STARTS {
                break;
            }
        }
        chosen
    }

    /// Score of a place. `pixels` are the marks moved along all but the first two directions.
    fn score(&self, maps: &[EdgeMap], marks: &[Mark], pixels: &[[f32; 2]], place: &Place) -> f64 {
        let at = |(mark, pixel): (&Mark, &[f32; 2])| {
            let pixel = moved(moved(*pixel, mark.motion[0], place[0]), mark.motion[1], place[1]);
            maps[mark.frame].at(pixel, mark.normal)
        };
        let sum: f32 = marks.iter().zip(pixels).map(at).sum();
        let far: f64 = place.iter().zip(&self.sigmas).map(|(&k, sigma)| (f64::from(k) * sigma).powi(2)).sum();
        f64::from(sum) / (marks.len() as f64).max(1.0) - 0.5 * PRIOR_WEIGHT * far
    }
}

fn moved(pixel: [f32; 2], motion: [f32; 2], paces: i8) -> [f32; 2] {
    [0, 1].map(|axis| pixel[axis] + f32::from(paces) * motion[axis])
}

fn squared_distance(a: &Place, b: &Place) -> f64 {
    a.iter().zip(b).map(|(&a, &b)| (f64::from(a) - f64::from(b)).powi(2)).sum()
}

#[cfg(test)]
mod tests {
    use nalgebra::{Rotation3, Vector3};

    use super::*;
    use crate::numeric::noise;
    use crate::view::{Lens, Pinhole};

    /// The edge bias moves no discontinuity, so one eigenvalue is zero and rounds to either side. A step along it must
    /// not make the places of the other directions useless.
    #[test]
    fn every_step_of_the_lattice_is_finite() {
        let camera = Pinhole { fx: 600.0, fy: 600.0, cx: 320.0, cy: 240.0, lens: Lens::None };
        let mut random = noise::white_noise(3);
        let points: Vec<Vector3<f64>> =
            (0..60).map(|_| Vector3::new(0.3 * random(), 0.2 * random(), 2.0 + 0.3 * random())).collect();
        for turn in 0..40 {
            let rotation = Rotation3::new(Vector3::y() * 1e-7 * f64::from(turn));
            let points: Vec<Vector3<f64>> = points.iter().map(|point| rotation * point).collect();
            let units = Units::new(&points, &camera);
            let row = |point: &Vector3<f64>| {
                let (pixel, rows) = units.rows(point, &camera)?;
                Some((0, Discontinuity { index: 0, pixel, normal: [1.0, 0.0], gap: 1.0, in_gap: 1.0 }, rows))
            };
            let rows: Vec<_> = points.iter().filter_map(row).collect();
            let mut pace = PACE;
            let lattice = Lattice::new(&rows, &Matrix::identity(), 1.5, &mut pace).unwrap();
            let marks = rows.iter().map(|row| lattice.mark(row));
            assert!(marks.flat_map(|mark| mark.motion).flatten().all(f32::is_finite), "turn {turn}");
            assert!(lattice.sigmas.iter().all(|sigma| sigma.is_finite()), "turn {turn}");
        }
    }
}
