//! The check from frames to report, one slice of work at a time.
//!
//! The initial poses are the candidates, the inverse of the first, and what the coarse search finds near the first.
//! Each is registered only by its edges. The best few are refined with all cues, together with every candidate that
//! lies elsewhere. The best of these optima is the estimate, and its covariance judges the candidates. If the first
//! candidate does not pass, it is registered again in other conventions. If it is off and none of them fits, all of this is
//! done again, farther from it and about the estimate (`passes`).

use super::cue::Cue;
use super::distortion;
use super::input::{RigView, rigid};
use super::next::next;
use super::optima::{self, Optimum};
use super::passes::Passes;
use super::planes::Planes;
use super::readings::Reading;
use super::reason::{CheckReason, Warning, WarningKind};
use super::registration::{ARRIVED, Findings, Kept, MOST_SETTLING, Round, SIGMAS, SURVIVORS, Scene};
use super::report::CheckReport;
use super::rereading::Rereading;
use super::reviewing::{Refining, Reviewing};
use super::sensitivity::curves;
use super::unknowns::State;
use super::unseen::leave_unseen_out;
use super::verdict::{CheckVerdict, LEAST_COMPARED_SHARE};
use crate::error::{Error, ErrorKind, Result};
use crate::pose::Similarity;

/// Maximum number of frames in a check: their images fill the memory of a page.
const MOST_FRAMES: usize = 24;
/// Maximum number of candidates.
const MOST_CANDIDATES: usize = 16;
/// Levels at which depth discontinuities are found anew, because their visibility changes little in between.
const FINDING_ANEW: [usize; 2] = [1, 3];
/// The level at which candidates enter once more, with windows of a few pixels.
const ENTERING: usize = 2;

/// The initial pose of the search: the first candidate that puts points onto the image.
fn initial(scene: &Scene, candidates: &[(String, State)]) -> State {
    let seen = candidates.iter().find(|candidate| scene.is_seen(&candidate.1));
    seen.or(candidates.first()).map_or_else(|| State::at(Similarity::identity()), |candidate| candidate.1)
}

enum Stage {
    Starting,
    Approaching {
        level: usize,
        index: usize,
        planes: Vec<Planes>,
    },
    Settling {
        rounds: Vec<Round>,
        at: usize,
        done: usize,
        kept: Option<Kept>,
        planes: Vec<Planes>,
    },
    Judging {
        rounds: Vec<Round>,
        planes: Vec<Planes>,
    },
    Rereading {
        search: Box<Rereading>,
        planes: Vec<Planes>,
    },
    /// The optima are there if other conventions of the candidate are still to be tried.
    Reviewing {
        search: Box<Reviewing>,
        planes: Vec<Planes>,
        optima: Option<Vec<Optimum>>,
    },
    Curves {
        planes: Vec<Planes>,
        findings: Box<Findings>,
        done: usize,
    },
    Done,
}

/// A check in progress.
pub struct CalibrationCheck {
    pub(super) scene: Scene,
    pub(super) candidates: Vec<(String, State)>,
    pub(super) warnings: Vec<Warning>,
    /// Width of the first image as given.
    pub(super) width: f64,
    pub(super) passes: Passes,
    best: Round,
    stage: Stage,
    /// First radial coefficient of a distortion that was probably left out.
    pub(super) lens: Option<f64>,
    report: Option<CheckReport>,
}

