//! The surface of given normals in one call, for lessons and for studying the integration.
//!
//! Limits: an orthographic view. Without anchors, each unconnected part of the surface has mean zero.

use crate::error::Result;
use crate::shape::{IntegrationOptions, Integrator, Robustness, find_slopes};
use crate::view::{Camera, Normals, Size};

/// Depth in pixels of the surface with these normals in the least-squares sense, NaN where missing; `robust` cuts
/// edges across a discontinuity, as the loop does.
///
/// # Errors
/// [`ErrorKind::Size`](crate::ErrorKind::Size) if there are not as many normals as pixels,
/// [`ErrorKind::Empty`](crate::ErrorKind::Empty) if no normal is valid.
pub fn surface_of_normals(size: Size, normals: &Normals, robust: bool) -> Result<Vec<f32>> {
    let mask: Vec<bool> = (0..normals.len()).map(|index| normals.is_valid(index)).collect();
    let mut slopes = [(); 2].map(|()| vec![f32::NAN; size.len()]);
    let mut depth = slopes[0].clone();
    let mut integrator = Integrator::new(size, &mask)?;
    find_slopes(size, &Camera::Orthographic, normals, &mask, &mut slopes);
    let robustness = if robust { Robustness::Estimated } else { Robustness::Off };
    integrator.integrate(
        &slopes[0],
        &slopes[1],
        None,
        &IntegrationOptions { robustness, ..Default::default() },
        &mut depth,
    )?;
    Ok(depth)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slope_comes_back() {
        let size = Size { width: 24, height: 16 };
        let mut normals = Normals::missing(size.len());
        let length = (1.0_f32 + 0.3 * 0.3).sqrt();
        for index in 0..size.len() {
            normals.set(index, [0.3 / length, 0.0, -1.0 / length]);
        }
        for robust in [false, true] {
            let depth = surface_of_normals(size, &normals, robust).unwrap();
            for index in 0..size.len() {
                let expected = 0.3 * (size.position(index).0 as f32 - 11.5);
                assert!((depth[index] - expected).abs() < 1e-3, "{robust}: {} {expected}", depth[index]);
            }
        }
        assert!(surface_of_normals(size, &Normals::missing(3), false).is_err());
        assert!(surface_of_normals(size, &Normals::missing(size.len()), false).is_err());
    }
}
