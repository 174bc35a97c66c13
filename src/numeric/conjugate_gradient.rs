//! Preconditioned conjugate gradients: minimises x^T A x / 2 - b^T x over x for a symmetric, positive semi-definite A,
//! without forming the matrix (docs/method/normals.md and docs/method/heights.md).
//!
//! The preconditioner M is close to A and easy to solve for. In exact arithmetic each iteration minimises over one more
//! dimension, and the error in the norm of A falls by (k - 1) / (k + 1) or better, where k is the square root of the
//! condition number of M^-1 A. Vectors are f32 and sums f64, so relative residuals below about 1e-6 are not reached. M.
//! Hestenes, E. Stiefel: "Methods of conjugate gradients for solving linear systems", 1952.
//!
//! Why no library: argmin's method takes no preconditioner. faer's takes one, but it sums in the precision of the
//! vectors and stops on the norm of the residual alone, not on the error in the norm of A or the decrease.

use super::vector::{add_scaled, dot};

/// The matrices A and M of a linear system.
pub(crate) trait System {
    /// Computes product = A direction.
    fn apply(&mut self, direction: &[f32], product: &mut [f32]);

    /// Computes solution = M^-1 residual.
    fn precondition(&mut self, residual: &[f32], solution: &mut [f32]);
}

/// The vectors of a solve, all of one length. The caller owns them, so a solve allocates nothing.
pub(crate) struct Vectors<'a> {
    /// x: the initial guess, then the solution.
    pub solution: &'a mut [f32],
    /// b - A x: of the initial guess at first, of the solution at the end.
    pub residual: &'a mut [f32],
    /// Scratch.
    pub direction: &'a mut [f32],
    /// Scratch: M^-1 residual and A direction in turn.
    pub product: &'a mut [f32],
}

/// When a solve ends. Its error is measured as r^T M^-1 r with the residual r, which is about the square of the error
/// in the norm of A.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// Maximum number of iterations.
    pub iterations: u32,
    /// Error at which the solve ends.
    pub error: f64,
    /// Error at which the solve ends, as a share of the initial error; the larger of the two limits applies.
    pub relative_error: f64,
    /// The solve ends after an iteration that decreases twice the objective (x^T A x - 2 b^T x) by less than this.
    pub decrease: f64,
}

/// Why a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// The error or the decrease is within its limit.
    Converged,
    /// The limit on iterations came first. The residual is that of the solution, the error that of the previous
    /// iterate.
    Capped,
    /// A is not positive along a direction, or a number overflowed.
    Breakdown,
}

/// Outcome of a solve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Solved {
    pub iterations: u32,
    /// r^T M^-1 r.
    pub error: f64,
    /// Total decrease of x^T A x - 2 b^T x.
    pub decrease: f64,
    pub end: End,
}

/// Solves A x = b from the initial guess in `vectors`. The system is a trait object, so that one copy of this code
/// serves all systems.
pub(crate) fn solve(system: &mut dyn System, limits: Limits, vectors: Vectors<'_>) -> Solved {
    let Vectors { solution, residual, direction, product } = vectors;
    system.precondition(residual, product);
    direction.copy_from_slice(product);
    let mut error = dot(residual, product);
    let small = limits.error.max(limits.relative_error * error);
    let (mut iterations, mut decrease) = (0, 0.0);
    let end = loop {
        if error <= small {
            break End::Converged;
        }
        if iterations == limits.iterations {
            break End::Capped;
        }
        system.apply(direction, product);
        let curvature = dot(direction, product);
        let length = (error / curvature) as f32;
        if !(length.is_finite() && curvature > 0.0) {
            break End::Breakdown;
        }
        add_scaled(solution, length, direction);
        add_scaled(residual, -length, product);
        iterations += 1;
        let gain = error * f64::from(length);
        decrease += gain;
        if gain < limits.decrease {
            break End::Converged;
        }
        // The error after the last iteration is not measured: it costs half an iteration, and not every caller needs
        // it.
        if iterations == limits.iterations {
            break End::Capped;
        }
        system.precondition(residual, product);
        let next = dot(residual, product);
        let ratio = (next / error) as f32;
        error = next;
        direction.iter_mut().zip(&*product).for_each(|(d, s)| *d = s + ratio * *d);
    };
    Solved { iterations, error, decrease, end }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// Tridiagonal, preconditioned by its diagonal.
    struct Chain {
        diagonal: [f32; 6],
    }

    impl System for Chain {
        fn apply(&mut self, direction: &[f32], product: &mut [f32]) {
            for i in 0..direction.len() {
                let next = |k: Option<usize>| k.and_then(|k| direction.get(k)).copied().unwrap_or(0.0);
                product[i] = self.diagonal[i] * direction[i] - next(i.checked_sub(1)) - next(Some(i + 1));
            }
        }

        fn precondition(&mut self, residual: &[f32], solution: &mut [f32]) {
            for ((s, r), d) in solution.iter_mut().zip(residual).zip(&self.diagonal) {
                *s = r / d.abs();
            }
        }
    }

    const TIGHT: Limits = Limits { iterations: 20, error: 1e-12, relative_error: 0.0, decrease: 0.0 };

    fn run(diagonal: [f32; 6], limits: Limits) -> (Solved, [f32; 6], f64) {
        let truth = [1.0, -2.0, 0.5, 3.0, 0.0, -1.0];
        let mut chain = Chain { diagonal };
        let (mut solution, mut residual) = ([0.0; 6], [0.0; 6]);
        chain.apply(&truth, &mut residual);
        let exact = dot(&residual, &truth);
        let (mut direction, mut product) = ([f32::NAN; 6], [f32::NAN; 6]);
        let vectors = Vectors {
            solution: &mut solution,
            residual: &mut residual,
            direction: &mut direction,
            product: &mut product,
        };
        (solve(&mut chain, limits, vectors), std::array::from_fn(|i| solution[i] - truth[i]), exact)
    }

    #[test]
    fn six_unknowns_take_six_iterations_and_the_decrease_is_that_of_the_objective() {
        let (solved, off, exact) = run([3.0, 4.0, 5.0, 2.5, 6.0, 3.0], TIGHT);
        assert!(solved.end == End::Converged && solved.iterations <= 7, "{solved:?}");
        assert!(off.iter().all(|off| off.abs() < 1e-5), "{off:?}");
        // From x = 0, x^T A x - 2 b^T x falls by b^T A^-1 b.
        assert!((solved.decrease - exact).abs() < 1e-4 * exact, "{solved:?} {exact}");
    }

    #[test]
    fn each_limit_ends_it() {
        let diagonal = [3.0, 4.0, 5.0, 2.5, 6.0, 3.0];
        let end = |limits| {
            let (solved, ..) = run(diagonal, limits);
            (solved.end, solved.iterations)
        };
        assert_eq!(end(Limits { iterations: 2, ..TIGHT }), (End::Capped, 2));
        assert_eq!(end(Limits { iterations: 0, ..TIGHT }), (End::Capped, 0));
        assert_eq!(end(Limits { relative_error: 1.0, ..TIGHT }), (End::Converged, 0));
        assert_eq!(end(Limits { decrease: 1e9, ..TIGHT }), (End::Converged, 1));
        assert_eq!(run([-3.0; 6], TIGHT).0.end, End::Breakdown);
    }
}
