//! Edges of the image near a line: the strongest gradient along its normal.
//!
//! Limits: only brightness is used. Printed edges count as well; the rounds and the robust weights have to reject them.

use crate::view::{Gaussian, Size};

/// For each level: Gaussian blur, and the reach of the search for an edge along the normal, pixels.
pub const LEVELS: [(f64, f64); 3] = [(3.0, 14.0), (1.5, 7.0), (0.8, 3.5)];
/// Step along the normal, pixels.
const STEP: f64 = 0.5;
/// Smallest gradient of an edge, brightness of 0 .. 1 per pixel: two levels of 8 bits.
const LEAST_GRADIENT: f64 = 0.008;

/// Blurred brightness of a frame.
pub struct Edges {
    size: Size,
    levels: Vec<Vec<f32>>,
}

/// An edge: its distance along the normal, and how clear it is, 0 .. 1.
#[derive(Clone, Copy)]
pub struct Edge {
    pub offset: f64,
    pub strength: f64,
}

impl Edges {
    pub fn new(size: Size, grey: &[f32]) -> Self {
        Self { size, levels: LEVELS.iter().map(|&(blur, _)| blurred(size, grey, blur)).collect() }
    }

    /// The strongest edge along this unit normal of a line through `place`; `None` beyond the frame or without a clear
    /// edge.
    pub fn nearest(&self, level: usize, place: [f64; 2], normal: [f64; 2]) -> Option<Edge> {
        let reach = (LEVELS[level].1 / STEP) as i32;
        let (mut best, mut sum, mut count) = (Edge { offset: 0.0, strength: 0.0 }, 0.0, 0.0);
        for step in -reach..=reach {
            let offset = STEP * f64::from(step);
            let ahead = |by: f64| {
                let at = [0, 1].map(|axis| (place[axis] + (offset + by) * normal[axis]) as f32);
                f64::from(self.size.bilinear(&self.levels[level], at[0], at[1]))
            };
            let slope = (ahead(0.5) - ahead(-0.5)).abs();
            if slope.is_nan() {
                continue;
            }
            (sum, count) = (sum + slope, count + 1.0);
            // Of two similar edges the nearer one is taken.
            let weighed = slope * (1.0 - 0.5 * (offset / LEVELS[level].1).abs());
            if weighed > best.strength {
                best = Edge { offset, strength: weighed };
            }
        }
        if best.strength < LEAST_GRADIENT {
            return None;
        }
        // One if the edge holds all of the contrast, zero if it is like its surroundings.
        let mean = sum / count;
        Some(Edge { strength: (1.0 - mean / best.strength).max(0.0), ..best })
    }
}

fn blurred(size: Size, values: &[f32], sigma: f64) -> Vec<f32> {
    let [means] = Gaussian::new(size, sigma, Gaussian::REACH).means(|_| true, |_, index| values[index]);
    means.into_iter().map(|mean| mean as f32).collect()
}