impl CalibrationCheck {
    /// # Errors
    /// The error names the member of the frame or candidate at fault.
    pub fn new(views: Vec<RigView>, candidates: Vec<(String, Similarity)>, cues: &[Cue]) -> Result<Self> {
        if views.is_empty() || views.len() > MOST_FRAMES {
            let message = format!("needs 1 to {MOST_FRAMES} frames");
            return Err(Error::new(ErrorKind::Size, "frames", message).value(views.len() as f64));
        }
        if candidates.len() > MOST_CANDIDATES {
            let message = format!("takes up to {MOST_CANDIDATES}");
            return Err(Error::new(ErrorKind::Size, "candidates", message).value(candidates.len() as f64));
        }
        let rigid = |(name, pose): (String, Similarity)| match rigid(&pose) {
            Ok(state) => Ok((name, state)),
            Err(error) => Err(error.below(&format!("candidates.{name}"))),
        };
        let candidates = candidates.into_iter().map(rigid).collect::<Result<Vec<_>>>()?;
        let width = views[0].image_size[0] as f64;
        let states: Vec<State> = candidates.iter().map(|candidate| candidate.1).collect();
        let (mut warnings, mut frames, mut is_guessed) = (vec![], vec![], false);
        for (index, view) in views.into_iter().enumerate() {
            let is_cloud = view.is_cloud();
            let (mut frame, guessed) =
                view.prepare(index, &mut warnings).map_err(|error| error.below(&format!("frames[{index}]")))?;
            is_guessed |= guessed;
            frame.is_cloud = is_cloud;
            if is_cloud {
                leave_unseen_out(&mut frame, &states);
            }
            frames.push(frame);
        }
        let cues = if cues.is_empty() { Cue::ALL.to_vec() } else { cues.to_vec() };
        let scene = Scene::new(frames, cues, is_guessed);
        let initial = initial(&scene, &candidates);
        let best = Round::from(initial, initial);
        warn_of_translations(&candidates, &mut warnings);
        Ok(Self {
            scene,
            candidates,
            warnings,
            width,
            passes: Passes::new(initial, states),
            best,
            stage: Stage::Starting,
            lens: None,
            report: None,
        })
    }

    /// Share of the work that is done, and a description of the current stage.
    #[must_use]
    pub fn progress(&self) -> (f64, &'static str) {
        match &self.stage {
            Stage::Starting => (0.85 * self.passes.progress(0.0), "looking for depth edges in the image"),
            Stage::Approaching { level, index, .. } => {
                let of_level = *index as f64 / self.passes.starts.len().max(1) as f64;
                let share = (*level as f64 + of_level) / SIGMAS.len() as f64;
                (0.85 * self.passes.progress(0.1 + 0.7 * share), "aligning depth edges with image edges")
            }
            Stage::Settling { rounds, at, done, .. } => {
                let share = (*at as f64 + *done as f64 / MOST_SETTLING as f64) / rounds.len() as f64;
                (0.85 * self.passes.progress(0.8 + 0.2 * share), "refining with all cues")
            }
            Stage::Judging { .. } => (0.85 * self.passes.progress(1.0), "judging the candidates"),
            Stage::Rereading { .. } | Stage::Reviewing { .. } => {
                // A pass that is due lowers the share of what is done.
                let done = if self.passes.is_due() { 0.0 } else { 1.0 };
                (0.85 * self.passes.progress(done), "trying other conventions")
            }
            Stage::Curves { done, .. } => {
                (0.88 + 0.12 * *done as f64 / self.scene.cues.len() as f64, "measuring sensitivity")
            }
            Stage::Done => (1.0, "done"),
        }
    }

    /// The report; `None` until the check is complete.
    #[must_use]
    pub const fn report(&self) -> Option<&CheckReport> {
        self.report.as_ref()
    }

    /// Does one slice of the work and returns whether the check is complete.
    pub fn step(&mut self) -> bool {
        self.stage = match std::mem::replace(&mut self.stage, Stage::Done) {
            Stage::Starting => {
                self.scene.prior_width = self.passes.prior_width();
                self.passes.find_starts(&self.scene);
                Stage::Approaching { level: 0, index: 0, planes: self.planes_of(0) }
            }
            Stage::Approaching { level, index, planes } => self.approach(level, index, planes),
            Stage::Settling { rounds, at, done, kept, planes } => self.settle(rounds, at, done, kept, planes),
            Stage::Judging { rounds, planes } => self.judge(&rounds, planes),
            Stage::Rereading { mut search, planes } => {
                if search.step(&self.scene, &planes) {
                    self.adopt(*search, planes)
                } else {
                    Stage::Rereading { search, planes }
                }
            }
            Stage::Reviewing { mut search, planes, optima } => {
                if search.step(&self.scene) {
                    self.adopt_views(*search, planes, optima)
                } else {
                    Stage::Reviewing { search, planes, optima }
                }
            }
            Stage::Curves { planes, findings, done } => {
                let (cue, _, weight) = &findings.cues[done];
                let curves = curves(&self.scene, &self.best, &findings.units, &planes, (*cue, *weight));
                if let Some(report) = &mut self.report {
                    report.sensitivity.extend(curves);
                }
                if done + 1 < findings.cues.len() {
                    Stage::Curves { planes, findings, done: done + 1 }
                } else {
                    self.look_ahead(&findings, &planes);
                    Stage::Done
                }
            }
            Stage::Done => Stage::Done,
        };
        matches!(self.stage, Stage::Done)
    }

