//! The steps of a registration in the gradient domain.

use nalgebra::Vector3;

use super::equations::{NUMBERS, PoseProducts};
use super::field::{CHANNELS, Field};
use super::model::Model;
use super::surface::Surface;
use crate::pose::contrast::{ContrastProblem, ContrastReport, Samples, Seen};
use crate::pose::increment::{
    Frame, PoseMatrix, PoseVector, SCALE, UNKNOWNS, clear_unknowns, damped_step, fix_unknowns, inverse,
};
use crate::pose::jackknife::{covariance, sectors};
use crate::pose::residuals::MEASURED_SIDE;
use crate::pose::silhouette::Silhouette;
use crate::pose::similarity::Similarity;

/// Share of the median intensity that is added before the logarithm, as in local contrast.
const LIFT: f32 = 0.1;
/// Largest numbers of samples of the depth view and of pixels of the image; larger views are thinned to them.
const MOST_SAMPLES: f64 = 10_000.0;
/// Minimum number of pixels.
const FEWEST: usize = 100;
/// Largest number of steps, the number of those that are not shortened, and the share of a shortened one.
const MOST_STEPS: usize = 22;
const WHOLE_STEPS: usize = 10;
const SHORTENED: f64 = 0.6;
/// Steps before which the channels are rotated anew. None of them is the last.
const ROTATIONS: [usize; 3] = [0, 2, 5];
/// Number of fits of the light before a step: of the first two steps, of others, and of those without a sector.
const FIRST_FITS: usize = 8;
const FITS: usize = 4;
const SECTOR_FITS: usize = 2;
/// Largest rotation of a step, radians, and shift, pixels.
const LARGEST_TURN: f64 = 0.07;
const LARGEST_SHIFT: f64 = 2.5;
/// A rotation below this, radians, ends the steps.
const SETTLED: f64 = 3.5e-4;
/// Sigma of the logarithm of the scale about that of the initial pose.
const GROWTH: f64 = 0.1;
/// Number of sectors of the jackknife, and of steps without each.
const SECTORS: usize = 6;
const SECTOR_STEPS: usize = 8;

/// The end of a registration.
#[derive(Clone, Debug)]
pub struct GradientReport {
    /// The pose; t_z keeps its initial value.
    pub pose: Similarity,
    /// Covariance of the pose in the frame of the local contrast from which it started, zero for held unknowns.
    pub covariance: PoseMatrix,
    /// Unknowns that kept their values.
    pub held: [bool; UNKNOWNS],
}

/// What the next slice does.
enum Phase {
    Descend(usize),
    /// The step without a sector, the pose and the moves so far.
    Sector {
        sector: usize,
        step: usize,
        pose: Similarity,
    },
    Done,
}

/// Registers one depth view to one image, one step in each slice; owns its memory.
pub struct GradientRegistration {
    pub(super) samples: Samples,
    pub(super) seen: Seen,
    pub(super) silhouette: Silhouette,
    /// Length in which distances are counted, pixels.
    pub(super) unit: f64,
    field: Field,
    model: Model,
    /// The model at the end, from which each sector begins.
    ended: Model,
    phase: Phase,
    pose: Similarity,
    /// Scale of the initial pose.
    scale: f64,
    frame: Frame,
    sectors: Vec<usize>,
    moves: [PoseVector; SECTORS],
    covariance: PoseMatrix,
}

impl GradientRegistration {
    /// A registration from the end of local contrast.
    #[must_use]
    pub fn new(problem: &ContrastProblem<'_>, start: &ContrastReport) -> Self {
        let thinned = |count: usize| (count as f64 / MOST_SAMPLES).sqrt().round().max(1.0) as usize;
        let samples = Samples::new(problem, thinned(problem.depth.valid()));
        let pixels = problem.object.iter().filter(|inside| **inside).count();
        // A raster pixel shows the surface only if all its pixels are on the object.
        let step = thinned(pixels);
        let surface = Surface::new(problem.image.size, step, &samples, pixels / (step * step));
        let field = Field::new(&problem.image.lifted(LIFT), surface);
        Self {
            seen: Seen::new(problem.image.size, &samples, samples.stride as f64),
            silhouette: Silhouette::new(problem.image.size, problem.object),
            unit: ((problem.depth.valid() as f64).sqrt() / MEASURED_SIDE).max(1.0),
            sectors: Vec::new(),
            field,
            samples,
            model: Model::new(),
            ended: Model::new(),
            phase: Phase::Descend(0),
            pose: start.pose,
            scale: start.pose.scale,
            frame: start.frame,
            moves: [PoseVector::zeros(); SECTORS],
            covariance: PoseMatrix::zeros(),
        }
    }

