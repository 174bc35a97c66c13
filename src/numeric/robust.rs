//! The robust function of Geman and McClure, rho(r) = r^2 / (1 + r^2 / s^2), and the robust standard deviation.
//!
//! Nearly everything here is a function of u = (r / s)^2, the squared residual in units of the scale s. Callers form u,
//! because they hold their residuals squared, divided, or times 1 / s^2. A residual of one scale keeps a quarter of its
//! weight, and rho never exceeds s^2. S. Geman, D. McClure: "Bayesian image analysis: an application to single photon
//! emission tomography", 1985.

use super::Real;

/// Ratio of the standard deviation to the median absolute deviation: sigma = 1.4826 median |x| for a normal x.
pub(crate) const SIGMA_OF_MEDIAN: f64 = 1.4826;

/// The robust scale s in standard deviations of the residuals. Residuals of three sigmas, beyond which hardly any are
/// noise, keep a quarter of their weight.
pub(crate) const SCALE_IN_SIGMAS: f64 = 3.0;

/// Root mean square of |r| over three channels of unit normal noise.
pub(crate) const NORM_OF_CHANNELS: f64 = 1.732_050_807_568_877_2;

/// Median of |r| over three channels of unit normal noise: the square root of the median of chi squared with three
/// degrees of freedom.
pub(crate) const MEDIAN_OF_THREE: f64 = 1.538_172_253_6;

/// 1 / (1 + u). rho is r^2 times this, and the weight in least squares is its square.
#[inline(always)]
pub(crate) fn attenuation<T: Real>(u: T) -> T {
    let one = T::constant(1.0);
    one / (one + u)
}

/// rho'(r) / (2 r) = 1 / (1 + u)^2: the weight of a squared residual in iteratively reweighted least squares.
#[inline(always)]
pub(crate) fn weight<T: Real>(u: T) -> T {
    let attenuation = attenuation(u);
    attenuation * attenuation
}

/// [`weight`] computed by a single division by the squared sum; its last bit may differ. One bit changes single
/// correspondences of a loop, so each caller keeps the form with which its published figures were measured.
#[inline(always)]
pub(crate) fn weight_of_square<T: Real>(u: T) -> T {
    let sum = T::constant(1.0) + u;
    T::constant(1.0) / (sum * sum)
}

/// rho = r^2 / (1 + u) of a squared residual r^2, which may be weighted.
#[inline(always)]
pub(crate) fn rho<T: Real>(squared: T, u: T) -> T {
    squared / (T::constant(1.0) + u)
}

/// rho / s^2 of a squared residual r^2 if `shown` is one, and its largest value, one, if `shown` is zero.
#[inline(always)]
pub(crate) fn saturated_if_shown<T: Real>(squared: T, squared_scale: T, shown: T) -> T {
    let one = T::constant(1.0);
    one - shown * (one - squared / (squared_scale + squared))
}

/// rho / s^2 = u / (1 + u), between zero and one.
#[inline(always)]
pub(crate) fn saturated<T: Real>(u: T) -> T {
    rho(u, u)
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn the_weight_is_the_derivative_of_rho() {
        for u in [0.0, 0.3, 1.0, 9.0, 1e6_f64] {
            let step = 1e-6 * (1.0 + u);
            let slope = (saturated(u + step) - saturated((u - step).max(0.0))) / (step + step.min(u));
            assert!((weight(u) - slope).abs() < 1e-5 * weight(u).max(1e-3), "{u}: {} {slope}", weight(u));
            assert!((saturated(u) - u * attenuation(u)).abs() < 1e-12);
            assert!((saturated_if_shown(4.0 * u, 4.0, 1.0) - saturated(u)).abs() < 1e-12);
            assert_eq!(saturated_if_shown(4.0 * u, 4.0, 0.0), 1.0);
        }
        assert_eq!(weight(1.0), 0.25);
        assert!((weight_of_square(0.7_f64) - weight(0.7)).abs() < 1e-15);
    }
}
