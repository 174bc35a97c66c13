//! Guarantees of samples: the image model, noise, overlap, holes, seeds, limits, and the bare grid of Table 2A.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use bimodal_stereo::scenes::{
    DepthData, Relief, Sample, SampleRequest, Scene, bare_grid, light, lights, surface, surfaces,
};
use bimodal_stereo::{Angles, Camera, ErrorKind, Light, Normals, Size};
use nalgebra::{Matrix3, Vector3};

/// Largest difference between the logarithm of an f32 and a shading whose normal was rounded to f32 (no unit).
const ROUNDING: f64 = 2e-6;

fn scene(name: &str) -> Scene {
    Scene::new(&surface(name).expect("a name")).expect("a surface")
}

fn square(side: usize) -> Size {
    Size { width: side, height: side }
}

fn map(sample: &Sample) -> &[f32] {
    match &sample.depth.data {
        DepthData::Map(depth) => depth,
        DepthData::Cloud { .. } => panic!("a depth map"),
    }
}

/// The numbers as bits, so that NaN can be compared.
fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|value| value.to_bits()).collect()
}

fn count(mask: &[bool]) -> usize {
    mask.iter().filter(|&&inside| inside).count()
}

fn columns(mask: &[bool], size: Size) -> Vec<usize> {
    (0..size.width).filter(|&column| (0..size.height).any(|row| mask[size.index(column, row)])).collect()
}

/// log S minus the shading of the true normal, over mask and channels.
fn residuals(sample: &Sample) -> Vec<f64> {
    let truth = &sample.truth.image_normals;
    let at = |index: usize| {
        let log = sample.light.shade(truth.get(index).map(f64::from));
        (0..3).map(move |channel| f64::from(sample.image.colours[3 * index + channel]).ln() - log[channel])
    };
    (0..truth.len()).filter(|&index| sample.image.mask[index]).flat_map(at).collect()
}

fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

#[test]
fn colours_follow_the_image_model() {
    for name in surfaces::NAMES {
        let scene = scene(name);
        for light_name in lights::NAMES {
            let request = SampleRequest { light: light(light_name).expect("a name"), ..SampleRequest::default() };
            let sample = scene.sample(&request).expect("a sample");
            let residuals = residuals(&sample);
            assert!(residuals.len() > 3000 && residuals.iter().all(|residual| residual.abs() < ROUNDING));
            let outside = sample.image.mask.iter().zip(sample.image.colours.chunks(3)).filter(|(inside, _)| !**inside);
            assert!(outside.into_iter().all(|(_, colour)| colour == [0.0; 3]));
        }
    }
}

#[test]
fn built_in_surfaces_are_deep_and_clear_of_the_border() {
    for name in surfaces::NAMES {
        let relief = surface(name).expect("a name");
        let size = relief.size();
        assert_eq!((size.width, size.height), (256, 256));
        let deepest = relief.heights().iter().copied().fold(0.0, f32::max);
        println!("{name}: {deepest} samples deep");
        assert!((45.0..100.0).contains(&deepest), "{name}: {deepest}");
        for index in 0..size.len() {
            let (column, row) = size.position(index);
            let border = column.min(row) < 4 || column.max(row) > 251;
            assert!(!border || f64::from(relief.heights()[index]) <= relief.floor(), "{name} at {column}, {row}");
        }
    }
    assert!(surface("teapot").is_err() && light("moon").is_err());
}

#[test]
fn noise_has_the_sigma_asked_for_and_leaves_the_rest_alone() {
    let scene = scene("bust");
    let plain = SampleRequest { size: square(128), ..SampleRequest::default() };
    let clean = scene.sample(&plain).expect("a sample");
    let noisy = scene.sample(&SampleRequest { noise: 0.02, ..plain.clone() }).expect("a sample");
    let residuals = residuals(&noisy);
    // The sigma of a sigma from n values is sigma / sqrt(2 n), 0.5 % for 20000; the limit is four of these.
    let sigma = root_mean_square(&residuals);
    assert!((sigma / 0.02 - 1.0).abs() < 0.02, "{sigma} from {} values", residuals.len());
    assert_eq!(bits(map(&noisy)), bits(map(&clean)));

    let rough = scene.sample(&SampleRequest { depth_noise: 0.5, ..plain }).expect("a sample");
    let differences: Vec<f64> = (0..rough.truth.depth.len())
        .filter(|&index| rough.depth.mask[index])
        .map(|index| f64::from(map(&rough)[index] - rough.truth.depth[index]))
        .collect();
    let sigma = root_mean_square(&differences);
    assert!((sigma / 0.5 - 1.0).abs() < 0.04, "{sigma} from {} values", differences.len());
    assert!(rough.image.colours == clean.image.colours, "depth noise stays out of the image");
}

