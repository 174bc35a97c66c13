//! Compares integration with scipy's sparse least squares (scripts/reference/integration.py).

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use bimodal_stereo::{AnchorWeight, Anchors, IntegrationOptions, IntegrationTermination, Integrator, Size};

const FIXTURE: &str = include_str!("../fixtures/integration.txt");
/// Largest accepted difference, for heights of some ten pixels.
const TOLERANCE: f32 = 1e-4;

#[test]
fn agrees_with_sparse_least_squares() {
    let mut lines = FIXTURE
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| line.split(' ').map(|word| word.parse::<f32>().expect("a number")).collect::<Vec<f32>>());
    let sides = lines.next().expect("the size");
    let size = Size { width: sides[0] as usize, height: sides[1] as usize };
    let rows: Vec<Vec<f32>> = lines.collect();
    let column = |k: usize| rows.iter().map(|row| row[k]).collect::<Vec<f32>>();
    let mask: Vec<bool> = column(0).iter().map(|&value| value > 0.0).collect();
    let (p, q, height, weight) = (column(1), column(2), column(3), column(4));
    let anchors = Anchors { height: &height, weight: AnchorWeight::PerPixel(&weight) };
    let options = IntegrationOptions { tolerance: 1e-6, ..Default::default() };
    let mut integrator = Integrator::new(size, &mask).expect("a mask");
    for (anchors, truth) in [(None, column(5)), (Some(anchors), column(6)), (None, column(5))] {
        let mut z = vec![0.0; size.len()];
        let report = integrator.integrate(&p, &q, anchors, &options, &mut z).expect("sizes agree");
        assert_eq!(report.termination, IntegrationTermination::Converged, "{report:?}");
        for index in 0..size.len() {
            assert_eq!(z[index].is_nan(), truth[index].is_nan(), "pixel {index}");
            assert!(z[index].is_nan() || (z[index] - truth[index]).abs() < TOLERANCE, "{} {}", z[index], truth[index]);
        }
        let unknown = (0..size.len()).filter(|&index| mask[index] && truth[index].is_nan()).count();
        assert_eq!(report.undetermined, unknown);
        println!("{report:?}");
    }
}
