//! The refinement of the depth view beside the image surface, here or in another thread.
//!
//! Where the pose stands, the refinement of an iteration looks at the solution that the iteration starts from: its light,
//! the normals of its image surface, and where its depth pixels fall. So it asks nothing of the other stages of the
//! iteration, and a [`Helper`](super::Helper) may make it while they run: the same to the bit. Both surfaces settle as before, only
//! that one of them sees the other an iteration late. Where the registration may still move the pose, the refinement
//! comes after it.
//!
//! What goes to a helper and what comes back are numbers and planes: rasters of one number for each pixel.

use nalgebra::Matrix3;

use super::Estimator;
use crate::error::{Error, ErrorKind, Result};
use crate::light::{COEFFICIENTS, Light};
use crate::options::Registration;
use crate::report::{Stage, Status};
use crate::shape::{RefinementProblem, RefinementTerms, Refiner, Scratch, ShadingWeights};
use crate::view::{ColourView, DepthView, Normals};

/// What the next refinement looks at, where that is known beforehand.
pub(super) struct Outlook {
    /// None where it looks at what its own iteration finds.
    terms: Option<RefinementTerms>,
    /// Image column and row of each depth pixel.
    position: [Vec<f32>; 2],
    /// Whether a helper has made it.
    made: bool,
    /// Refined shapes so far, those that were taken back included.
    shapes: u32,
}

impl Outlook {
    /// Memory for so many depth pixels.
    pub fn new(points: usize) -> Self {
        Self { terms: None, position: [0, 1].map(|_| Vec::with_capacity(points)), made: false, shapes: 0 }
    }

    /// Whether a helper may make it.
    const fn is_open(&self) -> bool {
        self.terms.is_some() && !self.made
    }

    /// The refined shape is another now.
    pub const fn change(&mut self) {
        (self.terms, self.made) = (None, false);
        self.shapes = self.shapes.wrapping_add(1);
    }
}

/// A refinement for a [`Helper`](super::Helper).
pub struct RefinementTask<'a> {
    /// The shape that it starts from, by its number: each refinement makes the next one.
    pub shape: u32,
    /// Light, rotation and weights.
    pub numbers: Vec<f64>,
    /// Image columns and rows of the depth pixels, normals (x, y, z) of the image surface, and, for a helper that does
    /// not hold it, the shape: refined depth and normals (x, y, z).
    pub planes: Vec<&'a [f32]>,
}

impl Estimator {
    /// At the end of an iteration: keeps what the next one's refinement looks at, if the pose will stand.
    pub(super) fn look_ahead(&mut self) {
        self.outlook.terms = None;
        let stands = match self.registration() {
            Registration::Fixed => true,
            Registration::Joint => self.joint.as_ref().is_some_and(|joint| joint.stands(&self.solution.pose)),
            Registration::Icp => false,
        };
        if stands && self.report.status == Status::Running {
            for (kept, found) in self.outlook.position.iter_mut().zip(self.correspondences.position()) {
                kept.clear();
                kept.extend_from_slice(found);
            }
            self.outlook.terms = Some(self.refinement_terms());
        }
    }

