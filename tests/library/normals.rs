//! Normals of depth maps: analytic shapes, holes and jumps, noise, a scanned object.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::common::{data_dir, read_npy_f32, read_png};
use bimodal_stereo::normals::{self, Estimate};
use bimodal_stereo::{Camera, Lens, Normals, Pinhole, Points, Size};

fn size(width: usize, height: usize) -> Size {
    Size { width, height }
}

/// A camera whose distortion bends straight lines by some pixels.
fn pinhole(size: Size) -> Camera {
    Camera::Pinhole(Pinhole {
        fx: 1.4 * size.width as f64,
        fy: 1.5 * size.width as f64,
        cx: 0.48 * size.width as f64,
        cy: 0.53 * size.height as f64,
        lens: Lens::brown(&[-0.12, 0.05, 0.001, -0.002, 0.0]).unwrap(),
    })
}

/// Degrees between two unit vectors.
fn degrees(a: [f32; 3], b: [f64; 3]) -> f64 {
    let chord = a.iter().zip(b).map(|(a, b)| (f64::from(*a) - b).powi(2)).sum::<f64>().sqrt();
    2.0 * (chord / 2.0).min(1.0).asin().to_degrees()
}

/// Depth and outward unit normal of a sphere's facing half, for each pixel that sees it.
fn sphere(size: Size, camera: &Camera, centre: [f64; 3], radius: f64) -> (Vec<f32>, Vec<[f64; 3]>) {
    let mut depth = vec![f32::NAN; size.len()];
    let mut truth = vec![[f64::NAN; 3]; size.len()];
    for index in 0..size.len() {
        let (column, row) = size.position(index);
        let [x, y] = camera.ray(size, [column as f64, row as f64]);
        // The line origin + t direction, and the nearer root of |point - centre| = radius.
        let (origin, direction) =
            if camera.is_orthographic() { ([x, y, 0.0], [0.0, 0.0, 1.0]) } else { ([0.0; 3], [x, y, 1.0]) };
        let offset: [f64; 3] = std::array::from_fn(|axis| origin[axis] - centre[axis]);
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let (a, b, c) = (dot(direction, direction), dot(direction, offset), dot(offset, offset) - radius * radius);
        let discriminant = b * b - a * c;
        if discriminant > 0.0 {
            let t = (-b - discriminant.sqrt()) / a;
            depth[index] = (origin[2] + t * direction[2]) as f32;
            truth[index] = std::array::from_fn(|axis| (offset[axis] + t * direction[axis]) / radius);
        }
    }
    (depth, truth)
}

/// Largest and mean error in degrees over the selected pixels, each of which must have a normal.
fn errors(normals: &Normals, truth: &[[f64; 3]], select: impl Fn(usize) -> bool) -> (f64, f64) {
    let (mut largest, mut sum, mut count) = (0.0_f64, 0.0, 0);
    for index in (0..truth.len()).filter(|&index| select(index)) {
        assert!(normals.is_valid(index), "no normal at {index}");
        let error = degrees(normals.get(index), truth[index]);
        largest = largest.max(error);
        sum += error;
        count += 1;
    }
    assert!(count > 0, "nothing to compare");
    (largest, sum / f64::from(count))
}

#[test]
fn a_plane_is_exact_up_to_its_borders() {
    let size = size(40, 30);
    let [nx, ny, nz] = [0.3, -0.4, -(1.0_f64 - 0.25).sqrt()];
    for camera in [Camera::Orthographic, pinhole(size)] {
        let depth: Vec<f32> = (0..size.len())
            .map(|index| {
                let (column, row) = size.position(index);
                let [x, y] = camera.ray(size, [column as f64, row as f64]);
                // The points of the plane satisfy n . P = n . (0, 0, 50).
                let depth = if camera.is_orthographic() {
                    50.0 - (nx * x + ny * y) / nz
                } else {
                    50.0 * nz / (nx * x + ny * y + nz)
                };
                depth as f32
            })
            .collect();
        let mut points = Points::missing(size.len());
        normals::points_of_depth(size, &camera, &depth, &mut points);
        for estimate in [Estimate::Differences, Estimate::PlaneFit { radius: 2 }] {
            let mut found = Normals::missing(size.len());
            normals::from_points(size, &points, estimate, &mut found);
            let (largest, _) = errors(&found, &vec![[nx, ny, nz]; size.len()], |_| true);
            assert!(largest < 0.02, "{camera:?} {estimate:?}: {largest} deg");
        }
    }
}

#[test]
fn spheres_are_second_order() {
    // At twice the resolution, errors away from the occluding contour are four times smaller.
    let error = |side: usize, perspective: bool| {
        let size = size(side, side);
        let camera = if perspective { pinhole(size) } else { Camera::Orthographic };
        let (centre, radius) =
            if perspective { ([0.02, -0.03, 5.0], 1.3) } else { ([1.0, -2.0, 90.0], 0.4 * side as f64) };
        let (depth, truth) = sphere(size, &camera, centre, radius);
        let found = normals::of_depth(size, camera, &depth);
        // Cosine between a normal and its line of sight.
        let sight = |index: usize, [x, y, z]: [f64; 3]| {
            let (column, row) = size.position(index);
            let [rx, ry] = camera.ray(size, [column as f64, row as f64]);
            if perspective { (x * rx + y * ry + z) / (rx * rx + ry * ry + 1.0).sqrt() } else { z }
        };
        for index in (0..size.len()).filter(|&index| found.is_valid(index)) {
            assert!(sight(index, found.get(index).map(f64::from)) < 0.0, "faces the camera");
        }
        errors(&found, &truth, |index| sight(index, truth[index]) < -0.5)
    };
    for perspective in [false, true] {
        let ((coarse, _), (fine, mean)) = (error(64, perspective), error(128, perspective));
        println!("perspective {perspective}: largest {coarse:.4} at 64, {fine:.4} at 128 (mean {mean:.4}) degrees");
        assert!(fine < 0.1, "{fine}");
        assert!(coarse / fine > 3.0, "{coarse} / {fine}");
    }
}

