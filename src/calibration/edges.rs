//! Depth edges on image edges: log likelihood of where the image's edges are, given where rims project to.
//!
//! Along the normal of each rim the image has some edges, at offsets u_k with strengths a_k. One of them is the rim's, with
//! a probability in proportion to its strength, and then off by the loss of outlines d and normal noise sigma; or none is:
//!
//! l = sum over rims of log(e / 2 L + (1 - e) sum_k p_k N(u + d - u_k; sigma)), p_k = a_k / sum a,
//!
//! where u moves with the pose. Which edge is whose is thus never decided, and a rim before texture weighs little by itself.
//! Coarse to fine: wide windows on a blurred image first. Each round looks for edges anew and takes a Gauss-Newton step by
//! the responsibilities (expectation maximisation).

use super::evidence::{Share, Tiles};
use super::frame::{Frame, Projection};
use super::patches::Sight;
use super::planes::Planes;
use super::rims::{self, Rim};
use super::unknowns::{LOSS, State, Units, Vector, add_square};

/// Share of rims whose edge the image does not show.
const MISSING: f64 = 0.3;
/// L at the least, pixels of an image 640 wide.
const WIDEST: f64 = 14.0;
/// Width of an even distribution over its standard deviation, the root of twelve.
const EVEN: f64 = 3.464_101_615_137_754_6;
/// L in sigmas.
const WINDOW: f64 = 3.0;
/// Edges of a profile, the strongest ones.
const MOST_EDGES: usize = 12;
/// An edge weaker than this is noise: differences of encoded intensities, all channels.
const FAINTEST: f32 = 0.012;
/// Of the bound's curvature at the least: what is left of it varies from round to round, and steps may not run away.
const LEAST_LEFT: f64 = 0.1;
/// Blur of the image over sigma, and the least, pixels.
const BLUR: f64 = 0.35;
const LEAST_BLUR: f64 = 0.7;

/// The edges beside one rim.
struct Profile {
    /// d u / d unknowns.
    row: Vector,
    /// Standard deviation of where the near surface ends, pixels.
    sigma: f64,
    window: f64,
    tile: u32,
    edges: Vec<(f64, f64)>,
}

/// Rims of one frame with their profiles, for one state.
pub(super) struct EdgeField {
    profiles: Vec<Profile>,
}

/// Blur, pixels, of the planes on which edges known within `sigma` pixels are looked for.
pub(super) fn blur(sigma: f64) -> f64 {
    (BLUR * sigma).max(LEAST_BLUR)
}

impl EdgeField {
    /// The rims that the colour camera sees, at most so many.
    pub fn rims(frame: &Frame, projection: &Projection, most: usize) -> Vec<Rim> {
        let all = rims::find(frame, projection);
        let stride = all.len().div_ceil(most).max(1);
        all.into_iter().step_by(stride).collect()
    }

    /// Rims that were found at one state where another one puts them.
    pub fn moved(frame: &Frame, rims: &[Rim], found: &State, state: &State) -> Vec<Rim> {
        let camera = state.camera(&frame.camera);
        let place = |state: &State, rim: &Rim| {
            let [x, y, z] = state.pose.apply(frame.point(rim.index)?).into();
            camera.project([x, y, z])
        };
        let moved = |rim: &Rim| {
            let (to, from) = (place(state, rim)?, place(found, rim)?);
            Some(Rim { pixel: [0, 1].map(|k| rim.pixel[k] + to[k] - from[k]), ..*rim })
        };
        rims.iter().filter_map(moved).collect()
    }

    /// The edges beside rims as `state` sees them, on planes blurred for edges known within `sigma` pixels.
    pub fn new(Sight { frame, planes }: Sight<'_>, rims: &[Rim], state: &State, units: &Units, sigma: f64) -> Self {
        let blur = blur(sigma);
        let camera = state.camera(&frame.camera);
        let widest = WIDEST * planes.size.width as f64 / 640.0;
        let tiles = Tiles::new(planes.size);
        let profile = |rim: &Rim| {
            let point = state.pose.apply(frame.point(rim.index)?);
            let (_, rows) = units.rows(&point, &camera)?;
            let mut row = rows[0] * rim.normal[0] + rows[1] * rim.normal[1];
            row[LOSS] = 1.0;
            let start = [0, 1].map(|k| rim.pixel[k] + state.loss * rim.normal[k]);
            // An even distribution over the gap, as a normal one.
            let sigma = sigma.hypot(rim.gap / EVEN);
            let window = (WINDOW * sigma).max(widest);
            let edges = edges(planes, start, rim.normal, window, blur)?;
            Some(Profile { row, sigma, window, tile: tiles.of(rim.pixel), edges })
        };
        Self { profiles: rims.iter().filter_map(profile).collect() }
    }

    /// Log likelihood with its gradient at the state of the field, tile by tile; the curvature is that of expectation
    /// maximisation's bound, which is never negative, times how much of it is left once rims may change their edges.
    pub fn evidence(&self, shares: &mut [Share]) {
        let (mut bounds, mut own) = (0.0, 0.0);
        for profile in &self.profiles {
            let sigma = profile.sigma;
            let background = MISSING / (2.0 * profile.window);
            let peak = (1.0 - MISSING) / (sigma * std::f64::consts::TAU.sqrt());
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
            bounds += bound;
            own += bound - second / whole / (sigma * sigma) + slope * slope;
            let share = &mut shares[profile.tile as usize];
            share.value += (whole / background).ln();
            share.gradient += profile.row * slope;
            add_square(&mut share.curvature, &profile.row, bound);
        }
        // Without any rim there is no curvature of which something could be left.
        let left = if bounds > 0.0 { (own / bounds).clamp(LEAST_LEFT, 1.0) } else { 1.0 };
        shares.iter_mut().for_each(|share| share.curvature *= left);
    }

    pub fn len(&self) -> usize {
        self.profiles.len()
    }
}

/// Offsets and shares of the strongest edges along a normal; `None` where the rim is off the image.
fn edges(planes: &Planes, start: [f64; 2], normal: [f64; 2], window: f64, blur: f64) -> Option<Vec<(f64, f64)>> {
    // Samples at half the blur, so that a parabola through three of them finds the top of an edge.
    let pace = (0.5 * blur).max(0.5);
    let half = (window / pace).ceil() as isize;
    let at = |k: isize| {
        let offset = k as f64 * pace;
        planes.at([start[0] + offset * normal[0], start[1] + offset * normal[1]])
    };
    at(0)?;
    let samples: Vec<Option<[f32; 3]>> = (-half - 2..=half + 2).map(at).collect();
    let strength = |k: usize| -> f32 {
        match (samples[k + 1], samples[k - 1]) {
            (Some(a), Some(b)) => (0..3).map(|c| (a[c] - b[c]).powi(2)).sum::<f32>().sqrt(),
            _ => 0.0,
        }
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
    edges.sort_by(|a, b| b.1.total_cmp(&a.1));
    edges.truncate(MOST_EDGES);
    let total: f64 = edges.iter().map(|edge| edge.1).sum();
    edges.iter_mut().for_each(|edge| edge.1 /= total);
    Some(edges)
}