    /// Takes one step. Returns whether it was the last.
    pub fn advance(&mut self, problem: &ContrastProblem<'_>) -> bool {
        let next = match self.phase {
            Phase::Descend(step) => self.descend(problem, step),
            Phase::Sector { sector, step, pose } => self.leave_out(problem, sector, step, pose),
            Phase::Done => None,
        };
        self.phase = next.unwrap_or(Phase::Done);
        matches!(self.phase, Phase::Done)
    }

    /// The result, once all steps are done; `None` if the pixels do not determine the pose.
    #[must_use]
    pub fn report(&self, problem: &ContrastProblem<'_>) -> Option<GradientReport> {
        let is_known = matches!(self.phase, Phase::Done) && self.covariance != PoseMatrix::zeros();
        let covariance = self.covariance + covariance(&self.moves);
        is_known.then(|| GradientReport { pose: self.pose, covariance, held: problem.held() })
    }

    /// A step of all pixels. After the last one, the sectors follow.
    fn descend(&mut self, problem: &ContrastProblem<'_>, step: usize) -> Option<Phase> {
        if step == MOST_STEPS {
            return self.begin_sectors(problem);
        }
        let pose = self.pose;
        let frame = self.look(problem, &pose)?;
        if ROTATIONS.contains(&step) {
            self.model.rotate_channels(&mut self.field);
        } else {
            self.model.rotate(&mut self.field);
        }
        let mut change = self.step(problem, &frame, &pose, if step < 2 { FIRST_FITS } else { FITS })?;
        if step >= WHOLE_STEPS {
            change *= SHORTENED;
        }
        self.pose = frame.change(&change).after(&pose).orthonormal();
        let is_last_rotated = step > ROTATIONS[ROTATIONS.len() - 1];
        let is_settled = is_last_rotated && change.fixed_rows::<3>(0).norm() < SETTLED;
        Some(Phase::Descend(if is_settled { MOST_STEPS } else { step + 1 }))
    }

    /// The step from a pose that [`look`](Self::look) has seen, after so many fits of the light.
    fn step(
        &mut self,
        problem: &ContrastProblem<'_>,
        frame: &Frame,
        pose: &Similarity,
        fits: usize,
    ) -> Option<PoseVector> {
        for _ in 0..fits {
            self.model.fit(&mut self.field)?;
        }
        let (matrix, gradient) = self.equations(problem, frame, pose)?;
        let change = damped_step(matrix, gradient, 0.0, &problem.held())?;
        let turn = change.fixed_rows::<3>(0).norm();
        let shift = change.fixed_rows::<3>(3).norm() * frame.length;
        Some(change * (LARGEST_TURN / turn).min(LARGEST_SHIFT * self.unit / shift).min(1.0))
    }

    /// Computes the covariance of the equations and divides the pixels into sectors.
    fn begin_sectors(&mut self, problem: &ContrastProblem<'_>) -> Option<Phase> {
        let (pose, frame, held) = (self.pose, self.frame, problem.held());
        self.look(problem, &pose)?;
        self.model.rotate(&mut self.field);
        for _ in 0..SECTOR_FITS {
            self.model.fit(&mut self.field)?;
        }
        let (mut matrix, _) = self.equations(problem, &frame, &pose)?;
        fix_unknowns(&mut matrix, &held);
        self.covariance = inverse(&matrix)?;
        clear_unknowns(&mut self.covariance, &held);
        let hits = &self.field.surface.hits;
        let places = || hits.iter().map(|hit| Vector3::new(f64::from(hit.place[0]), f64::from(hit.place[1]), 0.0));
        let centre = places().sum::<Vector3<f64>>() / hits.len() as f64;
        self.sectors = vec![SECTORS; self.field.surface.size.len()];
        for (hit, sector) in hits.iter().zip(sectors(places(), centre, SECTORS)) {
            self.sectors[hit.cell as usize] = sector;
        }
        self.ended = self.model.clone();
        Some(Phase::Sector { sector: 0, step: 0, pose })
    }

