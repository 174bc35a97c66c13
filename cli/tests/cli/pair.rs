//! One pair: the pose, the messages, the files, the codes.

use std::fs;

use serde_json::Value;

use crate::made::{Made, SIDE, ball, bust, names, run, run_pair};

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect()
}

/// Angle between a rotation in JSON and the true one, degrees.
fn degrees_off(pose: &Value, made: &Made) -> f64 {
    let found = numbers(&pose["rotation"]);
    let truth = made.sample.pose.rotation;
    let trace: f64 = (0..9).map(|at| found[at] * truth[(at / 3, at % 3)]).sum();
    ((trace - 1.0) / 2.0).clamp(-1.0, 1.0).acos().to_degrees()
}

#[test]
fn a_pair_converges_on_the_true_pose_and_says_so() {
    let made = bust();
    let told = run_pair(&made, &["--json"]);
    assert_eq!(told.code, 0, "{}", told.err);
    let report = told.json();
    assert_eq!((report["status"].as_str(), report["unit"].as_str()), (Some("converged"), Some("px")));
    assert!(degrees_off(&report["pose"], &made) < 1.0, "{report}");
    assert_eq!(numbers(&report["light"]), made.sample.light.flat());
    assert_eq!(told.err, "", "no bar and no warning where nobody looks");

    let words = run_pair(&made, &[]);
    assert_eq!(words.code, 0);
    let beta = report["pose"]["angles"]["beta"].as_f64().unwrap();
    for part in ["converged after", &format!("beta   {beta:.4} degrees"), "pixels", "one sigma", "not seen", "held"] {
        assert!(words.out.contains(part), "{part}: {}", words.out);
    }
}

#[test]
fn results_are_files_that_others_read() {
    let made = bust();
    let out = made.folder.path().join("new/results");
    let told = run_pair(&made, &["--json", "--out", out.to_str().unwrap()]);
    let all = [
        "clouds.ply",
        "depth_to_colour.txt",
        "light.csv",
        "pose.json",
        "refined-depth.npy",
        "refined-depth.png",
        "report.json",
    ];
    assert_eq!(names(&out), all);
    assert_eq!(told.json()["written"].as_array().unwrap().len(), all.len());

    let pose: serde_json::Value = serde_json::from_slice(&fs::read(out.join("pose.json")).unwrap()).unwrap();
    for said in ["status", "uncertainty"] {
        assert_eq!(pose[said], told.json()[said], "{said}");
    }

    let bytes = fs::read(out.join("refined-depth.npy")).unwrap();
    let file = npyz::NpyFile::new(&bytes[..]).unwrap();
    assert_eq!(file.shape(), [SIDE as u64; 2]);
    let depth: Vec<f32> = file.into_vec().unwrap();
    let (step, stored) = stored_depth(&fs::read(out.join("refined-depth.png")).unwrap());
    assert!(depth.iter().any(|value| value.is_finite()));
    for (value, level) in depth.iter().zip(stored) {
        let there = value.is_finite();
        assert_eq!(level > 0, there);
        assert!(!there || (f64::from(level) * step - f64::from(*value)).abs() <= 0.5001 * step, "{level} {value}");
    }

    let ply = fs::read(out.join("clouds.ply")).unwrap();
    let head = String::from_utf8_lossy(&ply[..500]).into_owned();
    let (_, count) = head.split_once("element vertex ").unwrap();
    let count: usize = count.lines().next().unwrap().parse().unwrap();
    let body = head.find("end_header\n").unwrap() + "end_header\n".len();
    assert!(head.contains("pixels") && count > SIDE * SIDE / 4);
    assert_eq!(ply.len(), body + 16 * count, "three floats, three colours, a label");

    // A written light is read again as a known light.
    let light = out.join("light.csv");
    let [image, depth] = ["image.png", "depth.npy"].map(|name| made.path(name));
    let again =
        run(&[&image, &depth, "--json", "--start", "identity", "--scale", "1", "--light", light.to_str().unwrap()]);
    assert_eq!(again.json()["pose"], told.json()["pose"]);
}

/// The depth step in the file's comment, and the stored numbers.
fn stored_depth(bytes: &[u8]) -> (f64, Vec<u16>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut data = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut data).unwrap();
    let remarks = &reader.info().uncompressed_latin1_text;
    let unit = &remarks.iter().find(|remark| remark.keyword == "Unit").unwrap().text;
    let step = unit.strip_suffix(" px per stored number; 0 is no depth").unwrap().parse().unwrap();
    (step, data.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]])).collect())
}

