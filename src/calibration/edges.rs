//! Depth edges on image edges: the log likelihood of the positions of image edges, given the projected depth
//! discontinuities.
//!
//! Along the normal of each depth discontinuity the image has edges at offsets u_k with strengths a_k. With probability
//! 1 - e one of them belongs to the discontinuity. The probability of an edge is proportional to its strength, and its
//! position deviates by the edge bias d of its side and by normal noise s:
//!
//! l = sum over discontinuities of log(e / 2 L + (1 - e) sum_k p_k N(u + d - u_k; s)),
//! p_k = a_k / sum a, s^2 = sigma^2 + g^2 / 12,
//!
//! where u moves with the pose. The near surface ends anywhere within the gap g between two samples of the depth map,
//! so that a coarse map weighs less than a fine one. The check never decides which edge belongs to which discontinuity,
//! and a discontinuity in front of texture has little weight. The levels go from wide windows on a blurred image to
//! narrow ones. Each round finds the edges anew and takes a Gauss-Newton step with the responsibilities (expectation
//! maximisation).
//!
//! No discontinuity lowers l, so a pose gains by bringing more of them onto texture. Where poses are compared, each term
//! is reduced by its mean over all shifts of the edges, which is what it has by chance.

use super::discontinuities::{self, Discontinuity};
use super::evidence::{Share, Tiles};
use super::frame::{Frame, Projection};
use super::patches::Sight;
use super::planes::Planes;
use super::unknowns::{BIAS, SIDES, State, Units, Vector, add_square};
use crate::numeric::{quantile, sort_descending};
use crate::view::Size;

/// e, the share of depth discontinuities whose edge is not visible in the image.
const MISSING: f64 = 0.3;
/// Least half width L of a window, pixels of an image 640 wide.
const WIDEST: f64 = 14.0;
/// Ratio of the width of a uniform distribution to its standard deviation: the square root of twelve.
const EVEN: f64 = 3.464_101_615_137_754_6;
/// Half width L of a window in standard deviations s.
const WINDOW: f64 = 3.0;
/// Maximum number of edges in a profile; the strongest are kept.
const MOST_EDGES: usize = 12;
/// Strength below which edges are noise: the norm over the channels of differences of encoded intensities.
const FAINTEST: f32 = 0.012;
/// Smallest factor on the curvature of the bound. The factor varies from round to round, and a small one would make
/// steps diverge.
const LEAST_LEFT: f64 = 0.1;
/// Ratio of the image's blur to sigma, and the smallest blur in pixels.
const BLUR: f64 = 0.35;
const LEAST_BLUR: f64 = 0.7;

/// The image edges near one depth discontinuity.
#[derive(Clone)]
struct Profile {
    discontinuity: Discontinuity,
    /// Derivative of u with respect to the unknowns.
    row: Vector,
    /// Standard deviation s of the position at which the near surface ends, pixels.
    sigma: f64,
    window: f64,
    /// Weight of the profile, at most 1: its share of an independent discontinuity.
    weight: f64,
    tile: u32,
    edges: Vec<(f64, f64)>,
}

impl Profile {
    /// Density of an edge that is not visible, and the greatest density of a visible one.
    fn densities(&self) -> [f64; 2] {
        [MISSING / (2.0 * self.window), (1.0 - MISSING) / (self.sigma * std::f64::consts::TAU.sqrt())]
    }

    /// Mean of the log likelihood over all shifts of the edges, in steps of about one standard deviation. The window is taken as a
    /// circle.
    fn by_chance(&self) -> f64 {
        let [background, peak] = self.densities();
        let width = 2.0 * self.window;
        let steps = (width / self.sigma).ceil();
        let at = |shift: f64| {
            let density = |&(offset, share): &(f64, f64)| {
                let around = if offset + shift > self.window { width } else { 0.0 };
                let error = (offset + shift - around) / self.sigma;
                share * (-0.5 * error * error).exp()
            };
            (1.0 + peak / background * self.edges.iter().map(density).sum::<f64>()).ln()
        };
        (0..steps as usize).map(|step| at((step as f64 + 0.5) / steps * width)).sum::<f64>() / steps
    }
}

/// The depth discontinuities of one frame with their profiles, for one state.
pub(super) struct EdgeField {
    profiles: Vec<Profile>,
    /// Number of tiles of the image.
    tiles: usize,
}

/// Blur of the image, in pixels, for edges whose positions have an error of `sigma` pixels.
pub(super) fn blur(sigma: f64) -> f64 {
    (BLUR * sigma).max(LEAST_BLUR)
}

impl EdgeField {
    /// The depth discontinuities that the colour camera sees, at most `most`.
    pub fn discontinuities(frame: &Frame, projection: &Projection, most: usize) -> Vec<Discontinuity> {
        let mut discontinuities = discontinuities::find(frame, projection);
        let found = discontinuities.len();
        keep(&mut discontinuities, frame.grid, most);
        let kept = discontinuities.len() as f64 / found.max(1) as f64;
        discontinuities
            .iter_mut()
            .for_each(|discontinuity| discontinuity.in_gap = 1.0 + kept * (discontinuity.in_gap - 1.0));
        discontinuities
    }