    /// A step from the end without a sector.
    fn leave_out(
        &mut self,
        problem: &ContrastProblem<'_>,
        sector: usize,
        step: usize,
        pose: Similarity,
    ) -> Option<Phase> {
        let frame = self.frame;
        let change = self.look(problem, &pose).and_then(|_| {
            let (sectors, hits) = (&self.sectors, &self.field.surface.hits);
            self.field.pairs.retain(|pair| sectors[hits[pair.first as usize].cell as usize] != sector);
            self.model.rotate(&mut self.field);
            self.step(problem, &frame, &pose, SECTOR_FITS)
        });
        if let Some(change) = change {
            self.moves[sector] += change;
            if step + 1 < SECTOR_STEPS {
                let pose = frame.change(&change).after(&pose).orthonormal();
                return Some(Phase::Sector { sector, step: step + 1, pose });
            }
        }
        self.model = self.ended.clone();
        (sector + 1 < SECTORS).then_some(Phase::Sector { sector: sector + 1, step: 0, pose: self.pose })
    }

    /// Finds what the image sees under a pose; `None` if that is too little.
    fn look(&mut self, problem: &ContrastProblem<'_>, pose: &Similarity) -> Option<Frame> {
        self.seen.look(problem, &self.samples, pose);
        self.field.look(problem, &self.samples, pose);
        let hits = &self.field.surface.hits;
        if hits.len() < FEWEST {
            return None;
        }
        let (mut sum, mut square) = (Vector3::zeros(), 0.0);
        for hit in hits {
            let point = hit.point(problem);
            sum += point;
            square += point.norm_squared();
        }
        let count = hits.len() as f64;
        let centre = sum / count;
        let length = (square / count - centre.norm_squared()).max(0.0).sqrt().max(f64::MIN_POSITIVE);
        Some(Frame { centre, length })
    }

