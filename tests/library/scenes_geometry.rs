//! Compares the renderer and the true pose with analytic surfaces.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use bimodal_stereo::scenes::{Relief, SampleRequest, Scene, View, surface};
use bimodal_stereo::{Angles, Camera, Lens, Pinhole, Similarity, Size};
use nalgebra::{Matrix3, Vector3};

const SIDE: usize = 256;
/// Radius of the sphere in samples, and radius of the cap that the relief shows.
const SPHERE: f64 = 150.0;
const CAP: f64 = 100.0;
/// Radius within which depths and normals are compared. Beyond it lies the border of the triangles, where smoothing has
/// flattened the last four samples.
const COMPARED: f64 = 92.0;
/// Height of the cap's border in samples, above the background's limit of 5.
const RIM: f64 = 6.0;
/// Largest error of depth, samples. Smoothing by sigma = 1 sample lowers the cap by half its Laplacian, 1/150 at the
/// pole and 1/60 at 92 samples, and the triangles cut off 1/600.
const DEPTH_TOLERANCE: f64 = 0.02;
/// Largest error of a normal, degrees; most of it is the change of slope by smoothing.
const NORMAL_TOLERANCE: f64 = 0.05;

/// Centre of the sphere in the frame of the mesh.
fn sphere_centre() -> Vector3<f64> {
    Vector3::new(0.0, 0.0, rise(CAP) - RIM)
}

fn rise(distance: f64) -> f64 {
    (SPHERE * SPHERE - distance * distance).sqrt()
}

fn relief(height: impl Fn(f64, f64) -> f64) -> Relief {
    let centre = (SIDE as f64 - 1.0) / 2.0;
    let at = |index: usize| height((index % SIDE) as f64 - centre, (index / SIDE) as f64 - centre) as f32;
    Relief::new(SIDE, SIDE, (0..SIDE * SIDE).map(at).collect()).expect("a relief")
}

fn cap() -> Scene {
    let height = |x: f64, y: f64| if x.hypot(y) < CAP { rise(x.hypot(y)) - rise(CAP) + RIM } else { 0.0 };
    Scene::new(&relief(height)).expect("a surface")
}

fn rotation(alpha: f64, beta: f64, gamma: f64) -> Matrix3<f64> {
    Angles { alpha, beta, gamma }.rotation()
}

fn square(side: usize) -> Size {
    Size { width: side, height: side }
}

fn lens(coefficients: &[f64]) -> Camera {
    behind(Lens::brown(coefficients).unwrap())
}

fn behind(lens: Lens) -> Camera {
    Camera::Pinhole(Pinhole { fx: 400.0, fy: 390.0, cx: 121.3, cy: 130.8, lens })
}

/// The placement of the mesh in a view, as documented at `Scene::view`.
fn placement(scene: &Scene, rotation: &Matrix3<f64>, scale: f64, view: &View) -> Similarity {
    let fit = view.size.width as f64 / SIDE as f64;
    let centroid = scene.mesh().centroid();
    let centre = match view.camera {
        Camera::Orthographic => Vector3::new(fit * centroid.x, fit * centroid.y, view.size.width as f64),
        Camera::Pinhole(lens) => scale * Vector3::new(fit * centroid.x, fit * centroid.y, lens.fx),
    };
    let translation = centre - scale * fit * (rotation * centroid);
    Similarity { scale: scale * fit, rotation: *rotation, translation }
}

/// Largest errors of depth and normal against the ray's intersection with the sphere: depth in samples across the surface, so
/// that it counts the same at grazing angles, normals in degrees.
fn errors_on_sphere(rotation: &Matrix3<f64>, size: Size, camera: Camera) -> (f64, f64) {
    let scene = cap();
    let view = scene.view(rotation, 1.0, size, camera);
    let placement = placement(&scene, rotation, 1.0, &view);
    let (centre, radius) = (placement.apply(sphere_centre()), placement.scale * SPHERE);
    let (mut compared, mut depth_error, mut normal_error) = (0, 0.0_f64, 0.0_f64);
    for index in (0..size.len()).filter(|&index| view.is_valid(index)) {
        let (column, row) = size.position(index);
        let [x, y] = camera.ray(size, [column as f64, row as f64]);
        let (origin, sight) = if camera.is_orthographic() {
            (Vector3::new(x, y, 0.0), Vector3::z())
        } else {
            (Vector3::zeros(), Vector3::new(x, y, 1.0))
        };
        let (a, b) = (sight.norm_squared(), sight.dot(&(origin - centre)));
        let c = (origin - centre).norm_squared() - radius * radius;
        let hit = origin + sight * ((-b - (b * b - a * c).sqrt()) / a);
        let local = placement.inverse().apply(hit);
        if local.x.hypot(local.y) > COMPARED {
            continue;
        }
        compared += 1;
        let normal = (hit - centre) / radius;
        let across = (view.point(index) - hit).dot(&normal).abs();
        depth_error = depth_error.max(across / placement.scale);
        normal_error = normal_error.max(view.normals[index].angle(&normal).to_degrees());
    }
    assert!(compared > size.len() / 5, "{compared} pixels compared");
    (depth_error, normal_error)
}

