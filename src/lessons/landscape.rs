//! The objective of one pixel over all normals that a camera can see (Eq. 6; docs/method/normals.md), for display: its
//! values, its minima with the share of the hemisphere that leads to each, and the steps of one descent.
//!
//! Terms, descent and starts are those of [`ShadingSolver`]. Limits: the values are those of unit normals, whereas a
//! descent is held to unit length only by lambda_3; under a single colour the minima form a curve, of which some points
//! are reported.

use crate::light::{Light, Polynomial};
use crate::numeric::{LANES, Lanes, Mask};
use crate::shape::{
    LinearisedPixels, MOST_DESCENT_STEPS, Pixels, STEEPEST_N_Z, ShadingProblem, ShadingReport, ShadingSolver,
    ShadingWeights, normalise,
};
use crate::view::Normals;

/// Two ends of descents closer than this, 3 degrees, are one minimum. A descent stops within a tenth of a degree of the
/// minimum, and minima of a quadratic form of second order are tens of degrees apart.
const SAME: f32 = 0.05;

/// A local minimum of a pixel's objective.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Minimum {
    /// Unit normal.
    pub normal: [f32; 3],
    /// The objective there.
    pub objective: f32,
    /// Share of the hemisphere's directions from which the descent ends at this minimum.
    pub share: f32,
}

/// The objective of one pixel.
#[derive(Clone, Debug)]
pub struct PixelLandscape {
    /// Values of the objective as seen from the camera, `side` rows of `side`: n_x grows with the column and n_y with
    /// the row, both from -1 to 1. NaN where there is no normal.
    pub objective: Vec<f32>,
    /// The minima, lowest first.
    pub minima: Vec<Minimum>,
    /// Normals after each step of the descent from the start; the last one is its end.
    pub path: Vec<[f32; 3]>,
}

impl PixelLandscape {
    /// The landscape of a pixel with these logarithms of R, G, B; a `prior` of NaN means no prior.
    #[must_use]
    pub fn new(
        log: [f32; 3],
        prior: [f32; 3],
        light: &Light,
        weights: ShadingWeights,
        start: [f32; 3],
        side: usize,
    ) -> Self {
        let mut priors = Normals::missing(LANES);
        (0..LANES).for_each(|lane| priors.set(lane, prior));
        let log = log.map(|value| [value; LANES]);
        let problem = ShadingProblem { log: [&log[0], &log[1], &log[2]], prior: &priors, light };
        let polynomials = Polynomial::of(light);
        let pixel = Pixels::new(problem, 0, weights, &polynomials);
        Self { objective: values(&pixel, side), minima: minima(&pixel), path: path(&pixel, start) }
    }
}

/// Four normals side by side, with the first one in place of missing ones.
#[inline(never)]
fn four(normals: &[[f32; 3]]) -> [Lanes; 3] {
    let normal = |lane: usize| normals.get(lane).or(normals.first()).copied().unwrap_or([f32::NAN; 3]);
    [0, 1, 2].map(|axis| Lanes::from(std::array::from_fn(|lane| normal(lane)[axis])))
}

fn values(pixel: &Pixels<'_>, side: usize) -> Vec<f32> {
    let coordinate = |place: usize| (2 * place + 1) as f32 / side as f32 - 1.0;
    let mut values = vec![f32::NAN; side * side];
    for (block, values) in values.chunks_mut(LANES).enumerate() {
        let normals: [[f32; 3]; LANES] = std::array::from_fn(|lane| {
            let place = block * LANES + lane;
            let (x, y) = (coordinate(place % side), coordinate(place / side));
            // Beyond the hemisphere's edge the root is NaN, because there is no normal.
            [x, y, -(1.0 - x * x - y * y).sqrt()]
        });
        objective(pixel, four(&normals)).store(values);
    }
    values
}

/// Ends of the descents from all over the hemisphere, except those stopped at its edge; the lowest first.
fn minima(pixel: &Pixels<'_>) -> Vec<Minimum> {
    let directions = ShadingSolver::new().directions;
    let share = 1.0 / directions.len() as f32;
    let mut found: Vec<Minimum> = Vec::new();
    for block in directions.chunks_exact(LANES) {
        let ends = normalise(descend(pixel, four(block), MOST_DESCENT_STEPS).0);
        let objective = objective(pixel, ends).array();
        let ends = ends.map(Lanes::array);
        for lane in 0..LANES {
            let (normal, objective) = (ends.map(|axis| axis[lane]), objective[lane]);
            if normal[2].is_nan() || normal[2] > STEEPEST_N_Z {
                continue;
            }
            match found.iter_mut().find(|minimum| is_same(minimum.normal, normal)) {
                Some(minimum) => minimum.share += share,
                None => {
                    // The minima are inserted in order, because there are only a few.
                    let place = found.iter().take_while(|minimum| minimum.objective <= objective).count();
                    found.insert(place, Minimum { normal, objective, share });
                }
            }
        }
    }
    found
}

/// The objective of four normals. Not inlined: it has two callers, and each copy adds to the download.
#[inline(never)]
fn objective(pixel: &Pixels<'_>, normals: [Lanes; 3]) -> Lanes {
    pixel.objective(normals)
}

fn is_same(a: [f32; 3], b: [f32; 3]) -> bool {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f32>() < SAME * SAME
}

