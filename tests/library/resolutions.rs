//! A photograph much finer than the depth map is processed at the depth map's resolution, and all results are converted
//! back to the photograph's pixels and units.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use bimodal_stereo::scenes::{Sample, SampleRequest, Scene, light, surface};
use bimodal_stereo::{
    Camera, ColourImage, ColourSamples, Estimator, Lens, Options, Pinhole, Registration, Similarity, Size, Start,
    Status,
};

const SMALL: Size = Size { width: 64, height: 64 };
const TIMES: usize = 4;

fn sample(size: Size, camera: Camera) -> Sample {
    let request = SampleRequest {
        light: light("colourful").expect("a name"),
        size,
        noise: 0.01,
        image_camera: camera,
        depth_camera: camera,
        ..SampleRequest::default()
    };
    Scene::new(&surface("bust").expect("a name")).and_then(|scene| scene.sample(&request)).expect("a pair")
}

fn large() -> Sample {
    sample(Size { width: TIMES * SMALL.width, height: TIMES * SMALL.height }, Camera::Orthographic)
}

fn run(image: ColourImage, sample: &Sample, options: Options) -> Estimator {
    let mut estimator = Estimator::new(image, &sample.depth_map(), options).expect("good input");
    while estimator.report().status == Status::Running {
        estimator.step();
    }
    estimator
}

/// The pose of the small depth map in the pixels of an enlarged image.
fn enlarged(pose: &Similarity, times: f64) -> Similarity {
    Similarity { scale: times * pose.scale, rotation: pose.rotation, translation: times * pose.translation }
}

#[test]
fn an_image_of_four_times_the_size_gives_the_same_pose_in_its_own_pixels() {
    let small = sample(SMALL, Camera::Orthographic);
    let own = run(small.colour_image(), &small, Options::default());
    let fine = run(large().colour_image(), &small, Options::default());
    let [own, found] = [&own, &fine].map(|estimator| estimator.report());
    let truth = enlarged(&small.pose, TIMES as f64);
    // Means over 16 pixels have a quarter of the noise.
    assert!(
        found.pose.degrees_to(&truth) < own.pose.degrees_to(&small.pose) + 0.2,
        "{}",
        found.pose.degrees_to(&truth)
    );
    assert!((found.pose.scale / truth.scale - 1.0).abs() < 0.01, "{}", found.pose.scale);
    let off = found.pose.translation - truth.translation;
    assert!(off.xy().norm() < 0.3 * TIMES as f64, "{off}");
    let [sigma, own_sigma] = [found, own].map(|report| report.uncertainty.as_ref().and_then(|one| one.translation[0]));
    let ratio = sigma.expect("a sigma") / own_sigma.expect("a sigma");
    assert!(ratio > 0.1 * TIMES as f64 && ratio < 3.0 * TIMES as f64, "{ratio}");
}

#[test]
fn outputs_have_the_pixels_of_the_image_and_its_mask() {
    let (small, large) = (sample(SMALL, Camera::Orthographic), large());
    let start = enlarged(&small.pose, TIMES as f64);
    let options = Options {
        start: Start::Pose { rotation: start.rotation, scale: Some(start.scale), translation: Some(start.translation) },
        registration: Registration::Fixed,
        ..Options::default()
    };
    let image = large.colour_image();
    let mask = image.mask.clone().expect("a mask");
    let estimator = run(image, &small, options);
    let pose = &estimator.report().pose;
    assert!((pose.scale - start.scale).abs() < 1e-9 && (pose.translation - start.translation).xy().norm() < 1e-9);
    let (normals, depth) = (estimator.image_normals(), estimator.image_depth());
    let (residual, correspondence) = (estimator.residual(), estimator.correspondence());
    let (albedo, shading) = (estimator.albedo(), estimator.shading());
    let (mut angle, mut count) = (0.0, 0.0);
    for (index, &inside) in mask.iter().enumerate() {
        let known = [depth[index], residual[index], albedo[3 * index], shading[3 * index], normals.x[index]];
        assert!(known.iter().all(|value| value.is_nan() == (inside == 0)), "{index}: {known:?}");
        assert!(inside != 0 || correspondence[index] == -1);
        if inside != 0 && large.truth.image_normals.is_valid(index) {
            let (found, truth) = (normals.get(index), large.truth.image_normals.get(index));
            let cosine: f32 = found.iter().zip(truth).map(|(a, b)| a * b).sum();
            angle += f64::from(cosine.clamp(-1.0, 1.0)).acos().to_degrees();
            count += 1.0;
        }
    }
    assert!(angle / count < 5.0, "{}", angle / count);
    let spread = |depth: &[f32]| {
        let known = || depth.iter().copied().filter(|value| !value.is_nan());
        known().fold(f32::MIN, f32::max) - known().fold(f32::MAX, f32::min)
    };
    let ratio = spread(&depth) / spread(&large.truth.image_depth);
    assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
}

