//! p = -n_x/n_z, q = -n_y/n_z; with a pinhole camera d(log Z)/du = -(n . r_u)/(n . r): gradients from normals
//! (Eq. 4, 10; docs/method/normals.md).
//!
//! Method: a point of the surface is P = Z r(u, v) with the ray r = (x, y, 1). n . P_u = 0 gives the second formula.
//! r_u and r_v are central differences of [`Camera::ray`] over one pixel, so that lens distortion is included.
//!
//! Limits: a surface seen edge-on has no finite gradient. The cosine between normal and line of sight is taken as at
//! least [`GRAZING`]; normals that face away from the camera count as grazing as well.

use crate::view::{Camera, Normals, Size};

/// Least cosine between the normal and the direction to the camera: 87 degrees, slopes up to 20 pixels of depth per
/// pixel. Steeper measurements are noise at silhouettes. Smooth objects at 64 to 640 pixels have no slopes beyond 20.
pub const GRAZING: f64 = 0.05;

/// Gradients of depth (orthographic: in pixels) or of log depth (pinhole) along columns, `p`, and along rows, `q`.
///
/// All slices are row-major over the raster; normals are in the optical frame, facing the camera (n_z < 0). NaN off the
/// mask and where there is no normal. A slice that is shorter than the raster is filled as far as it goes.
pub fn gradients(size: Size, camera: &Camera, normals: &Normals, mask: &[bool], p: &mut [f32], q: &mut [f32]) {
    let targets = p.iter_mut().zip(q.iter_mut()).zip(mask).take(normals.len().min(size.len()));
    let normals = normals.x.iter().zip(&normals.y).zip(&normals.z);
    let of_pixel = |[nx, ny, nz]: [f32; 3], index: usize| {
        if camera.is_orthographic() {
            let facing = (-nz).max(GRAZING as f32);
            return [nx / facing, ny / facing];
        }
        gradient(size, camera, [nx, ny, nz].map(f64::from), index).map(|value| value as f32)
    };
    for (index, (((p, q), &inside), ((&nx, &ny), &nz))) in targets.zip(normals).enumerate() {
        let known = inside && nx.is_finite() && ny.is_finite() && nz.is_finite();
        [*p, *q] = if known { of_pixel([nx, ny, nz], index) } else { [f32::NAN; 2] };
    }
}

/// Slopes of normals, in pixels of height per pixel: [`gradients`] of the coordinate in which surfaces are solved.
/// Behind a pinhole that is f log Z, so its gradients are those of log Z times f.
pub fn find_slopes(size: Size, camera: &Camera, normals: &Normals, mask: &[bool], slopes: &mut [Vec<f32>; 2]) {
    let [p, q] = slopes;
    gradients(size, camera, normals, mask, p, q);
    let focal_length = camera.focal_length().unwrap_or(1.0) as f32;
    for slopes in [p, q] {
        slopes.iter_mut().for_each(|slope| *slope *= focal_length);
    }
}

/// Gradients of log depth behind a pinhole.
fn gradient(size: Size, camera: &Camera, [nx, ny, nz]: [f64; 3], index: usize) -> [f64; 2] {
    let (column, row) = size.position(index);
    let ray = |right: f64, down: f64| camera.ray(size, [column as f64 + right, row as f64 + down]);
    let [x, y] = ray(0.0, 0.0);
    let length = (x * x + y * y + 1.0).sqrt();
    let facing = -(nx * x + ny * y + nz);
    let along =
        |[x1, y1]: [f64; 2], [x0, y0]: [f64; 2]| (nx * (x1 - x0) + ny * (y1 - y0)) / facing.max(GRAZING * length);
    [along(ray(0.5, 0.0), ray(-0.5, 0.0)), along(ray(0.0, 0.5), ray(0.0, -0.5))]
}
