//! A pose as nalgebra's transformations and as a 4x4 matrix.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::common::laws;
use bimodal_stereo::nalgebra::{Isometry3, Matrix4, Point3, Similarity3, Translation3, UnitQuaternion, Vector3};
use bimodal_stereo::{Angles, ErrorKind, Similarity};
use proptest::prelude::*;

fn pose(turn: [f64; 3], scale: f64, translation: [f64; 3]) -> Similarity {
    let rotation = UnitQuaternion::new(Vector3::from(turn)).to_rotation_matrix().into_inner();
    Similarity { scale, rotation, translation: translation.into() }
}

proptest! {
    #![proptest_config(laws(128))]

    #[test]
    fn all_carry_a_point_to_the_same_place_and_back_again(
        turn in prop::array::uniform3(-3.0..3.0), scale in 0.01..100.0_f64,
        translation in prop::array::uniform3(-1e3..1e3), point in prop::array::uniform3(-10.0..10.0),
    ) {
        let pose = pose(turn, scale, translation);
        let place = pose.apply(point.into());
        let point = Point3::from(point);
        let tolerance = 1e-12 * (1e3 + 20.0 * scale);
        let similarity = Similarity3::try_from(pose).unwrap();
        prop_assert!((similarity.transform_point(&point).coords - place).norm() < tolerance);
        prop_assert!((pose.matrix().transform_point(&point).coords - place).norm() < tolerance);
        prop_assert_eq!(Matrix4::from(pose), pose.matrix());
        for back in [Similarity::try_from(similarity).unwrap(), Similarity::try_from(pose.matrix()).unwrap()] {
            prop_assert!((back.scale / scale - 1.0).abs() < 1e-12);
            prop_assert!((back.rotation - pose.rotation).norm() < 1e-12);
            prop_assert_eq!(back.translation, pose.translation);
        }
        let rigid = Similarity { scale: 1.0, ..pose };
        let motion = Isometry3::try_from(rigid).unwrap();
        prop_assert!((motion.transform_point(&point).coords - rigid.apply(point.coords)).norm() < tolerance);
        prop_assert!((Similarity::from(motion).matrix() - rigid.matrix()).norm() < 1e-12);
    }
}

#[test]
fn the_matrix_is_written_row_by_row_as_in_the_books() {
    let rotation = Angles { gamma: 90.0, ..Angles::default() }.rotation();
    let pose = Similarity { scale: 2.0, rotation, translation: Vector3::new(3.0, 4.0, 5.0) };
    #[rustfmt::skip]
    let expected = Matrix4::new(
        0.0, -2.0, 0.0, 3.0,
        2.0,  0.0, 0.0, 4.0,
        0.0,  0.0, 2.0, 5.0,
        0.0,  0.0, 0.0, 1.0,
    );
    assert!((pose.matrix() - expected).norm() < 1e-15, "{}", pose.matrix());
}

#[test]
fn what_is_no_similarity_is_refused_by_name() {
    let good = pose([0.1, 0.2, 0.3], 1.5, [1.0, 2.0, 3.0]);
    let field_of = |change: fn(&mut Matrix4<f64>)| {
        let mut matrix = good.matrix();
        change(&mut matrix);
        let error = Similarity::try_from(matrix).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Range);
        error.field().to_owned()
    };
    assert_eq!(field_of(|matrix| matrix[(3, 0)] = 0.1), "matrix");
    assert_eq!(field_of(|matrix| matrix[(3, 3)] = 2.0), "matrix");
    assert_eq!(field_of(|matrix| matrix[(3, 1)] = f64::NAN), "matrix");
    // A reflection, zeros, and NaN.
    assert_eq!(field_of(|matrix| matrix.row_mut(0).neg_mut()), "matrix");
    assert_eq!(field_of(|matrix| matrix.fixed_view_mut::<3, 3>(0, 0).fill(0.0)), "matrix");
    assert_eq!(field_of(|matrix| matrix[(0, 0)] = f64::INFINITY), "matrix");
    assert_eq!(field_of(|matrix| matrix[(0, 0)] += 0.01), "matrix.rotation");
    assert_eq!(field_of(|matrix| matrix[(1, 3)] = f64::NAN), "matrix.translation");
}

#[test]
fn other_transformations_are_checked_too() {
    let good = pose([0.1, 0.2, 0.3], 1.5, [1.0, 2.0, 3.0]);
    assert_eq!(Isometry3::try_from(good).unwrap_err().field(), "pose.scale");
    // nalgebra itself panics for a scale of zero.
    for scale in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let bad = Similarity { scale, ..good };
        assert_eq!(Similarity3::try_from(bad).unwrap_err().field(), "pose.scale");
        assert_eq!(Isometry3::try_from(bad).unwrap_err().field(), "pose.scale");
    }
    let bent = Similarity { rotation: 1.1 * good.rotation, ..good };
    assert_eq!(Similarity3::try_from(bent).unwrap_err().field(), "pose.rotation");
    let turned = Similarity3::from_parts(Translation3::identity(), UnitQuaternion::identity(), -2.0);
    assert_eq!(Similarity::try_from(turned).unwrap_err().field(), "similarity.scale");
}