#[test]
fn overlap_keeps_the_middle_columns() {
    let scene = scene("bust");
    let whole = scene.sample(&SampleRequest::default()).expect("a sample");
    let all = columns(&whole.depth.mask, whole.depth.size);
    for overlap in [0.125, 0.25, 0.375, 0.5, 0.75, 1.0] {
        let sample = scene.sample(&SampleRequest { overlap, ..SampleRequest::default() }).expect("a sample");
        let kept = columns(&sample.depth.mask, sample.depth.size);
        assert_eq!(kept.len(), (overlap * all.len() as f64).round() as usize);
        let (left, right) = (kept[0] - all[0], all[all.len() - 1] - kept[kept.len() - 1]);
        assert!(left.abs_diff(right) <= 1, "{left} columns cut left, {right} right");
        for (index, &inside) in sample.depth.mask.iter().enumerate() {
            assert_eq!(inside, whole.depth.mask[index] && kept.contains(&sample.depth.size.position(index).0));
            assert_eq!(inside, !map(&sample)[index].is_nan());
            assert_eq!(inside, sample.truth.depth_normals.is_valid(index));
        }
        assert!(sample.image.mask == whole.image.mask, "the image keeps its columns");
    }
}

#[test]
fn holes_take_their_share_and_leave_the_mask() {
    let scene = scene("vase");
    let whole = scene.sample(&SampleRequest::default()).expect("a sample");
    let valid = count(&whole.depth.mask);
    for holes in [0.0, 0.1, 0.5, 0.95] {
        let sample = scene.sample(&SampleRequest { holes, ..SampleRequest::default() }).expect("a sample");
        let lost = (0..map(&sample).len()).filter(|&i| sample.depth.mask[i] && map(&sample)[i].is_nan()).count();
        assert_eq!(lost, (holes * valid as f64).round() as usize);
        assert!(sample.depth.mask == whole.depth.mask, "the mask keeps the holes");
        assert!((0..map(&sample).len()).all(|i| map(&sample)[i].is_nan() || map(&sample)[i] == map(&whole)[i]));
    }
}

#[test]
fn a_seed_decides_everything_random() {
    let scene = scene("ripples");
    let request = |seed| SampleRequest { noise: 0.02, depth_noise: 0.3, holes: 0.1, seed, ..SampleRequest::default() };
    let made = |seed| {
        let sample = scene.sample(&request(seed)).expect("a sample");
        (bits(map(&sample)), sample.image.colours)
    };
    let ((depth, colours), (other_depth, other_colours)) = (made(7), made(8));
    assert!((&depth, &colours) == (&made(7).0, &made(7).1), "the same seed");
    assert!(depth != other_depth && colours != other_colours, "another seed");
}

#[test]
fn every_size_within_the_limits_works() {
    let scene = scene("bust");
    for (width, height) in [(16, 16), (32, 32), (640, 480), (100, 300), (1024, 1024)] {
        let size = Size { width, height };
        let sample = scene.sample(&SampleRequest { size, ..SampleRequest::default() }).expect("a sample");
        // The bust fills 0.39 of the largest square in the frame, minus the border that meshing removes.
        let share = count(&sample.image.mask) as f64 / (width.min(height) as f64).powi(2);
        assert!((0.3..0.42).contains(&share), "{width}x{height}: {share}");
        assert!(map(&sample).iter().all(|depth| depth.is_nan() || *depth > 0.0));
    }
}

