//! From the optima of a check to its report: the distribution of the estimate and the verdicts on the candidates.

use nalgebra::Vector3;

use super::check::CalibrationCheck;
use super::distribution::{Distribution, Part, PoseMatrix, PoseVector, VARIANCE};
use super::guessed;
use super::health::Health;
use super::optima::Optimum;
use super::planes::Planes;
use super::readings::Reading;
use super::reason::{CheckReason, Margin, Warning, WarningKind};
use super::registration::{Findings, Round};
use super::report::{CheckReport, CueReport, FrameReport};
use super::rereading::readings_of;
use super::unknowns::{FOCAL, Matrix, POSE, State, Vector, add_square};
use super::verdict::{CandidateReport, CheckVerdict, Judge, LEAST_COMPARED_SHARE};

/// Variance if nothing at all is known, squared pixels.
const FARTHEST: f64 = 1e6;
/// The inverse fits clearly better if the candidate's error is at least this multiple of the error of the inverse.
const CLEARLY: f64 = 3.0;
/// Ratio of two densities above which a candidate counts as misread. The first is the density of the reading in the
/// distribution of the estimate, the second that of the candidate in the prior about the estimate. The limit is twenty
/// for each of the sixteen readings of poses.
const MISREAD: f64 = 320.0;

impl CalibrationCheck {
    /// The report on the optima, best first.
    pub(super) fn conclude(&self, optima: &[Optimum], planes: &[Planes]) -> CheckReport {
        let Optimum { findings, round, .. } = &optima[0];
        let (units, state) = (findings.units, round.state);
        let frame = &self.scene.frames[0];
        let first = self.judge_of(&[&optima[0]]);
        let optima = self.possible(optima, &first.0);
        let of_all = (optima.len() > 1).then(|| self.judge_of(&optima));
        let (judge, covariance) = of_all.as_ref().unwrap_or(&first);
        let mut candidates = self.candidate_reports(judge, optima[0], covariance);
        self.hear_other_optima(&mut candidates, &optima, &first.0, planes);
        // Later passes follow only if no reading fits.
        if self.passes.is_first() {
            self.name_reading(&mut candidates, judge, optima[0]);
        }
        let warnings = self.all_warnings(judge, &state);
        let health = if self.scene.is_seen(&state) { judge.estimate() } else { Judge::blind(self.width) };
        let (verdict, reason) = first_verdict(&candidates, &warnings, health);
        let scaled = Matrix::from_diagonal(&units.of);
        let metric = scaled * covariance * scaled;
        CheckReport {
            verdict,
            reason,
            warnings,
            estimate: state.pose,
            overlap: self.scene.overlap(&state),
            middle: units.middle.into(),
            covariance: metric.fixed_view::<POSE, POSE>(0, 0).into(),
            focal: self.scene.focal_is_free.then(|| [state.focal, metric[(FOCAL, FOCAL)].sqrt()]),
            health,
            tolerance: judge.tolerance(),
            candidates,
            cues: CueReport::all(findings, frame.pixel),
            frames: FrameReport::all(&self.scene, findings),
            sensitivity: vec![],
            next: None,
        }
    }

    /// The report if another reading of the views explains why the first candidate does not pass; `None` unless its error in
    /// that reading may lie within the tolerance. `as_given` is the report on the candidate in the views as they were given.
    pub(super) fn conclude_in(
        &self,
        reading: Reading,
        as_given: &CandidateReport,
        optimum: &Optimum,
        planes: &[Planes],
    ) -> Option<CheckReport> {
        let mut report = self.conclude(std::slice::from_ref(optimum), planes);
        let tolerance = self.judge_of(&[optimum]).0.tolerance();
        let may_pass =
            |first: &&mut CandidateReport| first.verdict != CheckVerdict::Off && first.health.interval[0] <= tolerance;
        let first = report.candidates.first_mut().filter(may_pass)?;
        let reason = CheckReason::Misread { reading, margin: Margin { health: first.health, tolerance } };
        *first = CandidateReport { verdict: CheckVerdict::Off, reason: reason.clone(), ..as_given.clone() };
        (report.verdict, report.reason) = (CheckVerdict::Off, reason);
        Some(report)
    }