#[test]
fn the_cap_on_iterations_is_undecided() {
    let told = run_pair(&bust(), &["--json", "--max-iterations", "1"]);
    assert_eq!((told.code, told.json()["status"].as_str()), (2, Some("max-iterations")));
}

#[test]
fn nothing_known_is_found_by_the_search() {
    let made = bust();
    let [image, depth] = ["image.png", "depth.npy"].map(|name| made.path(name));
    let told = run(&[&image, &depth, "--json"]);
    // At 48 pixels the result may be reported as uncertain, but the pose is right.
    assert!(told.code < 2, "{}", told.err);
    assert!(degrees_off(&told.json()["pose"], &made) < 3.0, "{}", told.out);
}

#[test]
fn a_ball_does_not_tell_its_pose() {
    let made = ball();
    let [image, depth, light] = ["image.png", "depth.npy", "light.csv"].map(|name| made.path(name));
    let told = run(&[&image, &depth, "--json", "--light", &light]);
    assert_eq!(told.code, 1, "{}{}", told.out, told.err);
    let report = told.json();
    assert!(["lost", "ambiguous"].contains(&report["status"].as_str().unwrap()) && report["message"].is_string());
}

#[test]
fn cameras_make_metres() {
    let made = bust();
    let camera = "300,300,23.5,23.5,0.01";
    let told = run_pair(&made, &["--json", "--depth-camera", camera, "--max-iterations", "1"]);
    let report = told.json();
    assert_eq!((report["unit"].as_str(), report["depthUnit"].as_str()), (Some("px"), Some("m")), "{}", told.err);
    // Depths of about a hundred pixels are closer to plausible millimetres than to metres.
    let notes = report["notes"].as_array().unwrap();
    assert!(notes.iter().any(|note| note.as_str().unwrap().contains("guessed")), "{notes:?}");
    let said = run_pair(&made, &["--json", "--depth-camera", camera, "--depth-unit", "0.01", "--max-iterations", "1"]);
    assert_eq!(said.json()["notes"].as_array().unwrap().len(), 0);
}

#[test]
fn help_and_version_are_no_faults_and_tell_the_codes() {
    let help = run(&["--help"]);
    assert_eq!((help.code, help.err.as_str()), (0, ""));
    for part in ["--image-camera", "--out", "0 converged", "1 lost or ambiguous", "2 undecided", "3 the input is bad"] {
        assert!(help.out.contains(part), "{part}");
    }
    let version = run(&["--version"]);
    assert_eq!((version.code, version.out.trim()), (0, concat!("bimodal-stereo ", env!("CARGO_PKG_VERSION"))));
    // A reader that closes the pipe early is not an error.
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let program = env!("CARGO_BIN_EXE_bimodal-stereo");
    let status = std::process::Command::new(program).arg("--help").stdout(writer).status().unwrap();
    assert_eq!(status.code(), Some(0));
}

#[test]
fn a_prior_over_lights_is_read_and_followed() {
    let made = bust();
    let [image, depth] = ["image.png", "depth.npy"].map(|name| made.path(name));
    let kept = concat!(env!("CARGO_MANIFEST_DIR"), "/../scripts/reference/light-prior.json");
    // A prior that allows only grey light from the front.
    let narrow = made.path("narrow.json");
    let covariance: Vec<Vec<f64>> =
        (0..27).map(|row| (0..27).map(|column| if row == column { 1e-10 } else { 0.0 }).collect()).collect();
    let channel = [-1.0, 0.0, -0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let mean = [channel; 3].concat();
    fs::write(&narrow, serde_json::json!({ "mean": mean, "covariance": covariance }).to_string()).unwrap();
    let light = |more: &[&str]| {
        let fixed =
            ["--start", "identity", "--scale", "1", "--registration", "fixed", "--max-iterations", "1", "--json"];
        let told = run(&[&[image.as_str(), &depth], more, &fixed].concat());
        assert!(told.code <= 2, "{}", told.err);
        numbers(&told.json()["light"])
    };
    let (own, given, held) = (light(&[]), light(&["--light-prior", kept]), light(&["--light-prior", &narrow]));
    let off = |light: &[f64]| own.iter().zip(light).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off(&given) < 1e-3, "the kept file holds the crate's own prior: {}", off(&given));
    assert!(off(&held) > 0.1 && (held[2] - held[11]).abs() < 1e-2 && held[3].abs() < 1e-2, "{held:?}");
}