#[test]
fn bad_requests_are_refused_by_name() {
    let scene = scene("bust");
    let plain = SampleRequest::default;
    let turned = |beta| Angles { beta, ..Angles::default() }.rotation();
    let cases = [
        ("size", ErrorKind::Size, SampleRequest { size: square(15), ..plain() }),
        ("size", ErrorKind::Size, SampleRequest { size: square(1025), ..plain() }),
        ("light", ErrorKind::Range, SampleRequest { light: Light([[f64::NAN; 9]; 3]), ..plain() }),
        ("pose.rotation", ErrorKind::Range, SampleRequest { rotation: Matrix3::zeros(), ..plain() }),
        ("angles", ErrorKind::Empty, SampleRequest { rotation: turned(180.0), ..plain() }),
        ("scale", ErrorKind::Range, SampleRequest { scale: 0.0, ..plain() }),
        ("overlap", ErrorKind::Range, SampleRequest { overlap: 0.0, ..plain() }),
        ("overlap", ErrorKind::Range, SampleRequest { overlap: 1.1, ..plain() }),
        ("noise", ErrorKind::Range, SampleRequest { noise: -1.0, ..plain() }),
        ("depthNoise", ErrorKind::Range, SampleRequest { depth_noise: f64::NAN, ..plain() }),
        ("holes", ErrorKind::Range, SampleRequest { holes: 1.0, ..plain() }),
    ];
    for (field, kind, request) in cases {
        let error = scene.sample(&request).expect_err(field);
        assert_eq!((error.field(), error.kind()), (field, kind));
    }
    let refused = |width, height, heights| Relief::new(width, height, heights).expect_err("refused").kind();
    assert_eq!(refused(63, 64, vec![9.0; 63 * 64]), ErrorKind::Size);
    assert_eq!(refused(64, 64, vec![9.0; 64]), ErrorKind::Size);
    assert_eq!(refused(64, 64, vec![f32::INFINITY; 64 * 64]), ErrorKind::Range);
    assert_eq!(refused(64, 64, vec![f32::NAN; 64 * 64]), ErrorKind::Empty);
    let mut lonely = vec![0.0; 64 * 64];
    lonely[64 * 32 + 32] = 20.0;
    let relief = Relief::new(64, 64, lonely).expect("one sample is an object");
    assert_eq!(Scene::new(&relief).expect_err("without a surface").kind(), ErrorKind::Empty);
}

/// The pair of Table 2A is exact: each point of the cloud, transformed by the pose, is the image's point at that pixel.
#[test]
fn the_bare_grid_is_exact() {
    let relief = surface("bust").expect("a name");
    for beta in [20.0, 90.0] {
        let rotation = Angles { beta, ..Angles::default() }.rotation();
        let whole = bare_grid(&relief, &lights::COLOURFUL, &rotation, 1.0).expect("a pair");
        let sample = bare_grid(&relief, &lights::COLOURFUL, &rotation, 0.5).expect("a pair");
        let size = sample.image.size;
        assert_eq!(size, square(32));
        let object = columns(&whole.image.mask, size).len();
        assert_eq!(columns(&sample.depth.mask, size).len(), (0.5 * object as f64).round() as usize);
        assert!(residuals(&sample).iter().all(|residual| residual.abs() < ROUNDING));
        let DepthData::Cloud { points, normals } = &sample.depth.data else { panic!("a cloud") };
        let vector = |field: &Normals, index| Vector3::from(field.get(index).map(f64::from));
        for index in (0..size.len()).filter(|&index| sample.depth.mask[index]) {
            let (column, row) = size.position(index);
            let pixel = [column as f64, row as f64];
            let depth = f64::from(sample.truth.image_depth[index]);
            let point: Vector3<f64> = Camera::Orthographic.point(size, pixel, depth).into();
            // Coordinates up to 64 are rounded by 4e-6 in f32, normals by 6e-8.
            assert!((sample.pose.apply(vector(points, index)) - point).norm() < 1e-5);
            let normal = vector(&sample.truth.image_normals, index);
            assert!((sample.pose.rotation * vector(normals, index) - normal).norm() < 1e-6);
            assert!(
                normal.z < 0.0
                    && (depth - 32.0 + f64::from(relief.heights()[8 * (256 * row + column)]) / 8.0).abs() < 1e-5
            );
        }
    }
}
