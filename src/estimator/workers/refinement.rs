//! Successive refinements of one depth view in a worker.

use crate::error::Result;
use crate::estimator::pair::ViewPair;
use crate::estimator::stages::terms_from_numbers;
use crate::shape::{RefinementProblem, Refiner, Scratch};
use crate::view::Normals;

/// Refines the depth view of a pair; owns all memory.
pub struct RefinementWorker {
    refiner: Refiner,
    scratch: Scratch,
    position: [Vec<f32>; 2],
    image_normals: Normals,
    refined_depth: Vec<f32>,
    refined_normals: Normals,
}

impl RefinementWorker {
    /// Creates a worker for one pair whose shapes have already been refined.
    pub fn new(pair: &ViewPair) -> Result<Self> {
        let [pixels, points] = pair.lengths();
        let refiner = Refiner::new(&pair.depth, &pair.image)?.resumed();
        Ok(Self {
            scratch: Scratch::new(points, &[refiner.domain()]),
            position: [0, 1].map(|_| vec![f32::NAN; points]),
            image_normals: Normals::missing(pixels),
            refined_depth: vec![f32::NAN; points],
            refined_normals: Normals::missing(points),
            refiner,
        })
    }

    /// The planes of the next task, in order, for the caller to fill.
    pub fn planes(&mut self) -> [&mut [f32]; 9] {
        let [columns, rows] = &mut self.position;
        let Normals { x, y, z } = &mut self.image_normals;
        let Normals { x: refined_x, y: refined_y, z: refined_z } = &mut self.refined_normals;
        [columns, rows, x, y, z, &mut self.refined_depth, refined_x, refined_y, refined_z]
    }

    /// Refines the shape, given the filled planes and the task's numbers: depth and normals (x, y, z).
    pub fn refine(&mut self, pair: &ViewPair, numbers: &[f64]) -> Result<[&[f32]; 4]> {
        let problem = RefinementProblem {
            depth: &pair.depth,
            image: &pair.image,
            position: self.position.each_ref().map(Vec::as_slice),
            image_normals: &self.image_normals,
            terms: terms_from_numbers(numbers)?,
        };
        self.scratch.resize(pair.depth.size.len());
        self.refiner.refine(&mut self.scratch, problem, &mut self.refined_normals, &mut self.refined_depth);
        let Normals { x, y, z } = &self.refined_normals;
        Ok([&self.refined_depth, x, y, z])
    }
}