    fn planes_of(&self, level: usize) -> Vec<Planes> {
        self.scene.planes(SIGMAS[level] * self.scene.scale)
    }

    /// Refines one pose at one level. After the last pose, the best ones proceed to the next level.
    fn approach(&mut self, level: usize, index: usize, planes: Vec<Planes>) -> Stage {
        if let Some(start) = self.passes.starts.get_mut(index) {
            if FINDING_ANEW.contains(&level) {
                self.scene.find_anew(start);
            }
            self.scene.approach(start, SIGMAS[level] * self.scene.scale, &planes);
            return Stage::Approaching { level, index: index + 1, planes };
        }
        self.passes.keep_apart(&self.scene, SURVIVORS[level]);
        if level + 1 == ENTERING {
            self.passes.enter(&self.scene);
        }
        if level + 1 < SIGMAS.len() {
            return Stage::Approaching { level: level + 1, index: 0, planes: self.planes_of(level + 1) };
        }
        let rounds = self.passes.rounds(&self.scene);
        Stage::Settling { rounds, at: 0, done: 0, kept: None, planes }
    }

    /// Ranks the optima and writes a report. If the first candidate does not pass, the search over its other readings follows the first
    /// pass. If it is off and none of them fits, another pass follows.
    fn judge(&mut self, rounds: &[Round], planes: Vec<Planes>) -> Stage {
        let mut optima = optima::ranked(&self.scene, rounds, &planes);
        // The best initial pose is kept unless another one is clearly better, so that rounding does not choose between
        // poses that fit about as well.
        let is_start = |optimum: &Optimum| optimum.is_equal() && optimum.round.state.pose == rounds[0].state.pose;
        if let Some(start) = optima.iter().position(is_start) {
            optima[..=start].rotate_right(1);
        }
        self.best = optima[0].round;
        let verdict = self.conclude(&optima, &planes).candidates.first().map(|first| first.verdict);
        let has_readings = self.passes.is_first() && verdict.is_some_and(|verdict| verdict != CheckVerdict::Consistent);
        if verdict.is_none_or(|verdict| verdict == CheckVerdict::Off) {
            self.plan_pass(&optima);
        }
        if self.passes.is_due() && !has_readings {
            return Stage::Starting;
        }
        self.lens = distortion::left_out(&mut self.scene, &self.best);
        self.report = Some(self.conclude(&optima, &planes));
        if !has_readings {
            return curves_of(optima, planes);
        }
        match self.review(&Reading::SUGGESTED) {
            Some(search) => Stage::Reviewing { search, planes, optima: Some(optima) },
            None => self.reread(optima, planes),
        }
    }

    /// Plans another pass if the frames contradict the pose about which the last one looked.
    fn plan_pass(&mut self, optima: &[Optimum]) {
        let state = optima[0].round.state;
        let judge = self.judge_of(&[&optima[0]]).0;
        let is_off = |centre: &State| judge.judge("", &state, centre, None).verdict == CheckVerdict::Off;
        if self.scene.is_seen(&state) {
            self.passes.plan(optima, is_off);
        }
    }

    /// The search over readings of the views for the first candidate, if any applies. They are compared by edges, so none is tried without
    /// this cue. Behind a guessed camera another reading could fit by chance.
    fn review(&self, readings: &'static [Reading]) -> Option<Box<Reviewing>> {
        let applies = |reading: &Reading| reading.frame(&self.scene.frames[0]).is_some();
        let is_open =
            !self.scene.focal_is_free && self.scene.cues.contains(&Cue::Edges) && readings.iter().any(applies);
        let (_, candidate) = self.candidates.first().filter(|_| is_open)?;
        Some(Box::new(Reviewing::new(readings, &self.scene, candidate, &self.best)))
    }

    /// Tries other conventions of the first candidate, unless one is named already.
    fn reread(&self, optima: Vec<Optimum>, planes: Vec<Planes>) -> Stage {
        match self.candidates.first() {
            Some((_, candidate)) if !self.report.as_ref().is_some_and(names_reading) => {
                let search = Box::new(Rereading::new(&self.scene, candidate, optima));
                Stage::Rereading { search, planes }
            }
            _ => curves_of(optima, planes),
        }
    }

