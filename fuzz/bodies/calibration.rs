//! The check of a calibration on small frames, and the overlay of a frame.

use arbitrary::{Result, Unstructured};
use bimodal_stereo::{CalibrationCheck, CheckReport, Cue, DepthSamples, Health, Lens, Pinhole, RigView, overlay};

use super::named;
use super::numbers::{light, number, perhaps, pose, rarely, unit};
use super::views::{depth, image, relief};

/// Limit of the slices of a check (starts, levels, cues). Views this small end long before it.
const MOST_SLICES: usize = 400;

pub fn run(data: &[u8]) {
    let _ = attempt(&mut Unstructured::new(data));
}

fn attempt(u: &mut Unstructured<'_>) -> Result<()> {
    let mut views = vec![view(u)?];
    while views.len() < 3 && rarely(u, 4)? {
        views.push(view(u)?);
    }
    let mut candidates = vec![("factory".to_owned(), pose(u)?)];
    while candidates.len() < 4 && rarely(u, 3)? {
        candidates.push((format!("candidate {}", candidates.len()), pose(u)?));
    }
    let mut cues = Vec::new();
    while cues.len() < 3 && rarely(u, 4)? {
        cues.push(*u.choose(&Cue::ALL)?);
    }
    if rarely(u, 8)? {
        candidates.clear();
    }
    if rarely(u, 4)? {
        match overlay(views[0].clone(), &candidates.first().map_or_else(|| pose(u), |candidate| Ok(candidate.1))?) {
            Ok(overlay) => {
                assert!(overlay.points.len() == overlay.positions.len() && overlay.edges.len().is_multiple_of(2));
            }
            Err(error) => named(&error),
        }
    }
    let (frames, count) = (views.len(), candidates.len());
    match CalibrationCheck::new(views, candidates, &cues) {
        Ok(check) => finish(check, frames, count),
        Err(error) => named(&error),
    }
    Ok(())
}

fn finish(mut check: CalibrationCheck, frames: usize, candidates: usize) {
    let mut slices = 0;
    let mut before = 0.0;
    while !check.step() {
        let (share, words) = check.progress();
        assert!((0.0..=1.0).contains(&share) && share >= before - 1e-9 && !words.is_empty(), "{before} then {share}");
        before = share;
        slices += 1;
        assert!(slices < MOST_SLICES, "a check of small views does not end");
    }
    let report = check.report().unwrap_or_else(|| panic!("done without a report"));
    judge(report);
    assert_eq!([report.frames.len(), report.candidates.len()], [frames, candidates]);
}

fn judge(report: &CheckReport) {
    assert!(report.estimate.validate("estimate").is_ok(), "{:?}", report.estimate);
    assert!(report.covariance.iter().all(|value| value.is_finite()), "{}", report.covariance);
    assert!(!report.reason.to_string().contains("NaN"), "{}", report.reason);
    assert!(report.warnings.iter().all(|warning| !warning.to_string().contains("NaN")), "{:?}", report.warnings);
    let Health { pixels, .. } = report.health;
    assert!(pixels >= 0.0, "{:?}", report.health);
    for share in report.cues.iter().map(|cue| cue.share).chain(report.frames.iter().map(|frame| frame.share)) {
        assert!((-1e-9..=1.0 + 1e-9).contains(&share), "a share of {share}");
    }
    for candidate in &report.candidates {
        assert!(!candidate.reason.to_string().contains("NaN"), "{}", candidate.reason);
    }
}

/// A frame of a rig: the relief at a distance of a metre, in front of both cameras.
fn view(u: &mut Unstructured<'_>) -> Result<RigView> {
    let (light, relief) = (light(u)?, relief(u)?);
    let image = image(u, &relief, &light)?;
    let depth = depth(u, &relief, [16, 16])?;
    // A pixel of the relief is about a centimetre here.
    let plain = if matches!(depth.samples, DepthSamples::Integer(_)) { 0.001 } else { 0.02 };
    let sizes = [[image.width, image.height], [depth.width, depth.height]];
    Ok(RigView {
        name: "frame".into(),
        image_size: sizes[0],
        image: image.samples,
        transfer: image.transfer,
        image_mask: image.mask,
        image_camera: if rarely(u, 8)? { None } else { Some(rig_camera(u, sizes[0])?) },
        depth_size: sizes[1],
        depth: depth.samples,
        unit: if rarely(u, 8)? { perhaps(u, plain)? } else { Some(plain) },
        intensity: None,
        depth_mask: depth.mask,
        depth_camera: if rarely(u, 8)? { None } else { Some(rig_camera(u, sizes[1])?) },
    })
}

pub fn rig_camera(u: &mut Unstructured<'_>, size: [usize; 2]) -> Result<Pinhole> {
    let [cx, cy] = size.map(|side| (side as f64 - 1.0) / 2.0);
    let lens = match u.int_in_range(0..=5)? {
        0..=2 => Lens::None,
        3 | 4 => {
            let mut coefficients = [0.0; 8];
            for coefficient in &mut coefficients {
                let plain = 0.1 * unit(u)?;
                *coefficient = number(u, plain)?;
            }
            Lens::Brown(coefficients)
        }
        _ => {
            let mut coefficients = [0.0; 4];
            for coefficient in &mut coefficients {
                let plain = 0.1 * unit(u)?;
                *coefficient = number(u, plain)?;
            }
            Lens::Fisheye(coefficients)
        }
    };
    Ok(Pinhole { fx: number(u, 24.0)?, fy: number(u, 24.0)?, cx: number(u, cx)?, cy: number(u, cy)?, lens })
}
