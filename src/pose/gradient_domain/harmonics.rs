//! Real spherical harmonics of orders one to three of a normal, and their derivatives.
//!
//! Differences of neighbours do not contain the constant harmonic. Order three describes what cast shadows and
//! interreflections add to the shading of a distant light.

/// Number of harmonics of orders one and two, and of all three orders.
pub(super) const LOW: usize = 8;
pub(super) const SHADES: usize = 15;

/// Orders one and two have the relative sizes of Ramamoorthi and Hanrahan's harmonics, which the crate's light uses.
const C1: f32 = 1.023_328;
const C2: f32 = 0.858_086;
const C3: f32 = 0.247_708;
const C4: f32 = 0.429_043;
/// Normalised harmonics of order three.
const D1: f32 = 0.590_044;
const D2: f32 = 2.890_611;
const D3: f32 = 0.457_046;
const D4: f32 = 0.373_176;
const D5: f32 = 1.445_306;

/// The harmonics of a normal.
pub(super) fn harmonics([x, y, z]: [f32; 3]) -> [f32; SHADES] {
    let (xx, yy, zz) = (x * x, y * y, z * z);
    [
        C1 * x,
        C1 * y,
        C1 * z,
        C2 * x * y,
        C2 * y * z,
        C2 * x * z,
        C3 * (3.0 * zz - 1.0),
        C4 * (xx - yy),
        D1 * y * (3.0 * xx - yy),
        D1 * x * (xx - 3.0 * yy),
        D2 * x * y * z,
        D3 * y * (5.0 * zz - 1.0),
        D3 * x * (5.0 * zz - 1.0),
        D4 * z * (5.0 * zz - 3.0),
        D5 * z * (xx - yy),
    ]
}

/// Derivatives of the harmonics by x, y and z.
fn gradients([x, y, z]: [f32; 3]) -> [[f32; 3]; SHADES] {
    let (xx, yy, zz) = (x * x, y * y, z * z);
    [
        [C1, 0.0, 0.0],
        [0.0, C1, 0.0],
        [0.0, 0.0, C1],
        [C2 * y, C2 * x, 0.0],
        [0.0, C2 * z, C2 * y],
        [C2 * z, 0.0, C2 * x],
        [0.0, 0.0, 6.0 * C3 * z],
        [2.0 * C4 * x, -2.0 * C4 * y, 0.0],
        [6.0 * D1 * x * y, 3.0 * D1 * (xx - yy), 0.0],
        [3.0 * D1 * (xx - yy), -6.0 * D1 * x * y, 0.0],
        [D2 * y * z, D2 * x * z, D2 * x * y],
        [0.0, D3 * (5.0 * zz - 1.0), 10.0 * D3 * y * z],
        [D3 * (5.0 * zz - 1.0), 0.0, 10.0 * D3 * x * z],
        [0.0, 0.0, D4 * (15.0 * zz - 3.0)],
        [2.0 * D5 * x * z, -2.0 * D5 * y * z, D5 * (xx - yy)],
    ]
}

/// Derivatives of the harmonics by a rotation of the normal towards each of two tangents.
pub(super) fn by_tangents(normal: [f32; 3]) -> [[f32; SHADES]; 2] {
    let [x, y, z] = normal;
    // The axis least parallel to the normal gives the first tangent.
    let first = if x.abs() < 0.6 { [0.0, z, -y] } else { [-z, 0.0, x] };
    let length = first.iter().map(|part| part * part).sum::<f32>().sqrt().max(f32::MIN_POSITIVE);
    let first = first.map(|part| part / length);
    let second = [y * first[2] - z * first[1], z * first[0] - x * first[2], x * first[1] - y * first[0]];
    let gradients = gradients(normal);
    [first, second].map(|tangent| gradients.map(|row| row.iter().zip(&tangent).map(|(g, t)| g * t).sum()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tangential_derivatives_are_difference_quotients() {
        for normal in [[0.36_f32, 0.48, -0.8], [-0.9, 0.1, -0.424_264], [0.0, 0.0, -1.0]] {
            let step = 1e-3_f32;
            let along = by_tangents(normal);
            let squares: f32 = (0..SHADES).map(|k| along[0][k].powi(2) + along[1][k].powi(2)).sum();
            // The sum over the tangents does not depend on their choice: sum of l (l + 1) (2 l + 1) times the squared
            // normalisation of each order.
            assert!(squares.is_finite() && squares > 0.0);
            let first = if normal[0].abs() < 0.6 { [0.0, normal[2], -normal[1]] } else { [-normal[2], 0.0, normal[0]] };
            let length = first.iter().map(|part| part * part).sum::<f32>().sqrt();
            let moved = |sign: f32| harmonics(std::array::from_fn(|k| normal[k] + sign * step * first[k] / length));
            let (above, below) = (moved(1.0), moved(-1.0));
            for k in 0..SHADES {
                let slope = (above[k] - below[k]) / (2.0 * step);
                assert!((slope - along[0][k]).abs() < 2e-3, "{k}: {slope} {}", along[0][k]);
            }
        }
    }
}