    /// Adopts the best reading if it fits clearly and significantly better than every pose found near the candidate.
    fn adopt(&mut self, search: Rereading, planes: Vec<Planes>) -> Stage {
        let optima = search.end(&self.scene, &planes);
        let lens = self.lens;
        if optima::is_reading_ahead(&optima) {
            self.lens = distortion::left_out(&mut self.scene, &optima[0].round);
            let report = self.conclude(&optima[..1], &planes);
            if names_reading(&report) {
                self.best = optima[0].round;
                self.report = Some(report);
                return curves_of(optima, planes);
            }
        }
        self.lens = lens;
        match self.review(&Reading::VIEWS) {
            Some(search) => Stage::Reviewing { search, planes, optima: None },
            None => self.keep_report(planes),
        }
    }

    /// Adopts the frames in the best reading of the views if the candidate is not off in them. Otherwise, with `optima`, tries
    /// other conventions of the candidate.
    fn adopt_views(&mut self, search: Reviewing, planes: Vec<Planes>, optima: Option<Vec<Optimum>>) -> Stage {
        if let Some(curves) = search.end().and_then(|refining| self.conclude_views(refining)) {
            return curves;
        }
        match optima {
            Some(optima) => self.reread(optima, planes),
            None => self.keep_report(planes),
        }
    }

    /// Adopts the frames in another reading and the report on them, or leaves both as they are.
    fn conclude_views(&mut self, refining: Refining) -> Option<Stage> {
        let Refining { reading, scene, round, planes: read, .. } = refining;
        let (lens, scene) = (self.lens, std::mem::replace(&mut self.scene, scene));
        let optimum = Optimum::at(&self.scene, round, Some(reading), &read);
        self.lens = distortion::left_out(&mut self.scene, &round);
        let as_given = self.report.as_ref().and_then(|report| report.candidates.first());
        if let Some(report) = as_given.and_then(|first| self.conclude_in(reading, first, &optimum, &read)) {
            self.best = round;
            self.report = Some(report);
            return Some(curves_of(vec![optimum], read));
        }
        (self.lens, self.scene) = (lens, scene);
        None
    }

    /// No reading fits: another pass follows if one is due. Otherwise the report is kept, and the curves are those of its pose.
    fn keep_report(&self, planes: Vec<Planes>) -> Stage {
        if self.passes.is_due() {
            return Stage::Starting;
        }
        let findings = Box::new(self.scene.findings(&self.best, &planes));
        Stage::Curves { planes, findings, done: 0 }
    }

    /// Adds the frame to take next, unless the estimate puts hardly any point onto the image.
    fn look_ahead(&mut self, findings: &Findings, planes: &[Planes]) {
        if let Some(report) = self.report.as_mut().filter(|report| report.overlap >= LEAST_COMPARED_SHARE) {
            report.next = next(&self.scene, &self.best, findings, planes, &report.covariance);
        }
    }

    /// Refines one of the poses by one round with all cues. After the last pose, the candidates are judged.
    fn settle(
        &mut self,
        mut rounds: Vec<Round>,
        at: usize,
        done: usize,
        mut kept: Option<Kept>,
        planes: Vec<Planes>,
    ) -> Stage {
        let moved = self.scene.settle(&mut rounds[at], &mut kept, &planes);
        if moved >= ARRIVED && done + 1 < MOST_SETTLING {
            Stage::Settling { rounds, at, done: done + 1, kept, planes }
        } else if at + 1 < rounds.len() {
            Stage::Settling { rounds, at: at + 1, done: 0, kept: None, planes }
        } else {
            Stage::Judging { rounds, planes }
        }
    }
}

/// Whether the first candidate is off, and fits in another reading.
fn names_reading(report: &CheckReport) -> bool {
    report.candidates.first().is_some_and(|first| matches!(first.reason, CheckReason::Misread { .. }))
}

fn curves_of(mut optima: Vec<Optimum>, planes: Vec<Planes>) -> Stage {
    Stage::Curves { planes, findings: Box::new(optima.swap_remove(0).findings), done: 0 }
}

/// Warns of translations that are probably in millimetres.
fn warn_of_translations(candidates: &[(String, State)], warnings: &mut Vec<Warning>) {
    /// A distance larger than any rig, metres.
    const FARTHEST_APART: f64 = 10.0;
    for (name, candidate) in candidates {
        let length = candidate.pose.translation.norm();
        if length > FARTHEST_APART {
            warnings.push(Warning::of_candidate(name, WarningKind::FarApart { metres: length }));
        }
    }
}