    /// The best optimum and those that the frames do not exclude. A candidate hardly ever agrees with the best optimum
    /// by chance. If one agrees, only the optima that fit about as well as the best are kept.
    fn possible<'a>(&self, optima: &'a [Optimum], first: &Judge) -> Vec<&'a Optimum> {
        let state = optima[0].round.state;
        let agrees = |(name, candidate): &(String, State)| {
            first.judge(name, &state, candidate, None).verdict == CheckVerdict::Consistent
        };
        let is_confirmed = self.candidates.iter().any(agrees);
        let counts = |other: &&Optimum| if is_confirmed { other.is_equal() } else { other.is_possible() };
        let is_seen = |other: &&Optimum| self.scene.is_seen(&other.round.state);
        std::iter::once(&optima[0]).chain(optima[1..].iter().filter(counts).filter(is_seen)).collect()
    }

    /// Makes a candidate undecided if an optimum contradicts its verdict: "off" has to hold for each optimum, and the
    /// candidate itself has to fit worse than the best one.
    fn hear_other_optima(
        &self,
        reports: &mut [CandidateReport],
        optima: &[&Optimum],
        first: &Judge,
        planes: &[Planes],
    ) {
        let (best, others) = (optima[0], &optima[1..]);
        let judges: Vec<Judge> = others.iter().map(|optimum| self.judge_of(&[*optimum]).0).collect();
        for (report, (name, candidate)) in reports.iter_mut().zip(&self.candidates) {
            let verdict = |judge: &Judge, at: &Optimum| judge.judge(name, &at.round.state, candidate, None).verdict;
            let is_contradicted = match report.verdict {
                CheckVerdict::Off => {
                    judges.iter().zip(others).any(|(judge, other)| verdict(judge, other) != CheckVerdict::Off)
                        || best.reading.is_none()
                            && self.scene.is_seen(candidate)
                            && !best.excludes(&self.scene, *candidate, planes)
                }
                CheckVerdict::Consistent => false,
                CheckVerdict::Undecided => is_open(&report.reason) && verdict(first, best) != CheckVerdict::Undecided,
            };
            if is_contradicted {
                report.between_optima(first.tolerance());
            }
        }
    }

    /// If the first candidate is off and fits in another reading, names that reading as the reason.
    fn name_reading(&self, reports: &mut [CandidateReport], judge: &Judge, best: &Optimum) {
        let (Some(report), Some((name, candidate))) = (reports.first_mut(), self.candidates.first()) else { return };
        if report.verdict != CheckVerdict::Off {
            return;
        }
        let Optimum { findings: Findings { units, prior, .. }, round: Round { state, .. }, .. } = best;
        let from_best = |to: &State| units.between(state, to).fixed_rows::<POSE>(0).into_owned();
        let scale = prior.fixed_view::<POSE, POSE>(0, 0).try_inverse().unwrap_or_else(PoseMatrix::zeros);
        let of_prior = Distribution::new(vec![Part { weight: 1.0, middle: PoseVector::zeros(), scale }]);
        let least = MISREAD * of_prior.density(&from_best(candidate));
        let likely = |(reading, pose)| {
            let read = State::at(pose);
            let density = judge.density(&from_best(&read));
            let own = judge.judge(name, state, &read, None);
            (own.verdict != CheckVerdict::Off && density > least).then_some((density, own.health, reading))
        };
        let fitting = readings_of(&self.scene, &candidate.pose).into_iter().filter_map(likely);
        if let Some((_, health, reading)) = fitting.max_by(|a, b| a.0.total_cmp(&b.0)) {
            report.reason = CheckReason::Misread { reading, margin: Margin { health, tolerance: judge.tolerance() } };
        }
    }

    /// The distribution of the estimate over some optima, and its covariance in the units of the first optimum, which
    /// is the best.
    pub(super) fn judge_of(&self, optima: &[&Optimum]) -> (Judge, Matrix) {
        let best = optima[0];
        let (state, units) = (best.round.state, best.findings.units);
        let frame = &self.scene.frames[0];
        let cloud = self.scene.cloud(&state);
        let distribution = Distribution::new(optima.iter().map(|optimum| self.part(optimum, best)).collect());
        let mut covariance = self.scale(&best.findings, &state, &cloud) * VARIANCE;
        covariance.fixed_view_mut::<POSE, POSE>(0, 0).copy_from(&distribution.covariance());
        let judge = Judge::new(units, &state.camera(&frame.camera), &cloud, distribution, frame.pixel, self.width)
            .explaining(if self.scene.focal_is_free { guessed::explains(self.width) } else { 0.0 });
        (judge, covariance)
    }

    /// The distribution about an optimum in the units of the best.
    fn part(&self, optimum: &Optimum, best: &Optimum) -> Part {
        let (from, own) = (best.round.state, optimum.round.state);
        let units = best.findings.units;
        let middle = units.between(&from, &own);
        let mut scale = Matrix::zeros();
        // Each column of the scale's root is a step about this optimum, which is converted to the units of the best
        // one.
        if let Some(root) = self.scale(&optimum.findings, &own, &self.scene.cloud(&own)).cholesky() {
            for column in root.l_dirty().column_iter().enumerate() {
                let sigma = Vector::from_fn(|row, _| if row < column.0 { 0.0 } else { column.1[row] });
                let moved = units.between(&from, &optimum.findings.units.step(&own, &sigma)) - middle;
                add_square(&mut scale, &moved, 1.0);
            }
        }
        Part {
            weight: optimum.weight(),
            middle: middle.fixed_rows::<POSE>(0).into(),
            scale: scale.fixed_view::<POSE, POSE>(0, 0).into(),
        }
    }

    fn candidate_reports(&self, judge: &Judge, best: &Optimum, covariance: &Matrix) -> Vec<CandidateReport> {
        let estimate = best.round.state;
        let weakest = judge.weakest(covariance);
        let overlap = self.scene.overlap(&estimate);
        let is_silent = best.findings.cues.iter().all(|(.., weight)| *weight == 0.0);
        let report = |(name, candidate): &(String, State)| {
            let mut report = judge.judge(name, &estimate, candidate, weakest);
            if is_silent {
                report.without_evidence();
            }
            if !self.scene.is_seen(candidate) {
                report.without_points(overlap >= LEAST_COMPARED_SHARE, self.width);
            } else if overlap < LEAST_COMPARED_SHARE {
                report.with_little_overlap(overlap);
            }
            report
        };
        self.candidates.iter().map(report).collect()
    }

    fn all_warnings(&self, judge: &Judge, best: &State) -> Vec<Warning> {
        let mut warnings = self.warnings.clone();
        self.warn_of_inverses(judge, best, &mut warnings);
        if let Some(term) = self.lens {
            let kind = WarningKind::LensLeftOut { k1: term };
            warnings.push(Warning { name: String::new(), field: "frames".into(), kind });
        }
        warnings
    }

    /// Scale of the estimate's distribution. If the sums overflow, it is that of the prior.
    fn scale(&self, findings: &Findings, state: &State, cloud: &[Vector3<f64>]) -> Matrix {
        let of_prior = || findings.prior.cholesky().map_or(Matrix::identity() * FARTHEST, |c| c.inverse());
        let scale = findings.total.covariance(&findings.prior).unwrap_or_else(of_prior);
        if !self.scene.focal_is_free {
            return scale;
        }
        let frame = &self.scene.frames[0];
        let (camera, width) = (state.camera(&frame.camera), frame.planes.size.width as f64);
        scale + guessed::covariance(&findings.units, &camera, cloud, width, &findings.prior)
    }

    /// Warns of the most common mistake, P_depth = R P_colour + t.
    fn warn_of_inverses(&self, judge: &Judge, best: &State, warnings: &mut Vec<Warning>) {
        for (name, candidate) in &self.candidates {
            let inverse = State::at(candidate.pose.inverse());
            let [as_it_is, inverted] = [candidate, &inverse].map(|state| judge.judge(name, best, state, None));
            let fits = inverted.verdict != CheckVerdict::Off && as_it_is.verdict != CheckVerdict::Consistent;
            if fits && CLEARLY * inverted.health.pixels < as_it_is.health.pixels {
                let [pixels, inverted_pixels] = [as_it_is, inverted].map(|report| report.health.pixels);
                warnings.push(Warning::of_candidate(name, WarningKind::FitsInverted { pixels, inverted_pixels }));
            }
        }
    }
}

