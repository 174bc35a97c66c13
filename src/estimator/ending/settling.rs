//! Settled shapes, which the next iteration keeps (docs/method/loop.md).
//!
//! Once the pose no longer moves, two shapes still do: the image's, from the colours and the depth view's normals, and
//! the depth view's, from the colours and the image's normals. A shape has settled if its last solve moved it by less
//! than a tenth of a sigma, and if the other one's normals have moved by less than that since. It is kept until the
//! other one has moved far enough; movements add up from its last solve on, so that slow ones count as well. If both
//! have settled, an iteration costs nothing.
//!
//! The movement of normals is the root mean square change of the colours that they predict, in units of the image's
//! noise. That of heights is their median change in units of [`HEIGHT_SIGMA`], because the median ignores unconnected
//! parts.

use nalgebra::{Matrix3, Vector3};

use crate::estimator::gauge;
use crate::estimator::pair::ViewPair;
use crate::estimator::solution::{Accepted, Shape, Solution};
use crate::light::Light;
use crate::numeric::quantile;
use crate::view::{Normals, Size};

/// Largest movement that counts as none, sigmas.
pub const TOLERANCE: f64 = 0.1;
/// Sigma of a height, pixel lengths: at best, surfaces from shading at 1 % noise are this accurate.
const HEIGHT_SIGMA: f64 = 0.05;
/// Largest number of pixels of each frame that are compared, on a square grid: their mean square is then accurate to a
/// few percent.
const MOST_PIXELS: usize = 4000;

/// How far both shapes are from rest.
pub struct Settling {
    /// Below zero, nothing ever settles.
    tolerance: f64,
    image: Movement,
    depth: Movement,
}

/// Movements of one shape.
#[derive(Clone, Copy)]
struct Movement {
    /// Movement by its own last solve.
    own: f64,
    /// Movement of the other shape's normals since then.
    input: f64,
    /// Whether both are within the tolerance, so that the next iteration keeps the shape.
    is_kept: bool,
}

/// An unsolved shape has not settled.
const UNKNOWN: Movement = Movement { own: f64::INFINITY, input: f64::INFINITY, is_kept: false };

impl Settling {
    pub const fn new(tolerance: f64) -> Self {
        Self { tolerance, image: UNKNOWN, depth: UNKNOWN }
    }

    /// Whether the next iteration keeps the image's shape.
    pub const fn keeps_image(&self) -> bool {
        self.image.is_kept
    }

    /// Whether the next iteration keeps the depth view's shape.
    pub const fn keeps_depth(&self) -> bool {
        self.depth.is_kept
    }

    /// Whether the next iteration changes nothing.
    pub const fn keeps_all(&self) -> bool {
        self.keeps_image() && self.keeps_depth()
    }

    /// Restarts if the last iteration used a new pose, albedo or start of the surface, or was rejected.
    pub const fn restart(&mut self) {
        *self = Self::new(self.tolerance);
    }

    /// Takes in how far the last iteration moved the shapes.
    pub fn advance(&mut self, [image, depth]: [Moved; 2]) {
        self.image.advance(self.tolerance, image, depth);
        self.depth.advance(self.tolerance, depth, image);
    }
}

impl Movement {
    /// Takes in an iteration that kept this shape, or solved it before the other one moved.
    fn advance(&mut self, tolerance: f64, this: Moved, other: Moved) {
        if !self.is_kept {
            (self.own, self.input) = (this.normals.max(this.heights), 0.0);
        }
        self.input += other.normals;
        self.is_kept = self.own <= tolerance && self.input <= tolerance;
    }
}

/// How far a shape has moved, sigmas.
#[derive(Clone, Copy, Debug)]
pub struct Moved {
    normals: f64,
    heights: f64,
}

/// How far the shapes of the image and of the depth view have moved since the `accepted` iteration, under one pose.
pub fn movements(pair: &ViewPair, accepted: &Accepted, solution: &Solution, spare: &mut Vec<f32>) -> [Moved; 2] {
    let Solution { pose, image, depth, .. } = solution;
    let lights = [accepted.light.total(), solution.light.total()];
    let pixel = gauge::pixel_length(&pair.image, solution);
    let own = Matrix3::identity();
    let views = [
        (pair.image.size, accepted.image(), image, &own, pixel),
        (pair.depth.size, accepted.depth(), depth, &pose.rotation, pixel / pose.scale),
    ];
    views.map(|(size, before, after, rotation, pixel)| {
        let [colours, depth] = change(size, &lights, before, after, rotation, spare);
        let normals = colours / pair.image.log_noise().max(f64::MIN_POSITIVE);
        Moved { normals, heights: depth / (HEIGHT_SIGMA * pixel) }
    })
}

