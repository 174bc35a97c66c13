//! Laws of the integration, for random gradients on random masks.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::common::laws;
use bimodal_stereo::{AnchorWeight, Anchors, IntegrationOptions, Integrator, Size};
use proptest::prelude::*;

const SIZE: Size = Size { width: 13, height: 10 };
const PIXELS: usize = 130;

fn field() -> impl Strategy<Value = Vec<f32>> {
    prop::collection::vec(-2.0_f32..2.0, PIXELS)
}

fn mask() -> impl Strategy<Value = Vec<bool>> {
    prop::collection::vec(prop::bool::weighted(0.8), PIXELS).prop_filter("a pixel", |mask| mask.contains(&true))
}

fn integrate(mask: &[bool], p: &[f32], q: &[f32], anchor: Option<&[f32]>) -> Vec<f32> {
    let options = IntegrationOptions { tolerance: 1e-6, ..Default::default() };
    let anchors = anchor.map(|height| Anchors { height, weight: AnchorWeight::Uniform(0.3) });
    let mut z = vec![0.0; PIXELS];
    let mut integrator = Integrator::new(SIZE, mask).expect("a pixel");
    integrator.integrate(p, q, anchors, &options, &mut z).expect("sizes agree");
    z
}

fn close(a: &[f32], b: &[f32], tolerance: f32) -> Result<(), TestCaseError> {
    for (a, b) in a.iter().zip(b) {
        prop_assert!(a.is_nan() == b.is_nan() && (a.is_nan() || (a - b).abs() <= tolerance), "{a} {b}");
    }
    Ok(())
}

fn map(field: &[f32], value: impl Fn(f32) -> f32) -> Vec<f32> {
    field.iter().map(|&old| value(old)).collect()
}

/// The raster mirrored left to right.
fn mirrored<T: Copy>(field: &[T]) -> Vec<T> {
    (0..PIXELS).map(|index| SIZE.position(index)).map(|(x, y)| field[SIZE.index(SIZE.width - 1 - x, y)]).collect()
}

proptest! {
    #![proptest_config(laws(64))]

    #[test]
    fn anchors_carry_a_constant(mask in mask(), p in field(), q in field(), anchor in field(), shift in -50.0_f32..50.0) {
        let z = integrate(&mask, &p, &q, Some(&anchor));
        let moved = integrate(&mask, &p, &q, Some(&map(&anchor, |height| height + shift)));
        close(&map(&z, |height| height + shift), &moved, 1e-3)?;
    }

    #[test]
    fn the_surface_is_linear_in_its_data(mask in mask(), p in field(), q in field(), r in field(), s in field()) {
        let sum = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| 2.0 * a - b).collect::<Vec<f32>>();
        let (first, second) = (integrate(&mask, &p, &q, Some(&r)), integrate(&mask, &q, &r, Some(&s)));
        let both = integrate(&mask, &sum(&p, &q), &sum(&q, &r), Some(&sum(&r, &s)));
        close(&sum(&first, &second), &both, 1e-3)?;
    }

    #[test]
    fn a_mirrored_mask_mirrors_the_surface(mask in mask(), p in field(), q in field()) {
        let z = integrate(&mask, &p, &q, None);
        let other = integrate(&mirrored(&mask), &mirrored(&map(&p, |p| -p)), &mirrored(&q), None);
        close(&mirrored(&z), &other, 1e-3)?;
    }

    #[test]
    fn a_warm_start_changes_nothing(mask in mask(), p in field(), q in field(), r in field()) {
        let options = IntegrationOptions { tolerance: 1e-6, ..Default::default() };
        let (mut warm, mut cold) = (vec![0.0; PIXELS], vec![0.0; PIXELS]);
        let mut integrator = Integrator::new(SIZE, &mask).expect("a pixel");
        integrator.integrate(&r, &p, None, &options, &mut warm).expect("sizes agree");
        integrator.integrate(&p, &q, None, &options, &mut warm).expect("sizes agree");
        integrator.reset();
        integrator.integrate(&p, &q, None, &options, &mut cold).expect("sizes agree");
        close(&warm, &cold, 1e-3)?;
    }

    /// Trapezoids integrate the gradients of a quadratic surface exactly, whatever the mask removes.
    #[test]
    fn the_gradient_of_a_surface_gives_it_back(
        mask in mask(), a in -2.0_f32..2.0, b in -2.0_f32..2.0, curvature in prop::array::uniform3(-0.2_f32..0.2),
    ) {
        let [c, d, e] = curvature;
        let at = |value: &dyn Fn(f32, f32) -> f32| -> Vec<f32> {
            (0..PIXELS).map(|index| SIZE.position(index)).map(|(x, y)| value(x as f32 - 6.0, y as f32 - 5.0)).collect()
        };
        let surface = at(&|x, y| a * x + b * y + c * x * x + d * x * y + e * y * y);
        let (p, q) = (at(&|x, y| a + 2.0 * c * x + d * y), at(&|x, y| b + d * x + 2.0 * e * y));
        let z = integrate(&mask, &p, &q, None);
        // Each part of the surface has its own level, so only differences of neighbours are compared.
        for index in (0..PIXELS).filter(|&index| mask[index]) {
            for other in SIZE.neighbours(index).filter(|&other| mask[other]) {
                let (found, expected) = (z[other] - z[index], surface[other] - surface[index]);
                prop_assert!((found - expected).abs() < 2e-3, "{found} instead of {expected}");
            }
        }
    }
}