#[test]
fn a_sphere_cap_is_rendered_as_it_is() {
    let cases = [
        ("orthographic, as it is", rotation(0.0, 0.0, 0.0), 256, Camera::Orthographic),
        ("orthographic, half size", rotation(0.0, 0.0, 0.0), 128, Camera::Orthographic),
        ("orthographic, magnified", rotation(10.0, -20.0, 5.0), 512, Camera::Orthographic),
        ("orthographic, 30 degrees", rotation(0.0, 30.0, 0.0), 256, Camera::Orthographic),
        ("pinhole, as it is", rotation(0.0, 0.0, 0.0), 256, lens(&[])),
        ("pinhole, 30 degrees", rotation(0.0, 30.0, 0.0), 256, lens(&[])),
        ("pinhole with distortion", rotation(-15.0, 25.0, 40.0), 256, lens(&[0.1, -0.05, 0.002, -0.001, 0.01])),
        ("eight coefficients", rotation(-15.0, 25.0, 40.0), 256, lens(&[0.5, -0.9, 2e-4, -1e-4, 0.4, 0.45, -0.9, 0.4])),
        ("fisheye", rotation(-15.0, 25.0, 40.0), 256, behind(Lens::Fisheye([0.02, -0.03, 0.005, 0.0]))),
    ];
    for (name, rotation, side, camera) in cases {
        let (depth, normal) = errors_on_sphere(&rotation, square(side), camera);
        println!("{name}: depth {depth:.4} samples, normal {normal:.3} degrees");
        assert!(depth < DEPTH_TOLERANCE && normal < NORMAL_TOLERANCE, "{name}: {depth}, {normal}");
    }
}

/// Every point of the depth view, transformed by the true pose, lies on the sphere of the colour view.
#[test]
fn the_pose_carries_the_depth_view_onto_the_surface() {
    let scene = cap();
    let wide = Camera::Orthographic;
    for (angles, scale, image_camera, depth_camera) in [
        ([0.0, 20.0, 0.0], 1.0, wide, wide),
        ([25.0, -40.0, 60.0], 1.0, wide, wide),
        ([0.0, 30.0, 10.0], 1.3, wide, wide),
        ([0.0, 30.0, 10.0], 400.0, wide, lens(&[])),
        ([0.0, 30.0, 10.0], 1.0, lens(&[]), lens(&[0.1, 0.0, 0.0, 0.0, 0.0])),
    ] {
        let rotation = rotation(angles[0], angles[1], angles[2]);
        let size = square(SIDE);
        let request = SampleRequest { rotation, scale, size, image_camera, depth_camera, ..SampleRequest::default() };
        let sample = scene.sample(&request).expect("a sample");
        let view = scene.view(&Matrix3::identity(), 1.0, size, image_camera);
        let centre = placement(&scene, &Matrix3::identity(), 1.0, &view).apply(sphere_centre());
        let mut largest = 0.0_f64;
        for index in (0..size.len()).filter(|&index| sample.depth.mask[index]) {
            let (column, row) = size.position(index);
            let depth = f64::from(sample.truth.depth[index]);
            let point = sample.pose.apply(depth_camera.point(size, [column as f64, row as f64], depth).into());
            let local = point - centre;
            if local.x.hypot(local.y) < COMPARED {
                largest = largest.max((local.norm() - SPHERE).abs());
                let normal = Vector3::from(sample.truth.depth_normals.get(index).map(f64::from));
                assert!((rotation * normal).angle(&local).to_degrees() < NORMAL_TOLERANCE);
            }
        }
        println!("{angles:?}, scale {scale}: {largest:.4} samples off the sphere");
        assert!(largest < DEPTH_TOLERANCE, "{angles:?}: {largest}");
    }
}

/// The same test on the bust, which has hidden parts: points visible in the image lie on the image's own depth.
#[test]
fn visible_points_of_the_bust_land_on_the_image_view() {
    let scene = Scene::new(&surface("bust").expect("a name")).expect("a surface");
    for beta in [20.0, -40.0, 60.0] {
        let size = square(128);
        let request = SampleRequest { rotation: rotation(0.0, beta, 0.0), size, ..SampleRequest::default() };
        let sample = scene.sample(&request).expect("a sample");
        let mut differences = Vec::new();
        for index in (0..size.len()).filter(|&index| sample.depth.mask[index]) {
            let (column, row) = size.position(index);
            let pixel = [column as f64, row as f64];
            let depth = f64::from(sample.truth.depth[index]);
            let point = sample.pose.apply(Camera::Orthographic.point(size, pixel, depth).into());
            let Some(seen) = bilinear(&sample.truth.image_depth, size, point) else { continue };
            // A point more than a pixel behind the image's surface is hidden there.
            if point.z - seen < 1.0 {
                differences.push((point.z - seen).abs());
            }
        }
        differences.sort_by(f64::total_cmp);
        let [half, most] = [0.5, 0.95].map(|share| differences[(share * differences.len() as f64) as usize]);
        println!("beta {beta}: median {half:.4}, 95 % {most:.4} pixels, {} points", differences.len());
        // Bilinear interpolation of a surface that bends over 10 pixels errs by 1/80; at the nose it bends faster.
        assert!(half < 0.0125 && most < 0.25, "beta {beta}: {half}, {most}");
    }
}

