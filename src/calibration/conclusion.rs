//! From the optima of a check to its report: the distribution of the estimate and the verdicts on the candidates.

use nalgebra::Vector3;

use super::check::CalibrationCheck;
use super::guessed;
use super::health::Health;
use super::optima::Optimum;
use super::readings::Reading;
use super::reason::{CheckReason, Margin, Warning, WarningKind};
use super::registration::Findings;
use super::report::{CheckReport, CueReport, FrameReport};
use super::unknowns::{Matrix, POSE, State};
use super::verdict::{CandidateReport, CheckVerdict, Judge};

/// Variance if nothing at all is known, squared pixels.
const FARTHEST: f64 = 1e6;
/// Another reading of a candidate fits clearly better if the candidate's error is at least this multiple of the error of
/// the reading.
const CLEARLY: f64 = 3.0;
/// Least share of the depth points that the estimate puts onto the image if it is to judge a candidate. The rest is not
/// compared with anything, and a wrong pose can always fit a small part.
const LEAST_OVERLAP: f64 = 0.15;

impl CalibrationCheck {
    /// The report on the optima, best first.
    pub(super) fn conclude(&self, optima: &[Optimum]) -> CheckReport {
        let Optimum { findings, round, .. } = &optima[0];
        let (units, state) = (findings.units, round.state);
        let frame = &self.scene.frames[0];
        let (judge, covariance) = self.judge_of(&optima[0]);
        let mut candidates = self.candidate_reports(&judge, &optima[0], &covariance);
        self.hear_other_optima(&mut candidates, &optima[1..]);
        self.name_reading(&mut candidates, &judge, state);
        let warnings = self.all_warnings(&judge, &state);
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
            focal: self.scene.focal_is_free.then(|| [state.focal, metric[(7, 7)].sqrt()]),
            health,
            candidates,
            cues: CueReport::all(findings, frame.pixel),
            frames: FrameReport::all(&self.scene, findings),
            sensitivity: vec![],
        }
    }

    /// Makes a candidate undecided if another optimum contradicts its verdict. "Off" excludes the candidate, so every
    /// optimum that the frames do not exclude counts, and an undecided verdict there contradicts as well. A candidate that
    /// is consistent hardly met the best optimum by chance, so only optima that fit about as well count.
    fn hear_other_optima(&self, reports: &mut [CandidateReport], others: &[Optimum]) {
        let is_seen = |other: &&Optimum| other.is_possible() && self.scene.is_seen(&other.round.state);
        for other in others.iter().filter(is_seen) {
            let (judge, _) = self.judge_of(other);
            for (report, (name, candidate)) in reports.iter_mut().zip(&self.candidates) {
                let own = judge.judge(name, &other.round.state, candidate, None).verdict;
                let is_contradicted = match report.verdict {
                    CheckVerdict::Off => own != CheckVerdict::Off,
                    CheckVerdict::Consistent => own == CheckVerdict::Off && other.is_equal(),
                    CheckVerdict::Undecided => false,
                };
                if is_contradicted {
                    report.between_optima(judge.tolerance());
                }
            }
        }
    }

    /// If the first candidate is off and fits in another reading, names that reading as the reason.
    fn name_reading(&self, reports: &mut [CandidateReport], judge: &Judge, best: State) {
        let (Some(report), Some((name, candidate))) = (reports.first_mut(), self.candidates.first()) else { return };
        if report.verdict != CheckVerdict::Off {
            return;
        }
        let error = |reading: Reading| {
            let state = State::at(reading.of(&candidate.pose)?);
            let own = judge.judge(name, &best, &state, None);
            let fits = own.verdict != CheckVerdict::Off;
            (fits && CLEARLY * own.health.pixels < report.health.pixels).then_some((own.health, reading))
        };
        let fitting = Reading::ALL.into_iter().filter_map(error);
        if let Some((health, reading)) = fitting.min_by(|a, b| a.0.pixels.total_cmp(&b.0.pixels)) {
            report.reason = CheckReason::Misread { reading, margin: Margin { health, tolerance: judge.tolerance() } };
        }
    }

    /// The distribution about an optimum, and its covariance in the optimum's units.
    pub(super) fn judge_of(&self, Optimum { round, findings, .. }: &Optimum) -> (Judge, Matrix) {
        let state = round.state;
        let frame = &self.scene.frames[0];
        let cloud = self.scene.cloud(&state);
        let scale = self.scale(findings, &state, &cloud);
        let judge = Judge::new(findings.units, &state.camera(&frame.camera), &cloud, &scale, frame.pixel, self.width)
            .explaining(if self.scene.focal_is_free { guessed::explains(self.width) } else { 0.0 });
        (judge, scale * Judge::VARIANCE)
    }

    fn candidate_reports(&self, judge: &Judge, best: &Optimum, covariance: &Matrix) -> Vec<CandidateReport> {
        let estimate = best.round.state;
        let weakest = judge.weakest(covariance);
        let is_seen = self.scene.is_seen(&estimate);
        let overlap = self.scene.overlap(&estimate);
        let is_silent = best.findings.cues.iter().all(|(.., weight)| *weight == 0.0);
        let report = |(name, candidate): &(String, State)| {
            let mut report = judge.judge(name, &estimate, candidate, weakest);
            if is_silent {
                report.without_evidence();
            }
            if !is_seen || !self.scene.is_seen(candidate) {
                report.without_points(is_seen, self.width);
            }
            if is_seen && overlap < LEAST_OVERLAP {
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
        let told = || findings.prior.cholesky().map_or(Matrix::identity() * FARTHEST, |c| c.inverse());
        let scale = findings.total.covariance(&findings.prior).unwrap_or_else(told);
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

/// The verdict on the first candidate. A warning caps it, because the inputs may have been misread.
fn first_verdict(candidates: &[CandidateReport], warnings: &[Warning], health: Health) -> (CheckVerdict, CheckReason) {
    let (verdict, reason) = match candidates.first() {
        Some(first) => (first.verdict, first.reason.clone()),
        None => (CheckVerdict::Undecided, CheckReason::NoCandidate { pixels: health.pixels }),
    };
    match (warnings.first(), verdict) {
        (Some(warning), CheckVerdict::Consistent) => {
            let reason = CheckReason::Doubtful { warning: Box::new(warning.clone()), reason: Box::new(reason) };
            (CheckVerdict::Undecided, reason)
        }
        _ => (verdict, reason),
    }
}
