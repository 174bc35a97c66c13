//! Integration of analytic surfaces: exact cases, masks, anchors, noise, perspective.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use bimodal_stereo::{
    AnchorWeight, Anchors, Camera, ErrorKind, IntegrationOptions, IntegrationReport, IntegrationTermination,
    Integrator, Lens, Normals, Pinhole, Robustness, Size, gradients,
};

fn size(width: usize, height: usize) -> Size {
    Size { width, height }
}

/// Height, p and q from a function of column and row that returns all three.
fn sample(size: Size, surface: impl Fn(f64, f64) -> [f64; 3]) -> [Vec<f32>; 3] {
    [0, 1, 2].map(|part| {
        let value = |(column, row): (usize, usize)| surface(column as f64, row as f64)[part] as f32;
        (0..size.len()).map(|index| value(size.position(index))).collect()
    })
}

fn integrate(
    size: Size,
    mask: &[bool],
    p: &[f32],
    q: &[f32],
    anchors: Option<Anchors<'_>>,
    options: &IntegrationOptions,
) -> (Vec<f32>, IntegrationReport) {
    let mut z = vec![0.0; size.len()];
    let report = Integrator::new(size, mask)
        .and_then(|mut integrator| integrator.integrate(p, q, anchors, options, &mut z))
        .expect("sizes agree");
    assert_eq!(report.termination, IntegrationTermination::Converged, "{report:?}");
    for (z, &inside) in z.iter().zip(mask) {
        assert_eq!(z.is_nan(), !inside);
    }
    (z, report)
}

/// Largest deviation of `a - b` from its mean, both over the selected pixels.
fn largest(a: &[f32], b: &[f32], select: impl Fn(usize) -> bool) -> f64 {
    let chosen: Vec<f64> = (0..a.len()).filter(|&i| select(i)).map(|i| f64::from(a[i]) - f64::from(b[i])).collect();
    let mean = chosen.iter().sum::<f64>() / chosen.len() as f64;
    chosen.iter().map(|value| (value - mean).abs()).fold(0.0, f64::max)
}

/// A smooth bump whose height is a third of its radius.
fn bump(radius: f64, column: f64, row: f64) -> [f64; 3] {
    let (x, y) = (column / radius, row / radius);
    let height = (-(x * x + y * y) / 2.0).exp() * radius / 3.0;
    [height, -height * x / radius, -height * y / radius]
}

#[test]
fn planes_and_quadratics_are_exact() {
    let size = size(64, 48);
    let [z, p, q] = sample(size, |x, y| {
        [0.3 * x - 0.2 * y + 0.01 * x * x - 0.005 * x * y, 0.3 + 0.02 * x - 0.005 * y, -0.2 - 0.005 * x]
    });
    let everywhere = vec![true; size.len()];
    let ragged: Vec<bool> = (0..size.len()).map(|index| (index * 7919) % 11 > 0).collect();
    for (mask, robustness) in [
        (&everywhere, Robustness::Off),
        (&everywhere, Robustness::Estimated),
        (&ragged, Robustness::Off),
        (&ragged, Robustness::Estimated),
    ] {
        let options = IntegrationOptions { robustness, tolerance: 1e-6, ..Default::default() };
        let (found, report) = integrate(size, mask, &p, &q, None, &options);
        let error = largest(&found, &z, |index| mask[index]);
        println!("{error:e} px, {report:?}");
        // The error is relative to heights of 53 px.
        assert!(error < 1e-3, "{error}");
        let mean: f64 = found.iter().filter(|z| !z.is_nan()).map(|&z| f64::from(z)).sum();
        assert_eq!(report.components, 1);
        assert!(mean.abs() < 0.1, "mean zero");
    }
}

#[test]
fn a_rectangle_is_solved_in_one_iteration_to_five_digits() {
    let size = size(256, 256);
    // The trapezoids of these gradients equal the surface's own differences: cos(k (x + 1/2)) has no discretisation error.
    let k = std::f64::consts::PI * 3.0 / 256.0;
    let [z, _, _] = sample(size, |x, y| [40.0 * (k * (x + 0.5)).cos() * (k * (y + 0.5)).cos(), 0.0, 0.0]);
    let scale = -40.0 * 2.0 * (k / 2.0).tan();
    let [_, p, q] = sample(size, |x, y| {
        let (cx, cy) = (k * (x + 0.5), k * (y + 0.5));
        [0.0, scale * cx.sin() * cy.cos(), scale * cx.cos() * cy.sin()]
    });
    let (found, report) = integrate(size, &vec![true; size.len()], &p, &q, None, &IntegrationOptions::default());
    let error = largest(&found, &z, |_| true) / 40.0;
    println!("relative error {error:e}, {report:?}");
    assert_eq!(report.iterations, 1);
    assert!(error < 1e-5, "{error:e}");
}

