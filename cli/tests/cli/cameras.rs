//! Intrinsics from files: named ones, those next to the images, and the effect on millimetres without any.

use std::fs;

use crate::made::{Made, SIDE, bust, run, run_pair, write_png};

/// A camera of the generated pair.
const CAMERA: &str = r#"{"camera": {"fx": 300, "fy": 300, "cx": 23.5, "cy": 23.5, "width": 48, "height": 48}}"#;
const ONCE: [&str; 3] = ["--json", "--max-iterations", "1"];

fn with(made: &Made, name: &str, text: &str) -> String {
    fs::write(made.path(name), text).unwrap();
    made.path(name)
}

/// The units of a run's pose and depth map.
fn units(made: &Made, more: &[&str]) -> [String; 2] {
    let found = run_pair(made, &[&ONCE, more].concat());
    assert!(found.code < 3, "{}", found.err);
    ["unit", "depthUnit"].map(|name| found.json()[name].as_str().unwrap().to_owned())
}

#[test]
fn cameras_of_files_make_metres() {
    let made = bust();
    assert_eq!(units(&made, &[]), ["px", "px"]);
    let named = with(&made, "elsewhere.json", CAMERA);
    assert_eq!(units(&made, &["--cameras", &named]), ["m", "m"]);
    // A file next to the images is used if its name indicates cameras.
    with(&made, "calib.json", CAMERA);
    assert_eq!(units(&made, &[]), ["m", "m"]);
    let report = run_pair(&made, &ONCE).json();
    assert!(report["notes"].to_string().contains("intrinsics of the depth map"), "{report}");
    assert_eq!(report["warnings"][0]["code"], "camera-shared");
}

/// The whole frame of this pair is within five degrees of the axis, where a fisheye lens without coefficients deviates by a twentieth
/// of a pixel.
#[test]
fn lenses_of_files_bend_the_rays() {
    let made = bust();
    let pose = |name: &str, lens: &str| {
        let text = format!(r#"{{"fx": 300, "fy": 300, "cx": 23.5, "cy": 23.5, {lens}}}"#);
        let found = run_pair(&made, &[&ONCE[..], &["--cameras", &with(&made, name, &text)]].concat());
        assert!(found.code < 3, "{}", found.err);
        found.json()["pose"].clone()
    };
    let straight = pose("straight.json", r#""distortion": [0, 0, 0, 0, 0]"#);
    let rational = pose("rational.json", r#""distortion": [0, 0, 0, 0, 0, 1, 0, 0]"#);
    let fisheye = pose("fisheye.json", r#""distortion_model": "fisheye", "distortion": [0.1, 0, 0, 0]"#);
    assert!(straight != rational && rational != fisheye && fisheye != straight);
    let by_hand = "300,300,23.5,23.5,0,0,0,0,0,1,0,0";
    let found = run_pair(&made, &[&ONCE[..], &["--image-camera", by_hand, "--depth-camera", by_hand]].concat());
    assert_eq!(found.json()["pose"], rational);
}

#[test]
fn cameras_that_do_not_fit_are_refused() {
    let made = bust();
    let refused = |text: &str, words: &str| {
        let found = run_pair(&made, &["--cameras", &with(&made, "elsewhere.json", text)]);
        assert!(found.code == 3 && found.err.contains(words), "{words}: {}", found.err);
    };
    refused(&CAMERA.replace("48", "640"), "640x640");
    refused(
        r#"{"fx": 300, "fy": 300, "cx": 23.5, "cy": 23.5, "distortion_model": "omni", "distortion": [0.1, 0, 0, 0]}"#,
        "omni",
    );
    refused("1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", "contains no camera");
    refused("no camera at all", "elsewhere.json");
}

#[test]
fn millimetres_without_intrinsics_are_not_taken_for_pixels() {
    let made = bust();
    let levels: Vec<u8> = (0..SIDE * SIDE).flat_map(|at| (800 + at as u16 % 97).to_be_bytes()).collect();
    let depth = made.path("depth.png");
    write_png(depth.as_ref(), SIDE, png::ColorType::Grayscale, png::BitDepth::Sixteen, &levels);
    let image = made.path("image.png");
    let pair = |more: &[&str]| run(&[&[image.as_str(), depth.as_str()], &ONCE[..], more].concat());
    let found = pair(&[]);
    assert_eq!(
        (found.code, &found.json()["error"]["code"], &found.json()["error"]["field"]),
        (3, &"missing".into(), &"depth.camera".into())
    );
    assert!(pair(&["--depth-unit", "1"]).code < 3);
    let named = with(&made, "elsewhere.json", CAMERA);
    let report = pair(&["--cameras", &named]).json();
    assert!(report["notes"].to_string().contains("millimetres (guessed)"), "{report}");
}

#[test]
fn the_camera_of_a_crop_is_that_of_its_frame() {
    let made = bust();
    fs::copy(made.path("image.png"), made.path("mug_crop.png")).unwrap();
    fs::copy(made.path("depth.npy"), made.path("mug_depthcrop.npy")).unwrap();
    with(&made, "mug_loc.txt", "101,201");
    let named = with(
        &made,
        "elsewhere.json",
        r#"{"kinect": {"fx": 525, "fy": 525, "cx": 319.5, "cy": 239.5, "width": 640, "height": 480}}"#,
    );
    let [image, depth, light] = ["mug_crop.png", "mug_depthcrop.npy", "light.csv"].map(|name| made.path(name));
    let pair = |cameras: &[&str]| {
        let found = run(&[
            &[image.as_str(), depth.as_str(), "--light", &light, "--start", "identity", "--depth-unit", "0.01"],
            &ONCE[..],
            cameras,
        ]
        .concat());
        assert!(found.code < 3, "{}", found.err);
        found.json()
    };
    let found = pair(&["--cameras", &named]);
    assert!(found["notes"].to_string().contains("moved to its crop"), "{found}");
    // The first pixel of the crop is the frame's column 101, counted from one.
    let by_hand = "525,525,219.5,39.5";
    let expected = pair(&["--image-camera", by_hand, "--depth-camera", by_hand]);
    assert_eq!(found["pose"], expected["pose"]);
}

#[test]
fn both_commands_have_a_name() {
    let made = bust();
    let [image, depth, light] = ["image.png", "depth.npy", "light.csv"].map(|name| made.path(name));
    let words = [image.as_str(), &depth, "--light", &light, "--start", "identity", "--max-iterations", "1"];
    assert_eq!(run(&[&["estimate"], &words[..]].concat()).out, run(&words).out);
    let help = run(&["check", "--help"]);
    assert_eq!((help.code, help.out.as_str()), (0, bimodal_stereo_files::command::HELP));
    assert!(run(&["--help"]).out.contains("bimodal-stereo check --help"));
}