/// Whether only the distribution of the estimate left the verdict open.
const fn is_open(reason: &CheckReason) -> bool {
    matches!(reason, CheckReason::TooClose(_) | CheckReason::Unconstrained { .. } | CheckReason::GuessedCamera { .. })
}

/// The verdict on the first candidate. A warning caps it, because the inputs may have been misread, unless it is about another
/// candidate.
fn first_verdict(candidates: &[CandidateReport], warnings: &[Warning], health: Health) -> (CheckVerdict, CheckReason) {
    let (verdict, reason) = match candidates.first() {
        Some(first) => (first.verdict, first.reason.clone()),
        None => (CheckVerdict::Undecided, CheckReason::NoCandidate { pixels: health.pixels }),
    };
    let is_of_another = |warning: &&Warning| {
        let name = warning.field.strip_prefix("candidates.");
        candidates.iter().skip(1).any(|other| Some(other.name.as_str()) == name)
    };
    match (warnings.iter().find(|warning| !is_of_another(warning)), verdict) {
        (Some(warning), CheckVerdict::Consistent) => {
            let reason = CheckReason::Doubtful { warning: Box::new(warning.clone()), reason: Box::new(reason) };
            (CheckVerdict::Undecided, reason)
        }
        _ => (verdict, reason),
    }
}