#[test]
fn smooth_bumps_are_second_order_on_every_mask() {
    let error = |side: usize, shape: &str| {
        let size = size(side, side);
        let (radius, centre) = (side as f64 / 5.0, (side as f64 - 1.0) / 2.0);
        let [z, p, q] = sample(size, |x, y| bump(radius, x - centre, y - centre));
        let mask: Vec<bool> = (0..size.len())
            .map(|index| {
                let (column, row) = size.position(index);
                let far = (column as f64 - centre).hypot(row as f64 - centre) / centre;
                match shape {
                    "disc" => far < 0.9,
                    "ring" => far < 0.9 && far > 0.4,
                    "two" => far < 0.9 && (column as f64 - centre).abs() > 0.1 * centre,
                    _ => true,
                }
            })
            .collect();
        let (found, report) = integrate(size, &mask, &p, &q, None, &IntegrationOptions::default());
        let left = |index: usize| (size.position(index).0 as f64) < centre;
        let relative = if shape == "two" {
            assert_eq!(report.components, 2);
            let halves = [true, false].map(|side| largest(&found, &z, |index| mask[index] && left(index) == side));
            halves[0].max(halves[1])
        } else {
            assert_eq!(report.components, 1);
            largest(&found, &z, |index| mask[index])
        } / (radius / 3.0);
        println!("{shape} {side}: {relative:.2e} of the height, {} iterations", report.iterations);
        relative
    };
    for shape in ["rectangle", "disc", "ring", "two"] {
        let (coarse, fine) = (error(48, shape), error(96, shape));
        assert!(coarse < 5e-3 && coarse / fine > 3.0, "{shape}: {coarse:e} {fine:e}");
    }
}

#[test]
fn robust_weights_leave_smooth_data_alone() {
    let size = size(80, 80);
    let [_, p, q] = sample(size, |x, y| bump(16.0, x - 39.0, y - 41.0));
    let mask = vec![true; size.len()];
    let (plain, _) = integrate(size, &mask, &p, &q, None, &IntegrationOptions::default());
    let options = IntegrationOptions { robustness: Robustness::Estimated, ..Default::default() };
    let (robust, report) = integrate(size, &mask, &p, &q, None, &options);
    let error = largest(&robust, &plain, |_| true);
    println!("{error:e} px, {report:?}");
    assert!(error < 1e-3, "{error:e}");
}

#[test]
fn noise_that_is_not_integrable_averages_out() {
    let size = size(128, 128);
    let [z, mut p, mut q] = sample(size, |x, y| bump(25.0, x - 60.0, y - 66.0));
    let noise = |index: usize, seed: f64| 0.1 * ((((index as f64 + seed) * 12.9898).sin() * 43758.5453).fract()) as f32;
    for index in 0..size.len() {
        p[index] += noise(index, 0.0);
        q[index] += noise(index, 1e5);
    }
    for robustness in [Robustness::Off, Robustness::Estimated] {
        let options = IntegrationOptions { robustness, ..Default::default() };
        let (found, report) = integrate(size, &vec![true; size.len()], &p, &q, None, &options);
        let error = largest(&found, &z, |_| true);
        println!("{error:.3} px at worst, {report:?}");
        assert!(error < 0.5, "{error}");
    }
}

#[test]
fn anchors_alone_are_reproduced() {
    let size = size(40, 30);
    let [z, _, _] = sample(size, |x, y| [1500.0 + 3.0 * (x / 5.0).sin() + y, 0.0, 0.0]);
    let unknown = vec![f32::NAN; size.len()];
    let anchors = Anchors { height: &z, weight: AnchorWeight::Uniform(0.02) };
    let mut found = vec![0.0; size.len()];
    let mask = vec![true; size.len()];
    let report = Integrator::new(size, &mask)
        .and_then(|mut i| i.integrate(&unknown, &unknown, Some(anchors), &IntegrationOptions::default(), &mut found))
        .expect("sizes agree");
    assert_eq!((report.termination, report.undetermined), (IntegrationTermination::Empty, 0));
    assert_eq!(found, z);
}

#[test]
fn anchors_set_the_level_and_gradients_fill_the_holes() {
    let size = size(64, 64);
    let [z, p, q] = sample(size, |x, y| {
        let [height, p, q] = bump(12.0, x - 30.0, y - 33.0);
        [1500.0 + height, p, q]
    });
    let hole = |index: usize| {
        let (column, row) = size.position(index);
        (column as f64 - 34.0).hypot(row as f64 - 30.0) < 9.0
    };
    let known: Vec<f32> = (0..size.len()).map(|index| if hole(index) { f32::NAN } else { z[index] }).collect();
    let anchors = Anchors { height: &known, weight: AnchorWeight::Uniform(0.02) };
    let options = IntegrationOptions::default();
    let (found, report) = integrate(size, &vec![true; size.len()], &p, &q, Some(anchors), &options);
    let worst = found.iter().zip(&z).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    println!("{worst:.4} px at worst, {report:?}");
    assert!(worst < 0.02, "{worst}");
}