/// The descent stopped after one trial, two trials, and so on; rejected trials leave the normal in place.
fn path(pixel: &Pixels<'_>, start: [f32; 3]) -> Vec<[f32; 3]> {
    let mut path = vec![start];
    for steps in 1..=MOST_DESCENT_STEPS {
        let (normal, ended) = descend(pixel, four(&[start]), steps);
        let normal = normal.map(|axis| axis.array()[0]);
        if path.last() != Some(&normal) {
            path.push(normal);
        }
        if ended {
            break;
        }
    }
    path
}

/// Ends of descents after this many trials, and whether all of them have ended.
#[inline(never)]
fn descend(pixel: &Pixels<'_>, start: [Lanes; 3], steps: usize) -> ([Lanes; 3], bool) {
    let mut counts = ShadingReport::default();
    let here: LinearisedPixels = pixel.linearise(start);
    let known: Mask = start[2].finite();
    let normal = pixel.descend(start, here, known, steps, &mut counts);
    (normal, counts.capped == 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const WEIGHTS: ShadingWeights = ShadingWeights { prior: 0.0, unit: 1.0, robust: None };
    const NONE: [f32; 3] = [f32::NAN; 3];
    const TRUTH: [f32; 3] = [0.36, -0.48, -0.8];

    fn colourful() -> Light {
        Light([
            [-1.2, 0.1, -0.9, 0.7, 0.1, 0.2, 0.15, -0.2, -0.1],
            [-1.1, 0.8, -0.7, -0.3, -0.2, -0.15, -0.1, -0.1, 0.2],
            [-1.3, -0.6, -0.8, -0.5, 0.15, -0.1, 0.1, 0.25, 0.1],
        ])
    }

    fn log(light: &Light) -> [f32; 3] {
        light.shade(TRUTH.map(f64::from)).map(|value| value as f32)
    }

    #[test]
    fn its_values_are_the_terms_of_the_paper() {
        let (light, prior, side) = (colourful(), [-0.6_f32, 0.0, -0.8], 21);
        for weights in [ShadingWeights { prior: 0.3, ..WEIGHTS }, ShadingWeights::with_robust_prior(0.3, 1.0)] {
            let landscape = PixelLandscape::new(log(&light), prior, &light, weights, TRUTH, side);
            assert_eq!(landscape.objective.len(), side * side);
            for (place, value) in landscape.objective.iter().enumerate() {
                let [x, y] = [place % side, place / side].map(|place| (2.0 * place as f64 + 1.0) / side as f64 - 1.0);
                if x * x + y * y > 1.0 {
                    assert!(value.is_nan());
                    continue;
                }
                let normal = [x, y, -(1.0 - x * x - y * y).sqrt()];
                let off: f64 = normal.iter().zip(prior).map(|(n, m)| (n - f64::from(m)).powi(2)).sum();
                let colour: f64 =
                    light.shade(normal).iter().zip(log(&light)).map(|(a, b)| (a - f64::from(b)).powi(2)).sum();
                let scale = weights.robust.map_or(0.0, |scale| 1.0 / f64::from(scale * scale));
                let expected = colour + 0.3 * off / (1.0 + off * scale);
                assert!((f64::from(*value) - expected).abs() < 1e-4 * (1.0 + expected), "{value} {expected}");
            }
        }
    }

    #[test]
    fn its_lowest_minimum_and_the_end_of_the_path_are_the_solvers() {
        let light = colourful();
        let colours = log(&light);
        let logs = colours.map(|value| [value]);
        let prior = Normals::missing(1);
        let mut solved = Normals::missing(1);
        let problem = ShadingProblem { log: [&logs[0], &logs[1], &logs[2]], prior: &prior, light: &light };
        ShadingSolver::new().solve(problem, WEIGHTS, &mut solved);
        let landscape = PixelLandscape::new(colours, NONE, &light, WEIGHTS, [0.0, 0.0, -1.0], 8);
        let lowest = landscape.minima[0];
        assert!(is_same(lowest.normal, solved.get(0)) && is_same(lowest.normal, TRUTH), "{lowest:?}");
        assert!(lowest.objective < 1e-6 && lowest.share > 0.1);
        assert!(landscape.minima.iter().map(|minimum| minimum.share).sum::<f32>() < 1.001);
        assert!(landscape.minima.is_sorted_by_key(|minimum| minimum.objective));
        let end = landscape.path[landscape.path.len() - 1];
        assert!(landscape.minima.iter().any(|minimum| is_same(minimum.normal, end)));
        assert_eq!(landscape.path[0], [0.0, 0.0, -1.0]);
    }

    #[test]
    fn one_grey_light_leaves_a_curve_and_a_prior_one_point_of_it() {
        let grey = Light([colourful().0[0]; 3]);
        let colours = log(&grey);
        let alone = PixelLandscape::new(colours, NONE, &grey, WEIGHTS, TRUTH, 8);
        assert!(alone.minima.iter().filter(|minimum| minimum.objective < 1e-4).count() > 10);
        let weights = ShadingWeights { prior: 0.1, ..WEIGHTS };
        let held = PixelLandscape::new(colours, TRUTH, &grey, weights, TRUTH, 8);
        assert!(is_same(held.minima[0].normal, TRUTH));
        assert!(held.minima.len() < 5, "{:?}", held.minima);
    }

    #[test]
    fn nothing_known_is_flat_and_bad_numbers_are_no_panic() {
        let landscape = PixelLandscape::new([f32::NAN; 3], NONE, &colourful(), WEIGHTS, [f32::NAN; 3], 5);
        assert!(landscape.objective.iter().filter(|value| value.is_finite()).all(|value| *value < 1e-6));
        assert!(PixelLandscape::new([0.0; 3], NONE, &colourful(), WEIGHTS, TRUTH, 0).objective.is_empty());
    }
}
