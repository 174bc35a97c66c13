//! The refinement of the depth view (Eq. 17 to 19) as a stage of the loop, here or in another thread.
//!
//! If the pose will not move, the refinement of an iteration uses the solution at its beginning: the light, the normals
//! of the image surface, and the positions of the depth pixels in the image. It then needs nothing from the other
//! stages of the iteration, and a [`Worker`](crate::Worker) may run it beside them with the same result to the bit.
//! Both surfaces settle all the same; one of them merely sees the other an iteration late. If the registration may
//! still move the pose, the refinement follows it and uses the results of the same iteration.

use nalgebra::Matrix3;

use crate::error::{Error, ErrorKind, Result};
use crate::estimator::pair::ViewPair;
use crate::estimator::solution::{Accepted, Shape, Solution};
use crate::light::{COEFFICIENTS, Light};
use crate::options::Weights;
use crate::shape::{HeightDomain, RefinementProblem, RefinementTerms, Refiner, Scratch, ShadingWeights};
use crate::view::Normals;

use super::light::Inputs;

/// A refinement for a [`Worker`](crate::Worker).
pub struct RefinementTask<'a> {
    /// Number of the shape from which it starts: each refinement makes the next one.
    pub shape: u32,
    /// Light, rotation and weights.
    pub numbers: Vec<f64>,
    /// Image columns and rows of the depth pixels, normals (x, y, z) of the image surface, and, for a worker that does
    /// not hold it, the shape: refined depth and normals (x, y, z).
    pub planes: Vec<&'a [f32]>,
}

/// Refines the depth view; owns what persists between iterations.
pub struct RefinementStage {
    refiner: Refiner,
    /// Terms of the next refinement, if known before its iteration; `None` if it uses the results of the same iteration.
    terms: Option<RefinementTerms>,
    /// Image column and row of each depth pixel, also known in advance.
    position: [Vec<f32>; 2],
    /// Whether a worker has made the next refinement.
    made_by_worker: bool,
    /// Number of refined shapes so far, including rejected ones.
    shapes: u32,
}

impl RefinementStage {
    pub fn new(pair: &ViewPair) -> Result<Self> {
        let points = pair.depth.size.len();
        Ok(Self {
            refiner: Refiner::new(&pair.depth, &pair.image)?,
            terms: None,
            position: [0, 1].map(|_| Vec::with_capacity(points)),
            made_by_worker: false,
            shapes: 0,
        })
    }

    /// Domain of the depth view's unknown heights.
    pub const fn domain(&self) -> &HeightDomain {
        self.refiner.domain()
    }

    /// Fills the holes of the measured depth.
    pub fn fill_holes(&self, pair: &ViewPair, scratch: &mut Scratch, shape: &mut Shape) -> Result<()> {
        scratch.resize(pair.depth.size.len());
        self.refiner.fill(scratch, &pair.depth, &mut shape.points.z)?;
        shape.place_depth_points(&pair.depth);
        Ok(())
    }

    /// Called after an iteration if the pose will not move: keeps the input of the next refinement.
    pub fn prepare_next(&mut self, inputs: Inputs<'_>, solution: &Solution) {
        for (kept, found) in self.position.iter_mut().zip(inputs.correspondences.position()) {
            kept.clear();
            kept.extend_from_slice(found);
        }
        self.terms = Some(terms(inputs, solution));
    }

    /// Makes the next refinement use the results of the same iteration.
    pub const fn discard_prepared(&mut self) {
        self.terms = None;
    }

    /// Called when the refined shape is replaced, because prepared input belongs to the previous one.
    pub const fn shape_changed(&mut self) {
        (self.terms, self.made_by_worker) = (None, false);
        self.shapes = self.shapes.wrapping_add(1);
    }

    /// Whether a worker may run the next refinement.
    pub const fn can_be_shared(&self) -> bool {
        self.terms.is_some() && !self.made_by_worker
    }

    /// The next refinement, for a worker that holds the shape numbered `held`.
    pub fn task<'a>(
        &'a self,
        accepted: &'a Accepted,
        shape: &'a Shape,
        held: Option<u32>,
    ) -> Option<RefinementTask<'a>> {
        if self.made_by_worker {
            return None;
        }
        let [columns, rows] = &self.position;
        let mut planes = vec![&columns[..], rows];
        planes.extend(components(accepted.image_normals()));
        if held != Some(self.shapes) {
            planes.push(&shape.points.z);
            planes.extend(components(&shape.normals));
        }
        Some(RefinementTask { shape: self.shapes, numbers: terms_to_numbers(self.terms.as_ref()?), planes })
    }

    /// Whether a worker's refinement of the shape numbered `shape` is the one required; if so, it counts as made.
    pub fn accept(&mut self, shape: u32) -> bool {
        let is_wanted = self.can_be_shared() && self.shapes == shape;
        self.made_by_worker |= is_wanted;
        is_wanted
    }

    /// Normals and depth of the depth view (Eq. 17 to 19), unless a worker has made them. Writes only the depth view's
    /// shape in `solution`.
    pub fn refine(&mut self, inputs: Inputs<'_>, accepted: &Accepted, scratch: &mut Scratch, solution: &mut Solution) {
        let Inputs { pair, colours, correspondences, .. } = inputs;
        if !self.made_by_worker {
            let terms = self.terms.unwrap_or_else(|| terms(inputs, solution));
            let (image_normals, position) = match self.terms {
                Some(_) => (accepted.image_normals(), self.position.each_ref().map(Vec::as_slice)),
                None => (&solution.image.normals, correspondences.position()),
            };
            let problem = RefinementProblem { depth: &pair.depth, image: colours, position, image_normals, terms };
            scratch.resize(pair.depth.size.len());
            let Shape { normals, points } = &mut solution.depth;
            self.refiner.refine(scratch, problem, normals, &mut points.z);
        }
        self.shape_changed();
        solution.depth.place_depth_points(&pair.depth);
    }
}

fn terms(Inputs { pair, fitted, .. }: Inputs<'_>, solution: &Solution) -> RefinementTerms {
    let Weights { refinement, unit, .. } = pair.options.weights;
    let prior = refinement * fitted.variance_inflation();
    RefinementTerms {
        light: solution.light.total(),
        rotation: solution.pose.rotation,
        weights: ShadingWeights::with_robust_prior(prior as f32, unit as f32),
        colour_error: fitted.residual(),
    }
}

/// Light, rotation, weights of prior and unit length, and the error of the colours.
fn terms_to_numbers(terms: &RefinementTerms) -> Vec<f64> {
    let RefinementTerms { light, rotation, weights, colour_error } = terms;
    let rest = [f64::from(weights.prior), f64::from(weights.unit), *colour_error];
    [&light.flat()[..], rotation.as_slice(), &rest].concat()
}

/// The terms from the numbers of a [`RefinementTask`].
pub fn terms_from_numbers(numbers: &[f64]) -> Result<RefinementTerms> {
    let (light, rest) = numbers.split_at(COEFFICIENTS.min(numbers.len()));
    let &[xx, yx, zx, xy, yy, zy, xz, yz, zz, prior, unit, colour_error] = rest else {
        return Err(Error::new(ErrorKind::Size, "numbers", "are not those of a refinement"));
    };
    Ok(RefinementTerms {
        light: Light::from_slice("numbers", light)?,
        rotation: Matrix3::new(xx, xy, xz, yx, yy, yz, zx, zy, zz),
        weights: ShadingWeights::with_robust_prior(prior as f32, unit as f32),
        colour_error,
    })
}

fn components(normals: &Normals) -> [&[f32]; 3] {
    [&normals.x, &normals.y, &normals.z]
}