    /// Depth discontinuities that were found at one state, moved to their projections under another state.
    pub fn moved(frame: &Frame, discontinuities: &[Discontinuity], found: &State, state: &State) -> Vec<Discontinuity> {
        let camera = state.camera(&frame.camera);
        let place = |state: &State, discontinuity: &Discontinuity| {
            let [x, y, z] = state.pose.apply(frame.point(discontinuity.index)?).into();
            camera.project([x, y, z])
        };
        let moved = |discontinuity: &Discontinuity| {
            let (to, from) = (place(state, discontinuity)?, place(found, discontinuity)?);
            Some(Discontinuity { pixel: [0, 1].map(|k| discontinuity.pixel[k] + to[k] - from[k]), ..*discontinuity })
        };
        discontinuities.iter().filter_map(moved).collect()
    }

    /// Projects the discontinuities by `state` and finds the image edges near them, on planes that are blurred for this
    /// `sigma`.
    pub fn new(
        Sight { frame, planes }: Sight<'_>,
        discontinuities: &[Discontinuity],
        state: &State,
        units: &Units,
        sigma: f64,
    ) -> Self {
        let blur = blur(sigma);
        let camera = state.camera(&frame.camera);
        let widest = WIDEST * planes.size.width as f64 / 640.0;
        let tiles = Tiles::new(planes.size);
        let profile = |discontinuity: &Discontinuity| {
            let point = state.pose.apply(frame.point(discontinuity.index)?);
            let (_, rows) = units.rows(&point, &camera)?;
            let mut row = rows[0] * discontinuity.normal[0] + rows[1] * discontinuity.normal[1];
            row.fixed_rows_mut::<SIDES>(BIAS).copy_from_slice(&State::sides(discontinuity.normal));
            let bias = state.bias_along(discontinuity.normal);
            let start = [0, 1].map(|k| discontinuity.pixel[k] + bias * discontinuity.normal[k]);
            // The variance of a uniform distribution over the gap adds to that of the edges.
            let of_gap = discontinuity.gap / EVEN;
            let sigma = sigma.hypot(of_gap);
            // Neighbours in one gap share its error. The variance of their mean is that of this many independent
            // discontinuities.
            let weight = 1.0 / (1.0 + (discontinuity.in_gap - 1.0) * (of_gap / sigma).powi(2));
            let window = (WINDOW * sigma).max(widest);
            let edges = edges(planes, start, discontinuity.normal, window, blur)?;
            Some(Profile {
                discontinuity: *discontinuity,
                row,
                sigma,
                window,
                weight,
                tile: tiles.of(discontinuity.pixel),
                edges,
            })
        };
        Self { profiles: discontinuities.iter().filter_map(profile).collect(), tiles: tiles.count() }
    }

    /// The log likelihood and its gradient at the state of the field, tile by tile. The curvature is that of the
    /// bound of expectation maximisation, which is never negative. A factor reduces it, because discontinuities may
    /// change their edges.
    pub fn shares(&self) -> Vec<Share> {
        let mut shares = vec![Share::none(); self.tiles];
        let (mut bounds, mut own) = (0.0, 0.0);
        for profile in &self.profiles {
            let sigma = profile.sigma;
            let [background, peak] = profile.densities();
            let (mut total, mut first, mut second) = (0.0, 0.0, 0.0);
            for &(offset, share) in &profile.edges {
                let error = offset / sigma;
                let density = peak * share * (-0.5 * error * error).exp();
                total += density;
                first += density * error;
                second += density * error * error;
            }
            let whole = total + background;
            let slope = first / whole / sigma;
            let bound = total / whole / (sigma * sigma);
            let weight = profile.weight;
            bounds += weight * bound;
            own += weight * (bound - second / whole / (sigma * sigma) + slope * slope);
            let share = &mut shares[profile.tile as usize];
            share.value += weight * (whole / background).ln();
            share.gradient += profile.row * (weight * slope);
            add_square(&mut share.curvature, &profile.row, weight * bound);
        }
        // Without discontinuities the curvature is zero, and its factor is arbitrary.
        let left = if bounds > 0.0 { (own / bounds).clamp(LEAST_LEFT, 1.0) } else { 1.0 };
        shares.iter_mut().for_each(|share| share.curvature *= left);
        shares
    }

    /// What the log likelihood of each tile has by chance: its mean over all shifts of the edges.
    pub fn by_chance(&self) -> Vec<f64> {
        let mut tiles = vec![0.0; self.tiles];
        for profile in &self.profiles {
            tiles[profile.tile as usize] += profile.weight * profile.by_chance();
        }
        tiles
    }

    /// The discontinuities for which edges were searched.
    pub fn all(&self) -> impl Iterator<Item = &Discontinuity> {
        self.profiles.iter().map(|profile| &profile.discontinuity)
    }