/// The sample's image on a larger frame, starting at `origin`, with each pixel enlarged to a square.
fn on_frame(sample: &Sample, side: usize, frame: Size, origin: [usize; 2]) -> ColourImage {
    let image = sample.colour_image();
    let ColourSamples::RgbLinear(colours) = &image.samples else { panic!("renders are linear") };
    let mask = image.mask.as_deref().expect("a mask");
    let brightest = colours.iter().copied().filter(|value| value.is_finite()).fold(0.0, f32::max);
    let mut data = vec![0; 4 * frame.len()];
    let mut object = vec![0; frame.len()];
    for index in 0..frame.len() {
        let (column, row) = frame.position(index);
        let place =
            [(column, origin[0]), (row, origin[1])].map(|(at, origin)| at.checked_sub(origin).map(|at| at / side));
        let [Some(column), Some(row)] = place else { continue };
        if column >= image.width || row >= image.height || mask[row * image.width + column] == 0 {
            continue;
        }
        object[index] = 255;
        let pixel = row * image.width + column;
        for channel in 0..3 {
            data[4 * index + channel] = (60_000.0 * colours[3 * pixel + channel] / brightest) as u16;
        }
        data[4 * index + 3] = u16::MAX;
    }
    let Size { width, height } = frame;
    let transfer = Some(bimodal_stereo::Transfer::Linear);
    ColourImage { width, height, samples: ColourSamples::Rgba16(data), transfer, mask: Some(object), camera: None }
}

#[test]
fn a_photograph_of_twelve_megapixels_finds_its_small_depth_map() {
    // The object is off the middle of the frame.
    let small = sample(Size { width: 160, height: 120 }, Camera::Orthographic);
    let (frame, side, origin) = (Size { width: 4000, height: 3000 }, 15, [1203, 907]);
    let estimator = run(on_frame(&small, side, frame, origin), &small, Options::default());
    let found = &estimator.report().pose;
    let truth = enlarged(&small.pose, side as f64);
    assert!(found.degrees_to(&truth) < 1.0, "{}", found.degrees_to(&truth));
    assert!((found.scale / truth.scale - 1.0).abs() < 0.02, "{}", found.scale);
    let middle = |side: usize| 0.5 * (side as f64 - 1.0);
    let shift = |origin: usize, small: usize, frame: usize| {
        origin as f64 + side as f64 * (middle(small) + 0.5) - 0.5 - middle(frame)
    };
    let expected = [
        truth.translation.x + shift(origin[0], 160, frame.width),
        truth.translation.y + shift(origin[1], 120, frame.height),
    ];
    let off = (found.translation.x - expected[0]).hypot(found.translation.y - expected[1]);
    assert!(off < 0.5 * side as f64, "{off} pixels of {side}: {} {expected:?}", found.translation);
    assert_eq!(estimator.residual().len(), frame.len());
}

#[test]
fn behind_pinholes_poses_stay_metric() {
    let camera = |side: f64| {
        let (focal, centre) = (150.0 * side, 32.0 * side - 0.5);
        Camera::Pinhole(Pinhole { fx: focal, fy: focal, cx: centre, cy: centre, lens: Lens::None })
    };
    let small = sample(SMALL, camera(1.0));
    let ColourSamples::RgbLinear(colours) = small.colour_image().samples else { panic!("renders are linear") };
    let image = small.colour_image();
    let size = Size { width: TIMES * SMALL.width, height: TIMES * SMALL.height };
    let below = |index: usize| {
        let (column, row) = size.position(index);
        SMALL.index(column / TIMES, row / TIMES)
    };
    let data = (0..size.len())
        .flat_map(|index| (0..3).map(move |c| (index, c)))
        .map(|(index, c)| colours[3 * below(index) + c]);
    let mask = image.mask.as_deref().expect("a mask");
    let fine = ColourImage {
        width: size.width,
        height: size.height,
        samples: ColourSamples::RgbLinear(data.collect()),
        mask: Some((0..size.len()).map(|index| mask[below(index)]).collect()),
        camera: camera(TIMES as f64).pinhole(),
        transfer: None,
    };
    let options = || Options { start: Start::Identity, ..Options::default() };
    let [own, found] = [image, fine].map(|image| run(image, &small, options()).report().clone());
    let near = own.pose.degrees_to(&found.pose);
    // Both runs use the small image; one of them crops it to its mask.
    assert!(near < 0.1, "{near}");
    assert!((own.pose.translation - found.pose.translation).norm() < 0.01 * own.pose.translation.norm().max(1.0));
    assert_eq!(found.pose.scale, 1.0);
}