#[test]
fn a_perspective_sphere_comes_back_up_to_scale() {
    let size = size(120, 100);
    let lens = Lens::brown(&[-0.1, 0.03, 0.001, -0.001, 0.0]).unwrap();
    let camera = Camera::Pinhole(Pinhole { fx: 150.0, fy: 160.0, cx: 57.0, cy: 52.0, lens });
    let (centre, radius) = ([0.05, -0.04, 3.0], 0.9);
    let mut surface = Normals::missing(size.len());
    let (mut depth, mut mask) = (vec![f32::NAN; size.len()], vec![false; size.len()]);
    for index in 0..size.len() {
        let (column, row) = size.position(index);
        let [x, y] = camera.ray(size, [column as f64, row as f64]);
        let (a, b) = (x * x + y * y + 1.0, -(x * centre[0] + y * centre[1] + centre[2]));
        let c = centre.iter().map(|part| part * part).sum::<f64>() - radius * radius;
        let discriminant = b * b - a * c;
        let z = (-b - discriminant.max(0.0).sqrt()) / a;
        let normal = [x * z - centre[0], y * z - centre[1], z - centre[2]].map(|part| part / radius);
        // The sphere is limited to 70 degrees between the normal and the line of sight.
        let facing = -(normal[0] * x + normal[1] * y + normal[2]) / a.sqrt();
        if discriminant > 0.0 && facing > 0.34 {
            mask[index] = true;
            depth[index] = z as f32;
            surface.set(index, normal.map(|part| part as f32));
        }
    }
    let (mut p, mut q) = (vec![0.0; size.len()], vec![0.0; size.len()]);
    gradients(size, &camera, &surface, &mask, &mut p, &mut q);
    let (log_depth, report) = integrate(size, &mask, &p, &q, None, &IntegrationOptions::default());
    let ratio: Vec<f64> = (0..size.len())
        .filter(|&index| mask[index])
        .map(|index| f64::from(log_depth[index]).exp() / f64::from(depth[index]))
        .collect();
    let mean = ratio.iter().sum::<f64>() / ratio.len() as f64;
    let worst = ratio.iter().map(|ratio| (ratio / mean - 1.0).abs()).fold(0.0, f64::max);
    println!("{worst:.2e} of the depth at worst, {report:?}");
    // The sphere's visible depth is 0.2 of its distance.
    assert!(worst < 1e-3, "{worst}");
}

#[test]
fn gradients_stay_finite_at_grazing_normals() {
    let size = size(4, 4);
    let pinhole = Pinhole { fx: 4.0, fy: 4.0, cx: 1.5, cy: 1.5, lens: Lens::None };
    let mut surface = Normals::missing(16);
    surface.set(0, [1.0, 0.0, 0.0]);
    surface.set(1, [0.0, 0.8, 0.6]);
    for camera in [Camera::Orthographic, Camera::Pinhole(pinhole)] {
        let (mut p, mut q) = (vec![0.0; 16], vec![0.0; 16]);
        gradients(size, &camera, &surface, &[true; 16], &mut p, &mut q);
        assert!(p[..2].iter().chain(&q[..2]).all(|value| value.abs() <= 20.0), "{p:?} {q:?}");
        assert!(p[2..].iter().chain(&q[2..]).all(|value| value.is_nan()));
    }
}

#[test]
fn bad_input_is_an_error_or_a_report() {
    let size = size(8, 6);
    let mask = vec![true; size.len()];
    let kind = |mask: &[bool]| Integrator::new(size, mask).map(|_| ()).map_err(|error| error.kind());
    assert_eq!(kind(&[true; 3]), Err(ErrorKind::Size));
    assert_eq!(kind(&[false; 48]), Err(ErrorKind::Empty));
    let mut one = vec![false; 48];
    one[20] = true;
    let (flat, mut z) = (vec![0.0; 48], vec![0.0; 48]);
    let options = IntegrationOptions::default();
    let report = Integrator::new(size, &one).expect("a pixel").integrate(&flat, &flat, None, &options, &mut z);
    assert_eq!(report.map(|report| (report.termination, report.undetermined)), Ok((IntegrationTermination::Empty, 1)));
    assert!(z[20].is_nan());
    let mut integrator = Integrator::new(size, &mask).expect("a mask");
    let short =
        integrator.integrate(&flat[1..], &flat, None, &options, &mut z).map_err(|error| error.field().to_string());
    assert_eq!(short.err().as_deref(), Some("p"));
    let bad = IntegrationOptions { tolerance: f64::NAN, ..options };
    assert!(integrator.integrate(&flat, &flat, None, &bad, &mut z).is_err());
    // Gradients of zero, infinity, the largest number and -1e6 give finite heights.
    for value in [0.0, f32::INFINITY, f32::MAX, -1e6] {
        for robustness in [Robustness::Off, Robustness::Estimated] {
            let p = vec![value; 48];
            let options = IntegrationOptions { robustness, ..options };
            let report = integrator.integrate(&p, &flat, None, &options, &mut z).expect("sizes agree");
            assert!(z.iter().all(|z| z.is_finite()), "{value} {report:?}");
        }
    }
}
