//! Profiles from which the built-in surfaces are composed; lengths and heights are in samples.

/// Half circle of the given depth over -1 .. 1, continued outside by descending straight lines.
pub(super) fn round(offset: f64, depth: f64) -> f64 {
    dome_of(offset * offset, depth)
}

/// Front of an ellipsoid about `centre` with `radii` across the view.
pub(super) fn dome(x: f64, y: f64, centre: [f64; 2], radii: [f64; 2], depth: f64) -> f64 {
    dome_of(((x - centre[0]) / radii[0]).powi(2) + ((y - centre[1]) / radii[1]).powi(2), depth)
}

fn dome_of(square: f64, depth: f64) -> f64 {
    if square < 1.0 { depth * (1.0 - square).sqrt() } else { -2.0 * depth * (square.sqrt() - 1.0) }
}

/// Gaussian bell of height one.
pub(super) fn bell(at: f64, centre: f64, sigma: f64) -> f64 {
    (-0.5 * ((at - centre) / sigma).powi(2)).exp()
}

/// Product of two bells.
pub(super) fn bump(x: f64, y: f64, centre: [f64; 2], sigma: [f64; 2]) -> f64 {
    bell(x, centre[0], sigma[0]) * bell(y, centre[1], sigma[1])
}

/// Smooth step from 0 to 1 about zero.
pub(super) fn step(at: f64) -> f64 {
    1.0 / (1.0 + (-at).exp())
}

/// One between `centre - half` and `centre + half`, with soft flanks.
pub(super) fn window(at: f64, centre: f64, half: f64) -> f64 {
    step((half - (at - centre).abs()) / 5.0)
}

/// Rounds off an end: the fourth power of `past / reach`, and zero if both have different signs.
pub(super) fn overhang(past: f64, reach: f64) -> f64 {
    (past / reach).max(0.0).powi(4)
}

/// The larger of two heights, with a fillet of about `blend` samples.
pub(super) fn union(a: f64, b: f64, blend: f64) -> f64 {
    a.max(b) + blend * (-(a - b).abs() / blend).exp().ln_1p()
}