/// The image's depth at a point's position; `None` if one of four pixels is missing.
fn bilinear(depth: &[f32], size: Size, point: Vector3<f64>) -> Option<f64> {
    let [x, y] = Camera::Orthographic.project(size, point.into())?;
    let (column, row) = (x.floor(), y.floor());
    let inside = |value: f64, side: usize| value >= 0.0 && value < side as f64 - 1.0;
    if !inside(column, size.width) || !inside(row, size.height) {
        return None;
    }
    let at = |i: usize, j: usize| f64::from(depth[size.index(column as usize + i, row as usize + j)]);
    let (u, v) = (x - column, y - row);
    let value = (1.0 - v) * ((1.0 - u) * at(0, 0) + u * at(1, 0)) + v * ((1.0 - u) * at(0, 1) + u * at(1, 1));
    (!value.is_nan()).then_some(value)
}

/// Two plateaus, the right one 80 samples nearer. Rotated one way, it hides a part of the left one; rotated the other way, a
/// gap opens that no triangle spans.
#[test]
fn a_step_hides_what_is_behind() {
    const LOW: f64 = 20.0;
    const HIGH: f64 = 100.0;
    let inside = |x: f64, y: f64| x.abs() < 60.0 && y.abs() < 60.0;
    let step = |x: f64, y: f64| match (inside(x, y), x < 0.0) {
        (true, true) => LOW,
        (true, false) => HIGH,
        _ => 0.0,
    };
    let scene = Scene::new(&relief(step)).expect("a surface");
    let seen = |beta: f64| {
        let turn = rotation(0.0, beta, 0.0);
        let view = scene.view(&turn, 1.0, square(SIDE), Camera::Orthographic);
        let place = placement(&scene, &turn, 1.0, &view);
        // The edges of both plateaus where the smoothing of the step ends, and the height that each pixel of the
        // middle row shows.
        let edges = [(-5.0, LOW), (5.0, HIGH)].map(|(x, height)| place.apply(Vector3::new(x, 0.0, -height)).x);
        let row = SIDE / 2;
        let levels: Vec<(f64, Option<f64>)> = (0..SIDE)
            .map(|column| {
                let index = view.size.index(column, row);
                let point = view.point(index);
                let level = view.is_valid(index).then(|| -place.inverse().apply(point).z);
                (Camera::Orthographic.ray(view.size, [column as f64, row as f64])[0], level)
            })
            .collect();
        (edges, levels)
    };

    let ([low, high], levels) = seen(30.0);
    assert!(low - high > 30.0, "the near plateau overlaps the far one by 80 sin 30, less 10 cos 30");
    let overlap: Vec<_> = levels.iter().filter(|(x, _)| (high..low).contains(x)).collect();
    assert!(overlap.len() >= 30);
    for (x, level) in overlap {
        let level = level.expect("covered twice");
        assert!((level - HIGH).abs() < 1e-9, "at {x} the view shows height {level}");
    }

    let ([low, high], levels) = seen(-30.0);
    // The smoothed tails of the step, up to a jump of 12 samples, reach into the gap from both sides.
    let gap: Vec<_> = levels.iter().filter(|(x, _)| (low + 12.0..high - 12.0).contains(x)).collect();
    assert!(gap.len() >= 24 && gap.iter().all(|(_, level)| level.is_none()), "no surface spans the step");
}

/// From behind nothing is visible, and no view contains a normal that faces away.
#[test]
fn what_faces_away_is_dropped() {
    let scene = Scene::new(&surface("ripples").expect("a name")).expect("a surface");
    for beta in [0.0, 45.0, 90.0, 120.0, 180.0] {
        let view = scene.view(&rotation(0.0, beta, 0.0), 1.0, square(128), Camera::Orthographic);
        let seen: Vec<usize> = (0..view.size.len()).filter(|&index| view.is_valid(index)).collect();
        assert!(seen.iter().all(|&index| view.normals[index].z < 0.0 && view.depth[index] > 0.0));
        assert_eq!(seen.is_empty(), beta >= 180.0, "beta {beta}: {} pixels", seen.len());
    }
}
