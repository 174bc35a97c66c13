//! The end of an iteration: the solution is accepted or rejected, shapes settle, and the loop continues or ends.

use super::evidence::Evidence;
use super::settling;
use super::verdict::{self, Verdict};
use crate::estimator::Estimator;
use crate::estimator::checks;
use crate::estimator::decision::Decision;
use crate::estimator::objective::{self, Trial};
use crate::estimator::run::{History, Run};
use crate::estimator::stages::Stages;
use crate::options::Registration;
use crate::reason::Reason;
use crate::report::{Objective, Status};

impl Estimator {
    /// Compares the new solution with the accepted one, keeps the better, and decides whether the loop continues.
    pub(in crate::estimator) fn finish_iteration(&mut self) {
        self.report.iteration += 1;
        let is_first = self.report.iteration == 1;
        if is_first {
            self.choose_evaluation_points();
        }
        let before = (!is_first).then_some(self.report.objective);
        let is_new = !self.settling.keeps_all();
        let after = if is_new { self.objective() } else { self.report.objective };
        let change = self.accepted.pose.degrees_to(&self.solution.pose);
        // Photometric registration has its own objective, so this one does not take back a pose that it moved.
        let is_comparable =
            self.stages.registration.kind(&self.pair) != Registration::Joint || change < self.pair.options.stop_degrees;
        let worse_than =
            before.filter(|before| is_comparable && objective::worsens(before.total(), after.total(), change));
        match worse_than {
            Some(before) => self.take_back(before, after),
            None => self.accept(change),
        }
        self.report.pose = self.accepted.pose;
        if is_new {
            self.measure();
        }
        self.conclude(worse_than.is_some(), before);
        let History { step_fraction, .. } = &mut self.history;
        *step_fraction = if worse_than.is_some() { 0.5 * *step_fraction } else { (2.0 * *step_fraction).min(1.0) };
        self.prepare_next_refinement();
    }

    /// Objective of the working solution over the evaluation points.
    pub(in crate::estimator) fn objective(&self) -> Objective {
        let light = self.solution.light.total();
        let colours = self.stages.albedo.colours(&self.pair);
        objective::evaluate(
            &self.pair,
            self.accepted.evaluated(),
            Trial::of(&self.pair, colours, &self.solution, &light),
        )
    }

    /// Goes back to the accepted solution.
    fn take_back(&mut self, before: Objective, after: Objective) {
        self.history.rejections += 1;
        self.settling.restart();
        self.solution.restore(&self.accepted, &self.pair);
        self.stages.refinement.shape_changed();
        self.find_correspondences();
        self.report.rotation_change = 0.0;
        self.report.reason = Some(Reason::TakenBack { before: before.total(), after: after.total() });
    }

    /// Makes the new solution the one to beat.
    fn accept(&mut self, rotation_change: f64) {
        self.report.rotation_change = rotation_change;
        self.history.rejections = if self.history.improved { 0 } else { self.history.rejections + 1 };
        self.report.reason = (!self.history.improved).then_some(Reason::PoseStays);
        if self.settling.keeps_all() {
            return;
        }
        self.settle();
        self.accepted.accept(&self.solution);
        self.choose_evaluation_points();
        // Over the new evaluation points, as in the next iteration.
        self.report.objective = self.objective();
    }

    /// Decides which shapes the next iteration keeps. It keeps none before the surface has tried its starts, and none
    /// after an iteration that changed the pose.
    fn settle(&mut self) {
        let Self { pair, stages, accepted, solution, scratch, settling, report, .. } = self;
        let Stages { albedo, registration, .. } = stages;
        let stands = registration.keeps(pair, &solution.pose) && albedo.knows(pair, &solution.pose);
        if stands && report.iteration >= crate::shape::STARTS {
            settling.advance(settling::movements(pair, accepted, solution, &mut scratch.spare));
        } else {
            settling.restart();
        }
    }

    /// Chooses the evaluation points of the next comparison from the current correspondences.
    fn choose_evaluation_points(&mut self) {
        self.accepted.compared_over(objective::evaluation_points(&self.pair, &self.correspondences));
    }

    /// Measures overlap, inliers and residuals of the current correspondences.
    pub(in crate::estimator) fn measure(&mut self) {
        let Self { pair, stages: Stages { albedo, .. }, solution, correspondences, scratch, .. } = self;
        let residual = self.residuals.measure(pair, albedo, solution, correspondences, &mut scratch.spare);
        self.report.residual = residual.unwrap_or(self.report.residual);
        self.report.overlap = correspondences.count() as f64 / pair.depth.valid().max(1) as f64;
        self.report.inliers = correspondences.inliers();
    }

    /// Ends the loop if the evidence suffices for a verdict.
    fn conclude(&mut self, is_rejected: bool, before: Option<Objective>) {
        let is_unmoved = self.history.proposed_degrees < self.pair.options.stop_degrees;
        self.history.unmoved = if is_unmoved { self.history.unmoved + 1 } else { 0 };
        self.report.drop_near_rivals(self.pair.options.tolerance);
        let Self { pair, report, history, .. } = &*self;
        let nearest = report.rivals.iter().map(|rival| rival.degrees_to(&report.pose)).fold(f64::INFINITY, f64::min);
        let evidence = Evidence {
            iteration: report.iteration,
            max_iterations: pair.options.max_iterations,
            tolerance: pair.options.tolerance,
            registration: self.stages.registration.kind(pair),
            shading: pair.options.shading,
            correspondences: self.correspondences.count(),
            overlap: report.overlap,
            objective_before: before.map(|before| before.total()),
            objective: report.objective.total(),
            is_rejected,
            rejections: history.rejections,
            unmoved: history.unmoved,
            is_whole_step: history.step_fraction >= 1.0 && history.improved,
            log_spread: pair.image.log_spread(),
            by_contrast: self.stages.registration.is_by_contrast(),
            hollow: history.hollow.clone(),
            missing_mask: checks::missing_mask(pair),
            rivals: report.rivals.len() as u32,
            nearest_rival: nearest,
        };
        let ended = verdict::verdict(&evidence, self.stages.registration.method());
        let checked = ended.map(|ended| self.check_unit(ended));
        if let Some((status, reason)) = checked {
            self.end(status, reason);
        }
    }

    /// Caps the verdict if another depth unit fits the image better, because a wrong unit can also explain rivals and a
    /// large sigma.
    fn check_unit(&mut self, ended: Verdict) -> Verdict {
        let registration = &mut self.stages.registration;
        let found = registration.decision.as_ref().and_then(Decision::photometric);
        let may_explain = match &ended {
            (Status::Converged, _) | (Status::Ambiguous, Some(Reason::Rivals { .. })) => true,
            (Status::Ambiguous, Some(Reason::RotationUncertain { .. })) => found.is_some(),
            _ => false,
        };
        if !(may_explain && self.pair.options.registration == Registration::Joint) {
            return ended;
        }
        let check = |memory| checks::other_unit(memory, &self.pair, &self.solution.pose, found);
        let reason = registration.photometric.as_mut().and_then(check);
        reason.map_or(ended, verdict::capped)
    }

    pub(in crate::estimator) fn end(&mut self, status: Status, reason: Option<Reason>) {
        self.run = Run::Ended;
        self.report.status = status;
        self.report.reason = reason;
    }
}
