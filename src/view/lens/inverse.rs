//! Inversion of the distorted radius, shared by both lens models.

/// Largest number of rounds of Newton's method; usual lenses take three, and halving the bracket down to rounding takes
/// fifty.
pub(super) const MOST_ROUNDS: usize = 60;
/// Distance in pixels at which a ray counts as found, a hundredth of the step between coordinates in f32.
pub(super) const RETURN_DISTANCE: f64 = 1e-7;
/// Largest slope of a ray behind Brown's lens, 89.4 degrees off the axis. The model has no ray at 90 degrees.
pub(super) const LARGEST_SLOPE: f64 = 100.0;
/// Number of radii at which the growth of the distorted radius is checked, evenly spaced in their squares.
pub(super) const FOLD_SAMPLES: usize = 16;

/// Length in pixels of a step in the plane of the slopes, given the focal lengths along x and y.
pub(super) fn pixels([fx, fy]: [f64; 2], [right, down]: [f64; 2]) -> f64 {
    (fx * right).hypot(fy * down)
}

/// The argument at which a function reaches `target`, by Newton's method within a bracket. The function grows from zero
/// up to its first fold. It returns its value, its derivative, and whether it has grown all the way. If the target lies
/// beyond its range, the result is the fold or `most`.
pub(super) fn inverse(function: impl Fn(f64) -> (f64, f64, bool), target: f64, most: f64) -> f64 {
    let (mut low, mut high) = (0.0, most);
    let mut at = target.min(0.5 * most);
    for _ in 0..MOST_ROUNDS {
        let (value, slope, grows) = function(at);
        if grows && value <= target {
            low = at;
        } else {
            high = at;
        }
        let step = (target - value) / slope;
        if grows && step.abs() <= 2.0 * f64::EPSILON * at {
            return at;
        }
        at = if grows && at + step > low && at + step < high { at + step } else { 0.5 * (low + high) };
    }
    low
}