    /// The same edges with other derivatives, without the discontinuities that have none.
    pub fn carried(&self, row: impl Fn(&Discontinuity) -> Option<Vector>) -> Self {
        let carried = |profile: &Profile| Some(Profile { row: row(&profile.discontinuity)?, ..profile.clone() });
        Self { profiles: self.profiles.iter().filter_map(carried).collect(), tiles: self.tiles }
    }

    pub fn len(&self) -> usize {
        self.profiles.len()
    }

    /// The number of independent discontinuities.
    pub fn weight(&self) -> f64 {
        self.profiles.iter().map(|profile| profile.weight).sum()
    }
}

/// Keeps at most `most` discontinuities, evenly spread. Each pixel of the raster has a fixed rank. A discontinuity that
/// appears therefore replaces only one other.
fn keep(discontinuities: &mut Vec<Discontinuity>, grid: Size, most: usize) {
    if discontinuities.len() <= most {
        return;
    }
    // The fractional parts of multiples of these irrational numbers fill the unit interval evenly along any line of the
    // raster (Roberts 2018, the sequence R2).
    let rank = |discontinuity: &Discontinuity| {
        let (column, row) = grid.position(discontinuity.index);
        (0.754_877_666_246_692_8 * column as f64 + 0.569_840_290_998_053_3 * row as f64).fract() as f32
    };
    let mut ranks: Vec<f32> = discontinuities.iter().map(rank).collect();
    let limit = quantile(&mut ranks, most as f64 / discontinuities.len() as f64);
    discontinuities.retain(|discontinuity| rank(discontinuity) < limit);
}

/// Offsets and shares of the strongest edges along a normal; `None` if the discontinuity lies off the image.
fn edges(planes: &Planes, start: [f64; 2], normal: [f64; 2], window: f64, blur: f64) -> Option<Vec<(f64, f64)>> {
    // Samples are half a blur apart, so that a parabola through three of them finds the maximum of an edge.
    let pace = (0.5 * blur).max(0.5);
    let half = (window / pace).ceil() as isize;
    let at = |k: isize| {
        let offset = k as f64 * pace;
        planes.at([start[0] + offset * normal[0], start[1] + offset * normal[1]])
    };
    if at(0)[0].is_nan() {
        return None;
    }
    let samples: Vec<[f32; 3]> = (-half - 2..=half + 2).map(at).collect();
    let strength = |k: usize| -> f32 {
        let (a, b) = (samples[k + 1], samples[k - 1]);
        let square: f32 = (0..3).map(|c| (a[c] - b[c]).powi(2)).sum();
        if square.is_nan() { 0.0 } else { square.sqrt() }
    };
    let strengths: Vec<f32> = (1..samples.len() - 1).map(strength).collect();
    let mut edges: Vec<(f64, f64)> = (1..strengths.len() - 1)
        .filter(|&k| strengths[k] > FAINTEST && strengths[k] >= strengths[k - 1] && strengths[k] > strengths[k + 1])
        .map(|k| {
            let [a, b, c] = [strengths[k - 1], strengths[k], strengths[k + 1]].map(f64::from);
            let shift = 0.5 * (a - c) / (a - 2.0 * b + c).min(-1e-12);
            ((k as f64 + shift - (half + 1) as f64) * pace, b)
        })
        .collect();
    sort_descending(&mut edges, |edge| edge.1);
    edges.truncate(MOST_EDGES);
    let total: f64 = edges.iter().map(|edge| edge.1).sum();
    edges.iter_mut().for_each(|edge| edge.1 /= total);
    Some(edges)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Random;

    /// Mean log likelihood, less that by chance, of discontinuities with these offsets and shares of edges.
    fn mean(edges: Vec<Vec<(f64, f64)>>) -> f64 {
        let discontinuity = Discontinuity { index: 0, pixel: [0.0; 2], normal: [1.0, 0.0], gap: 1.0, in_gap: 1.0 };
        let common = Profile {
            discontinuity,
            row: Vector::zeros(),
            sigma: 1.3,
            window: WIDEST,
            weight: 1.0,
            tile: 0,
            edges: vec![],
        };
        let profiles: Vec<Profile> = edges.into_iter().map(|edges| Profile { edges, ..common.clone() }).collect();
        let field = EdgeField { profiles, tiles: 1 };
        (field.shares()[0].value - field.by_chance()[0]) / field.len() as f64
    }

    #[test]
    fn discontinuities_on_texture_gain_nothing_unless_one_of_the_edges_is_theirs() {
        let mut random = Random::new(3, 0);
        for count in [0, 1, 3, 12] {
            let mut texture = |own: &[f64]| -> Vec<(f64, f64)> {
                let anywhere = (0..count).map(|_| WIDEST * (2.0 * random.uniform() - 1.0));
                let share = 1.0 / (count + own.len()) as f64;
                own.iter().copied().chain(anywhere).map(|offset| (offset, share)).collect()
            };
            let by_chance = mean((0..4000).map(|_| texture(&[])).collect());
            let matched = mean((0..4000).map(|_| texture(&[0.5])).collect());
            assert!(by_chance.abs() < 0.04, "{count}: {by_chance}");
            assert!(matched > 0.2, "{count}: {matched}");
        }
    }
}
