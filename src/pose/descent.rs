//! Levenberg and Marquardt's damping of Gauss-Newton steps, which have to lower an objective.

/// Initial damping, as a share of the diagonal.
const FIRST: f64 = 1e-3;
/// Factors after a success and after a failure, and the smallest damping.
const AFTER_SUCCESS: f64 = 0.2;
const AFTER_FAILURE: f64 = 8.0;
const LEAST: f64 = 1e-9;

/// The damping of a descent, kept from step to step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Damping(f64);

/// A step that lowered the objective.
pub(crate) struct Lowered<State> {
    pub state: State,
    pub objective: f64,
    /// Length of the step, in the units of its unknowns.
    pub size: f64,
}

impl Damping {
    pub const FIRST: Self = Self(FIRST);

    /// Returns the first of at most `attempts` steps, each damped more than the previous one, that does not raise the
    /// objective. `step` computes a step for a damping, or `None` if its equations have no solution.
    pub fn lower<State>(
        &mut self,
        attempts: usize,
        objective: f64,
        mut step: impl FnMut(f64) -> Option<Lowered<State>>,
    ) -> Option<Lowered<State>> {
        for _ in 0..attempts {
            // This comparison also rejects an objective of NaN.
            if let Some(lowered) = step(self.0).filter(|lowered| lowered.objective <= objective) {
                self.0 = (AFTER_SUCCESS * self.0).max(LEAST);
                return Some(lowered);
            }
            self.0 *= AFTER_FAILURE;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rosenbrock's valley, with the two residuals 10 (y - x^2) and 1 - x.
    fn objective([x, y]: [f64; 2]) -> f64 {
        100.0 * (y - x * x).powi(2) + (1.0 - x).powi(2)
    }

    fn stepped([x, y]: [f64; 2], damping: f64) -> Option<Lowered<[f64; 2]>> {
        let residuals = nalgebra::Vector2::new(10.0 * (y - x * x), 1.0 - x);
        let jacobian = nalgebra::Matrix2::new(-20.0 * x, 10.0, -1.0, 0.0);
        let mut matrix = jacobian.transpose() * jacobian;
        (0..2).for_each(|k| matrix[(k, k)] *= 1.0 + damping);
        let step = -matrix.cholesky()?.solve(&(jacobian.transpose() * residuals));
        let state = [x + step.x, y + step.y];
        Some(Lowered { state, objective: objective(state), size: step.norm() })
    }

    #[test]
    fn a_valley_is_followed_to_its_end_and_never_upwards() {
        let (mut state, mut damping) = ([-1.2, 1.0], Damping::FIRST);
        for _ in 0..60 {
            let before = objective(state);
            if let Some(lowered) = damping.lower(8, before, |damping| stepped(state, damping)) {
                assert!(lowered.objective <= before);
                state = lowered.state;
            }
        }
        assert!(objective(state) < 1e-20, "{state:?}");
    }

    #[test]
    fn attempts_are_damped_more_and_more_until_none_is_left() {
        let mut tried = Vec::new();
        let mut damping = Damping::FIRST;
        let found = damping.lower(3, 1.0, |damping| {
            tried.push(damping);
            Some(Lowered { state: (), objective: f64::NAN, size: 0.0 })
        });
        assert!(found.is_none());
        assert_eq!(tried, [1e-3, 8e-3, 64e-3]);
        let found = damping.lower(1, 1.0, |_| None::<Lowered<()>>);
        assert!(found.is_none());
    }
}