    /// The next refinement, for a helper that holds the shape of number `held`; `None` where it depends on what is still
    /// to be found. Whatever a helper does or fails to do, the outcome is the same.
    #[must_use]
    pub fn refinement_task(&self, held: Option<u32>) -> Option<RefinementTask<'_>> {
        let Outlook { terms, position: [columns, rows], made: false, shapes } = &self.outlook else { return None };
        let solution = &self.solution;
        let mut planes = vec![&columns[..], rows];
        planes.extend(components(self.kept.image_normals()));
        if held != Some(*shapes) {
            planes.push(&solution.depth_points.z);
            planes.extend(components(&solution.depth_normals));
        }
        Some(RefinementTask { shape: *shapes, numbers: to_numbers(terms.as_ref()?), planes })
    }

    /// Whether there are stages left before a refinement that a helper may be making.
    #[must_use]
    pub fn precedes_refinement(&self) -> bool {
        self.next != Stage::Refinement && self.report.status == Status::Running && self.outlook.is_open()
    }

    /// Where to put the shape that a helper has made of the one with number `shape`: refined depth and normals (x, y, z).
    /// `None` unless the next stage asks for it.
    pub fn accept_refinement(&mut self, shape: u32) -> Option<[&mut [f32]; 4]> {
        if self.next != Stage::Refinement || !self.outlook.is_open() || self.outlook.shapes != shape {
            return None;
        }
        self.outlook.made = true;
        let solution = &mut self.solution;
        let Normals { x, y, z } = &mut solution.depth_normals;
        Some([&mut solution.depth_points.z, x, y, z])
    }

    /// Normals and depth of the depth view (Eq. 17 to 19).
    pub(super) fn refine(&mut self) {
        if !self.outlook.made {
            let (image_normals, position) = match self.outlook.terms {
                Some(_) => (self.kept.image_normals(), self.outlook.position.each_ref().map(Vec::as_slice)),
                None => (&self.solution.image_normals, self.correspondences.position()),
            };
            let terms = self.outlook.terms.unwrap_or_else(|| self.refinement_terms());
            let problem = RefinementProblem { depth: &self.depth, image: &self.image, position, image_normals, terms };
            self.scratch.resize(self.depth.size.len());
            let (normals, points) = (&mut self.solution.depth_normals, &mut self.solution.depth_points);
            self.refiner.refine(&mut self.scratch, problem, normals, &mut points.z);
        }
        self.outlook.change();
        self.solution.raise_depth_points(&self.depth);
    }

    fn refinement_terms(&self) -> RefinementTerms {
        RefinementTerms {
            light: self.solution.exposed_light(),
            rotation: self.solution.pose.rotation,
            weights: self.refinement_weights(),
            colour_error: self.unexplained,
        }
    }
}

/// Refines a depth view for somebody else, one refinement after the other.
pub(super) struct Partner {
    refiner: Refiner,
    scratch: Scratch,
    position: [Vec<f32>; 2],
    image_normals: Normals,
    refined_depth: Vec<f32>,
    refined_normals: Normals,
}

impl Partner {
    /// A partner for one pair, whose shapes are refined already.
    pub fn new(image: &ColourView, depth: &DepthView) -> Result<Self> {
        let (pixels, points) = (image.size.len(), depth.size.len());
        let refiner = Refiner::new(depth, image)?.resumed();
        Ok(Self {
            scratch: Scratch::new(points, &[refiner.domain()]),
            position: [0, 1].map(|_| vec![f32::NAN; points]),
            image_normals: Normals::missing(pixels),
            refined_depth: vec![f32::NAN; points],
            refined_normals: Normals::missing(points),
            refiner,
        })
    }

    /// Where to put the planes of the next task, in their order.
    pub fn planes(&mut self) -> [&mut [f32]; 9] {
        let [columns, rows] = &mut self.position;
        let Normals { x, y, z } = &mut self.image_normals;
        let Normals { x: refined_x, y: refined_y, z: refined_z } = &mut self.refined_normals;
        [columns, rows, x, y, z, &mut self.refined_depth, refined_x, refined_y, refined_z]
    }

    /// Refines the shape by what the planes hold and the task's numbers: depth and normals (x, y, z).
    pub fn refine(&mut self, image: &ColourView, depth: &DepthView, numbers: &[f64]) -> Result<[&[f32]; 4]> {
        let position = self.position.each_ref().map(Vec::as_slice);
        let terms = from_numbers(numbers)?;
        let problem = RefinementProblem { depth, image, position, image_normals: &self.image_normals, terms };
        self.scratch.resize(depth.size.len());
        self.refiner.refine(&mut self.scratch, problem, &mut self.refined_normals, &mut self.refined_depth);
        let [x, y, z] = components(&self.refined_normals);
        Ok([&self.refined_depth, x, y, z])
    }
}

fn components(normals: &Normals) -> [&[f32]; 3] {
    [&normals.x, &normals.y, &normals.z]
}

/// Light, rotation, the weights of prior and unit length, the colours' error.
fn to_numbers(terms: &RefinementTerms) -> Vec<f64> {
    let RefinementTerms { light, rotation, weights, colour_error } = terms;
    let rest = [f64::from(weights.prior), f64::from(weights.unit), *colour_error];
    [&light.flat()[..], rotation.as_slice(), &rest].concat()
}

fn from_numbers(numbers: &[f64]) -> Result<RefinementTerms> {
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