/// Root mean square change per channel of the colours predicted under the first and the second light, and median change
/// of the depths. Infinite if there is nothing to compare.
#[inline(never)]
fn change(
    size: Size,
    lights: &[Light; 2],
    (normals, depths): (&Normals, &[f32]),
    after: &Shape,
    rotation: &Matrix3<f64>,
    spare: &mut Vec<f32>,
) -> [f64; 2] {
    let step = (size.len() / MOST_PIXELS).isqrt() + 1;
    spare.clear();
    let mut sum = 0.0;
    for row in (0..size.height).step_by(step) {
        for index in (row * size.width..(row + 1) * size.width).step_by(step) {
            let moved = (after.points.z[index] - depths[index]).abs();
            if moved.is_nan() || !normals.is_valid(index) || !after.normals.is_valid(index) {
                continue;
            }
            let mut off = [0.0; 3];
            for (sign, light, normals) in [(-1.0, &lights[0], normals), (1.0, &lights[1], &after.normals)] {
                let normal = rotation * Vector3::from(normals.get(index).map(f64::from));
                let shade = light.shade(normal.into());
                (0..3).for_each(|channel| off[channel] += sign * shade[channel]);
            }
            sum += off[0] * off[0] + off[1] * off[1] + off[2] * off[2];
            spare.push(moved);
        }
    }
    if spare.is_empty() {
        return [f64::INFINITY; 2];
    }
    let mean_square = sum / (3.0 * spare.len() as f64);
    [mean_square.sqrt(), f64::from(quantile(spare, 0.5))]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimator::Estimator;
    use crate::options::{LightSource, Options, Registration, Start};
    use crate::pose::Angles;
    use crate::report::Status;
    use crate::scenes::{Sample, SampleRequest, Scene, light, surface};
    use crate::view::{Camera, Lens, Pinhole};

    /// A pair of `side` pixels, turned by `beta`.
    fn sample(name: &str, lamps: &str, side: usize, beta: f64, depth_noise: f64, is_pinhole: bool) -> Sample {
        let (focal, middle) = (2.3 * side as f64, 0.5 * (side as f64 - 1.0));
        let pinhole = Pinhole { fx: focal, fy: focal, cx: middle, cy: middle, lens: Lens::None };
        let camera = if is_pinhole { Camera::Pinhole(pinhole) } else { Camera::Orthographic };
        let request = SampleRequest {
            light: light(lamps).unwrap(),
            size: Size { width: side, height: side },
            rotation: Angles { beta, ..Angles::default() }.rotation(),
            noise: 0.01,
            depth_noise,
            image_camera: camera,
            depth_camera: camera,
            ..SampleRequest::default()
        };
        Scene::new(&surface(name).unwrap()).unwrap().sample(&request).unwrap()
    }

    fn estimator(sample: &Sample, options: Options, tolerance: f64) -> Estimator {
        let start = Start::Pose {
            rotation: sample.pose.rotation,
            scale: Some(sample.pose.scale),
            translation: Some(sample.pose.translation),
        };
        let options = Options { start, ..options };
        let mut estimator = Estimator::new(sample.colour_image(), &sample.depth_map(), options).unwrap();
        estimator.settling = Settling::new(tolerance);
        estimator
    }

    /// Runs the loop to its end, and counts the solves that were skipped.
    fn ended(sample: &Sample, options: &Options, tolerance: f64) -> (Estimator, usize) {
        let mut estimator = estimator(sample, options.clone(), tolerance);
        let mut kept = 0;
        while estimator.report().status == Status::Running {
            kept += usize::from(estimator.settling.keeps_image()) + usize::from(estimator.settling.keeps_depth());
            estimator.step();
        }
        (estimator, kept)
    }

    /// Robust standard deviation of the difference of two depth maps, apart from a constant offset.
    fn deviation(a: &[f32], b: &[f32]) -> f64 {
        let mut off: Vec<f32> = a.iter().zip(b).map(|(a, b)| a - b).filter(|off| !off.is_nan()).collect();
        let level = quantile(&mut off, 0.5);
        off.iter_mut().for_each(|off| *off = (*off - level).abs());
        1.4826 * f64::from(quantile(&mut off, 0.5))
    }

    #[test]
    fn where_nothing_moves_outputs_keep_their_bits() {
        // The first of some scenes that keeps everything before its loop ends.
        let settled = |degrees: f64| {
            let sample = sample("vase", "overcast", 128, degrees, 0.0, false);
            let mut estimator = estimator(&sample, Options::default(), TOLERANCE);
            while !estimator.settling.keeps_all() && estimator.report().status == Status::Running {
                estimator.step();
            }
            (estimator.report().status == Status::Running).then_some(estimator)
        };
        let mut estimator = [30.0, 20.0, 40.0, 25.0, 35.0].into_iter().find_map(settled).expect("a scene that settles");
        let bits = |estimator: &Estimator| {
            let (image, depth) = (estimator.image_normals(), estimator.depth_normals());
            let rasters = [&image.x, &image.z, &depth.x, &depth.z].map(|it| it.as_slice());
            let depths = [&*estimator.image_depth(), estimator.refined_depth(), &*estimator.residual()];
            let bits = rasters.into_iter().chain(depths).flatten().map(|value| value.to_bits());
            (bits.collect::<Vec<_>>(), estimator.correspondence().into_owned(), estimator.light())
        };
        let (before, report) = (bits(&estimator), estimator.report().clone());
        let after = estimator.step().clone();
        assert!(bits(&estimator) == before);
        assert_eq!((after.iteration, &after.objective), (report.iteration + 1, &report.objective));
        assert_eq!((after.pose, after.overlap, after.residual), (report.pose, report.overlap, report.residual));
        assert_eq!(after.status, Status::Converged);
    }

    #[test]
    fn slow_movements_add_up() {
        let moved = |normals: f64| Moved { normals, heights: 0.0 };
        let mut settling = Settling::new(TOLERANCE);
        settling.advance([moved(0.01), moved(0.5)]);
        assert!(!settling.keeps_image() && !settling.keeps_depth());
        settling.advance([moved(0.01), moved(0.04)]);
        assert!(settling.keeps_image() && settling.keeps_depth());
        // The image is kept while its input moves on.
        settling.depth.is_kept = false;
        settling.advance([moved(0.0), moved(0.04)]);
        assert!(settling.keeps_image());
        settling.depth.is_kept = false;
        settling.advance([moved(0.0), moved(0.04)]);
        assert!(!settling.keeps_image());
        settling.advance([Moved { normals: 0.0, heights: 0.2 }, moved(0.0)]);
        assert!(!settling.keeps_image());
    }

    /// Tests of over three seconds: `cargo test` runs them, `npm test` only with `--long`.
    mod long {
        use super::*;

        #[test]
        fn what_has_settled_ends_within_a_tenth_of_its_sigma_of_the_full_solve() {
            let joint = Options::default();
            let fixed = Options { registration: Registration::Fixed, ..joint.clone() };
            let known = Options { light: LightSource::Known(light("window").unwrap()), ..joint.clone() };
            let mut left_out = 0;
            for (options, sample) in [
                (&joint, sample("vase", "overcast", 128, 30.0, 0.0, false)),
                (&joint, sample("vase", "window", 256, 40.0, 0.0, false)),
                (&joint, sample("ripples", "window", 256, 20.0, 0.0, true)),
                (&joint, sample("vase", "window", 256, 40.0, 0.1, true)),
                (&joint, sample("bust", "window", 128, 20.0, 0.3, false)),
                (&known, sample("bust", "window", 128, 20.0, 0.1, false)),
                (&known, sample("bust", "window", 128, 20.0, 0.0, false)),
                (&fixed, sample("bust", "overcast", 128, 60.0, 0.0, true)),
            ] {
                let (full, none) = ended(&sample, options, -1.0);
                let (found, kept) = ended(&sample, options, TOLERANCE);
                let [before, after] = [&full, &found].map(|it| it.report());
                assert!(none == 0 && after.status == before.status && after.iteration <= before.iteration, "{after:?}");
                assert!(after.pose.degrees_to(&before.pose) < 1e-9, "{after:?}");
                let image = [&*full.image_depth(), &*found.image_depth(), &sample.truth.image_depth];
                let depth = [full.refined_depth(), found.refined_depth(), &sample.truth.depth];
                for [full, found, truth] in [image, depth] {
                    let (apart, sigma) = (deviation(full, found), deviation(full, truth));
                    assert!(apart < 0.1 * sigma, "{apart} of {sigma}: {after:?}");
                }
                left_out += kept;
            }
            // At least one per scene; otherwise this would compare full solves with themselves.
            assert!(left_out >= 8, "{left_out}");
        }
    }
}