    /// Matrix and gradient of the pose with the light eliminated.
    pub(super) fn equations(
        &mut self,
        problem: &ContrastProblem<'_>,
        frame: &Frame,
        pose: &Similarity,
    ) -> Option<(PoseMatrix, PoseVector)> {
        self.field.sense(&self.model.lights);
        self.field.derive(problem, frame, &self.model.lights);
        let mut products = [PoseProducts::ZERO; CHANNELS];
        for pair in &self.field.pairs {
            let fitted = self.model.of_pair(&self.field, pair);
            let [a, b] = [pair.first, pair.second].map(|k| &self.field.derivatives[k as usize]);
            let mut numbers = [0.0; NUMBERS];
            numbers[UNKNOWNS..NUMBERS - 1].copy_from_slice(&fitted.difference);
            for c in 0..CHANNELS {
                (0..UNKNOWNS).for_each(|k| numbers[k] = b[c][k] - a[c][k]);
                numbers[NUMBERS - 1] = fitted.residual[c];
                products[c].add(&numbers, fitted.weight(c), 0);
            }
        }
        let (mut matrix, mut gradient) = (PoseMatrix::zeros(), PoseVector::zeros());
        for (c, products) in products.iter_mut().enumerate() {
            products.flush();
            let reduced = products.reduced(&self.model.prior[c], &self.model.lights[c])?;
            (matrix, gradient) = (matrix + reduced.0, gradient + reduced.1);
        }
        self.add_silhouette(problem, frame, pose, (&mut matrix, &mut gradient));
        let information = 1.0 / (GROWTH * GROWTH);
        matrix[(SCALE, SCALE)] += information;
        gradient[SCALE] += information * (pose.scale / self.scale).ln();
        Some((matrix, gradient))
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Rotation3;

    use super::*;
    use crate::pose::contrast::test_scene::{SIDE, texture, views};
    use crate::pose::contrast::{ContrastProblem, ContrastSearch};
    use crate::pose::gradient_domain::combine;
    use crate::view::{ColourView, DepthView};

    /// Blur of a texture that is softer than the shading, pixels.
    const SOFT: usize = 6;

    fn turned(depth: &DepthView) -> Similarity {
        let rotation = Rotation3::new(Vector3::new(0.03, -0.04, 0.01)).into_inner();
        Similarity::identity().turned_about(depth.points.centroid(), 1.0, rotation)
    }

    /// Local contrast from 3 degrees off, and the registration in the gradient domain from its end.
    fn registered((image, depth): &(ColourView, DepthView)) -> (ContrastReport, GradientReport) {
        let normal_error = vec![0.0; depth.size.len()];
        let problem = ContrastProblem::of_views(image, depth, &normal_error);
        let mut search = ContrastSearch::new(&problem, vec![turned(depth)]);
        while !search.advance(&problem) {}
        let contrast = search.outcome(&problem).unwrap().best;
        let mut registration = GradientRegistration::new(&problem, &contrast);
        while !registration.advance(&problem) {}
        let gradients = registration.report(&problem).unwrap();
        (contrast, gradients)
    }

    #[test]
    fn without_albedo_the_end_is_the_true_pose() {
        let (_, gradients) = registered(&views(&[0.0; SIDE * SIDE]));
        let off = gradients.pose.degrees_to(&Similarity::identity());
        assert!(off < 0.1, "{off}");
    }

    #[test]
    fn soft_albedo_biases_the_combination_less_than_local_contrast() {
        let (mut before, mut after) = (0.0, 0.0);
        for seed in 1..=6 {
            let (contrast, gradients) = registered(&views(&texture(seed, 0.05, SOFT)));
            let combined = combine(&contrast, &gradients).unwrap();
            before += contrast.pose.degrees_to(&Similarity::identity()) / 6.0;
            after += combined.pose.degrees_to(&Similarity::identity()) / 6.0;
        }
        assert!(after < 0.8 * before, "{after} instead of {before}");
    }

    #[test]
    fn derivatives_of_residuals_are_difference_quotients() {
        let (image, depth) = views(&[0.0; SIDE * SIDE]);
        let normal_error = vec![0.0; depth.size.len()];
        let problem = ContrastProblem::of_views(&image, &depth, &normal_error);
        let (contrast, _) = registered(&(image.clone(), depth.clone()));
        let mut registration = GradientRegistration::new(&problem, &contrast);
        let pose = Similarity::identity();
        let frame = registration.look(&problem, &pose).unwrap();
        for _ in 0..FIRST_FITS {
            registration.model.fit(&mut registration.field).unwrap();
        }
        let lights = registration.model.lights;
        let shades = |registration: &mut GradientRegistration, pose: &Similarity| -> Vec<Option<f32>> {
            registration.look(&problem, pose).unwrap();
            registration.field.derive(&problem, &frame, &lights);
            registration.field.shades_of_pixels()
        };
        let small = 2e-3;
        for unknown in [0, 1, 2, 3, 4, 6] {
            let mut step = PoseVector::zeros();
            step[unknown] = small;
            let [above, below] = [step, -step].map(|step| shades(&mut registration, &frame.change(&step).after(&pose)));
            shades(&mut registration, &pose);
            let (mut error, mut size) = (0.0, 0.0);
            for (index, hit) in registration.field.surface.hits.iter().enumerate() {
                let cell = hit.cell as usize;
                let (Some(above), Some(below)) = (above[cell], below[cell]) else { continue };
                // A residual is a value less its shade.
                let slope = f64::from(below - above) / (2.0 * small);
                let derivative = f64::from(registration.field.derivatives[index][0][unknown]);
                error += (slope - derivative).powi(2);
                size += slope.powi(2);
            }
            assert!(error < 0.01 * size, "{unknown}: {error} of {size}");
        }
    }
}
