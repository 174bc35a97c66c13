//! Intensities of a scanner's returns as levels of equal count (histogram equalisation).
//!
//! Every scanner stores the strength of a return in another unit, often as a curved function of reflectivity. Mutual
//! information with the image needs no unit: only the order of the intensities counts (Koide, Oishi, Yokozuka and Banno
//! 2023).

use super::surface::Sample;
use crate::numeric::quantile;

/// Levels of equal count: as many as a channel of the image has.
pub(super) const LEVELS: usize = 16;
/// The level of a sample without intensity, which is none of a table's rows.
pub(super) const UNKNOWN: u8 = u8::MAX;

/// Gives each sample the level of its intensity among all samples of the frame, seen or not, so that it does not depend
/// on the pose. Equal intensities have one level.
pub(super) fn equalise(samples: &mut [Sample], intensity: &[f32]) {
    let of = |sample: &Sample| intensity.get(sample.index).copied().filter(|value| value.is_finite());
    let mut known: Vec<f32> = samples.iter().filter_map(of).collect();
    if known.is_empty() {
        return;
    }
    let edges: [f32; LEVELS - 1] = std::array::from_fn(|edge| quantile(&mut known, (edge + 1) as f64 / LEVELS as f64));
    for sample in samples {
        let level = |value: f32| edges.iter().filter(|&&edge| value >= edge).count() as u8;
        sample.level = of(sample).map_or(UNKNOWN, level);
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::calibration::frame::{Frame, Projection};
    use crate::calibration::information::Information;
    use crate::calibration::patches::{Patches, Sight, group};
    use crate::calibration::planes::Planes;
    use crate::calibration::surface::samples;
    use crate::calibration::unknowns::State;
    use crate::pose::Similarity;
    use crate::view::{Lens, Pinhole, Size};

    const SIZE: Size = Size { width: 64, height: 48 };
    const FOCAL: f64 = 60.0;
    const DISTANCE: f64 = 2.0;
    /// Farthest shift, pixels.
    const FARTHEST: i32 = 3;

    /// Grey values without a period.
    fn pattern(index: usize) -> f32 {
        let (column, row) = SIZE.position(index);
        let (x, y) = (column as f32, row as f32);
        0.5 + 0.25 * (0.41 * x + 0.003 * x * y).sin() + 0.2 * (0.53 * y - 0.004 * x * x).cos()
    }

    /// A painted plane as the camera sees it, with a point for each pixel that stays on the image.
    fn painted(intensity: Option<&dyn Fn(f32) -> f32>) -> Frame {
        let camera = Pinhole { fx: FOCAL, fy: FOCAL, cx: 31.5, cy: 23.5, lens: Lens::None };
        let margin = FARTHEST as usize + 1;
        let point = |index: usize| {
            let (column, row) = SIZE.position(index);
            let inside = |at: usize, side: usize| at >= margin && at + margin < side;
            if !(inside(column, SIZE.width) && inside(row, SIZE.height)) {
                return [f32::NAN; 3];
            }
            let along = |at: usize, centre: f64| ((at as f64 - centre) / FOCAL * DISTANCE) as f32;
            [along(column, 31.5), along(row, 23.5), DISTANCE as f32]
        };
        let planes = Planes { size: SIZE, pixels: (0..SIZE.len()).map(|index| [pattern(index); 3]).collect() };
        let points = (0..SIZE.len()).map(point).collect();
        let mut frame = Frame::new(String::new(), planes, camera, SIZE, points);
        frame.intensity = intensity.map(|of| (0..SIZE.len()).map(|index| of(pattern(index))).collect());
        frame
    }

    /// The log likelihood at every shift by whole pixels, the right pose first.
    fn values(frame: &Frame) -> Vec<f64> {
        let mut samples = samples(frame, SIZE.len());
        group(&mut samples);
        let right = State::at(Similarity::identity());
        let patches = Patches::new(&samples, &Projection::new(frame, &right), frame);
        let sight = Sight { frame, planes: &frame.planes };
        let of = |[x, y]: [i32; 2]| {
            let shift = Vector3::new(f64::from(x), f64::from(y), 0.0) * (DISTANCE / FOCAL);
            let mut out = vec![0.0; 100];
            let state = State::at(Similarity { translation: shift, ..Similarity::identity() });
            Information(&patches).evaluate(&sight, &state, &mut out);
            out.iter().sum::<f64>()
        };
        let shifts = (-FARTHEST..=FARTHEST).flat_map(|x| (-FARTHEST..=FARTHEST).map(move |y| [x, y]));
        [[0, 0]].into_iter().chain(shifts.filter(|shift| *shift != [0, 0])).map(of).collect()
    }

    #[test]
    fn paint_is_found_at_the_right_pose_whatever_the_curve_of_the_intensity() {
        let plain = values(&painted(None));
        let curves: [&dyn Fn(f32) -> f32; 3] =
            [&|grey| 200.0 * grey, &|grey| -grey.powi(3), &|grey| (grey - 0.5).abs()];
        for (index, curve) in curves.into_iter().enumerate() {
            let found = values(&painted(Some(curve)));
            // What the intensity adds.
            let added: Vec<f64> = found.iter().zip(&plain).map(|(found, plain)| found - plain).collect();
            let next = added[1..].iter().copied().fold(f64::NEG_INFINITY, f64::max);
            assert!(added[0] > 1.2 * next && next > 0.0, "curve {index}: {} and {next}", added[0]);
            assert!(found[1..].iter().all(|value| *value < found[0]), "curve {index}");
        }
    }

    #[test]
    fn only_the_order_of_intensities_counts_and_unknown_ones_count_nowhere() {
        let linear = values(&painted(Some(&|grey| grey)));
        assert_eq!(values(&painted(Some(&|grey| (9.0 * grey).exp()))), linear);
        assert_eq!(values(&painted(Some(&|_| f32::NAN))), values(&painted(None)));
    }

    #[test]
    fn levels_have_equal_counts_and_equal_intensities_one_level() {
        let sample = |index| Sample { index, point: Vector3::zeros(), normal: Vector3::z(), patch: 0, level: UNKNOWN };
        let levels = |intensity: &[f32]| {
            let mut samples: Vec<Sample> = (0..intensity.len()).map(sample).collect();
            equalise(&mut samples, intensity);
            samples.into_iter().map(|sample| sample.level).collect::<Vec<u8>>()
        };
        let all: Vec<f32> = (0..1600).map(|index| ((7 * index) % 1600) as f32).collect();
        let found = levels(&all);
        for level in 0..LEVELS as u8 {
            let count = found.iter().filter(|&&other| other == level).count();
            assert!(count.abs_diff(100) <= 1, "{count} at level {level}");
        }
        let few = levels(&[3.0, f32::NAN, 1.0, 3.0, f32::INFINITY]);
        assert_eq!((few[0], few[1], few[4]), (few[3], UNKNOWN, UNKNOWN));
        assert!(few[2] < few[0]);
        assert_eq!(levels(&[f32::NAN; 3]), [UNKNOWN; 3]);
    }
}