#[test]
fn nothing_is_taken_across_a_jump_or_a_hole() {
    let size = size(40, 40);
    // Two slanted planes, one ten pixels behind the other, and a hole.
    let mut depth: Vec<f32> = (0..size.len())
        .map(|index| {
            let (column, row) = size.position(index);
            0.5 * column as f32 - 0.25 * row as f32 + if column + row / 3 < 22 { 0.0 } else { 10.0 }
        })
        .collect();
    let hole = size.index(8, 20);
    depth[hole] = f32::NAN;
    let found = normals::of_depth(size, Camera::Orthographic, &depth);
    let length = (1.0_f64 + 0.25 + 0.0625).sqrt();
    let truth = vec![[0.5 / length, -0.25 / length, -1.0 / length]; size.len()];
    let known = (0..size.len()).filter(|&index| found.is_valid(index)).count();
    // Pixels that the jump isolates in their column or row have no normal.
    assert!(known >= size.len() - 3, "{known}");
    let (largest, _) = errors(&found, &truth, |index| found.is_valid(index));
    assert!(largest < 1e-3, "{largest} deg");
    assert!(!found.is_valid(hole));
}

#[test]
fn an_organised_cloud_may_turn_away() {
    let size = size(24, 24);
    let (depth, truth) = sphere(size, &Camera::Orthographic, [0.0, 0.0, 50.0], 9.0);
    let mut points = Points::missing(size.len());
    normals::points_of_depth(size, &Camera::Orthographic, &depth, &mut points);
    // A half turn about the y axis: (x, y, z) -> (-x, y, -z).
    for index in 0..size.len() {
        let [x, y, z] = points.get(index);
        points.set(index, [-x, y, -z]);
    }
    let turned: Vec<[f64; 3]> = truth.iter().map(|&[x, y, z]| [-x, y, -z]).collect();
    let found = normals::of_cloud(size, &points);
    let (largest, _) = errors(&found, &turned, |index| truth[index][2] < -0.6);
    assert!(largest < 2.0, "{largest} deg");
}

#[test]
fn the_plane_fit_calms_noise() {
    let size = size(128, 128);
    let (mut depth, truth) = sphere(size, &Camera::Orthographic, [0.0, 0.0, 90.0], 60.0);
    for (index, depth) in depth.iter_mut().enumerate() {
        // The noise of +-0.3 pixels is not random, but uncorrelated between neighbours.
        *depth += 0.3 * ((index as f64 * 12.9898).sin() * 43758.5453).fract() as f32;
    }
    let mut points = Points::missing(size.len());
    normals::points_of_depth(size, &Camera::Orthographic, &depth, &mut points);
    let mean = |estimate| {
        let mut found = Normals::missing(size.len());
        normals::from_points(size, &points, estimate, &mut found);
        errors(&found, &truth, |index| truth[index][2] < -0.6).1
    };
    let (raw, calm) = (mean(Estimate::Differences), mean(Estimate::PlaneFit { radius: 3 }));
    println!("mean error {raw:.2} degrees by differences, {calm:.2} by planes of radius 3");
    assert!(calm < raw / 4.0, "{raw} {calm}");
}

#[test]
fn short_or_empty_input_is_no_panic() {
    let size = size(6, 5);
    assert!((0..30).all(|index| !normals::of_depth(size, Camera::Orthographic, &[f32::NAN; 30]).is_valid(index)));
    assert_eq!(normals::of_depth(size, Camera::Orthographic, &[]).len(), 30);
    let wild: Vec<f32> = (0..30).map(|index| if index % 2 == 0 { f32::MAX } else { -f32::MAX }).collect();
    assert_eq!(normals::of_depth(size, Camera::Orthographic, &wild).len(), 30);
}

#[test]
#[ignore = "needs ../shared/data"]
fn a_scanned_bear_agrees_with_its_normal_map() {
    let folder = data_dir().join("diligent/bear");
    let (size, depth) = read_npy_f32(&folder.join("depth_mm.npy"));
    let text = std::fs::read_to_string(folder.join("K.txt")).expect("the file is there");
    let k: Vec<f64> = text.split_whitespace().map(|word| word.parse().expect("a number")).collect();
    let camera = Camera::Pinhole(Pinhole { fx: k[0], fy: k[4], cx: k[2], cy: k[5], lens: Lens::None });
    let (mask, map) = (read_png(&folder.join("mask.png")), read_png(&folder.join("normal_map.png")));
    assert_eq!((mask.size, map.size, map.bits), (size, size, 16));
    let inside = |index: usize| mask.values[index * mask.channels] > 0;
    let depth: Vec<f32> = (0..size.len()).map(|index| if inside(index) { depth[index] } else { f32::NAN }).collect();
    let truth = |index: usize| {
        let part = |axis: usize| 2.0 * f64::from(map.values[index * map.channels + axis]) / 65535.0 - 1.0;
        [part(0), -part(1), -part(2)]
    };
    let found = normals::of_depth(size, camera, &depth);
    let errors: Vec<f64> = (0..size.len())
        .filter(|&index| inside(index) && found.is_valid(index))
        .map(|index| degrees(found.get(index), truth(index)))
        .collect();
    let pixels = (0..size.len()).filter(|&index| inside(index)).count();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    println!("bear: mean {mean:.3} degrees over {} of {pixels} pixels", errors.len());
    assert!(errors.len() as f64 > 0.99 * pixels as f64);
    assert!(mean < 1.5, "{mean}");
}
