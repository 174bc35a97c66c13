//! Rasters that each stage fills itself.
//!
//! None of them outlives its stage, and no two stages run at once. The image's surface and the depth view's refinement
//! therefore share one scratch alternately; normals of single pixels are solved in bands.

use std::ops::Range;

use super::domain::HeightDomain;
use super::solver::HeightSolver;
use crate::view::{Normals, Size};

/// Number of pixels of a band, enough to make the shading solver's setup negligible.
const BAND: usize = 1 << 15;

/// Memory for the stages of both views.
pub struct Scratch {
    /// Solves the heights of either view.
    pub heights: HeightSolver,
    /// Slopes of normals, along columns and along rows.
    pub slopes: [Vec<f32>; 2],
    /// Weights of priors or anchors.
    pub weight: Vec<f32>,
    /// Memory for any other use.
    pub spare: Vec<f32>,
    /// Prior normals of a band of pixels, and those to be found.
    pub prior: Normals,
    pub found: Normals,
}

impl Scratch {
    /// Allocates memory for views of at most `pixels` and for these domains.
    #[inline(never)]
    pub fn new(pixels: usize, domains: &[&HeightDomain]) -> Self {
        let raster = || Vec::with_capacity(pixels);
        let band = || Normals::missing(BAND.min(pixels));
        Self {
            heights: HeightSolver::new(domains),
            slopes: [raster(), raster()],
            weight: raster(),
            spare: raster(),
            prior: band(),
            found: band(),
        }
    }

    /// Resizes the rasters to a view of this many pixels; their contents are arbitrary.
    pub fn resize(&mut self, pixels: usize) {
        let [p, q] = &mut self.slopes;
        [p, q, &mut self.weight, &mut self.spare].into_iter().for_each(|raster| raster.resize(pixels, 0.0));
    }

    /// All pixels of a view in bands of whole rows.
    pub fn bands(size: Size) -> impl Iterator<Item = Range<usize>> {
        let band = (BAND / size.width).max(1) * size.width;
        (0..size.len()).step_by(band).map(move |start| start..(start + band).min(size.len()))
    }

    /// Resizes the normals to those of a band.
    pub fn resize_band(&mut self, band: &Range<usize>) {
        self.prior.resize(band.len());
        self.found.resize(band.len());
    }
}
