//! Prints the cameras and poses of files as JSON, one line each: `cargo run -p bimodal-stereo-files --example calibration -- FILE..`

use bimodal_stereo::Lens;
use bimodal_stereo_files::{Calibration, read_calibration, says};
use serde_json::{Value, json};

fn plain(found: &Calibration) -> Value {
    let cameras: Vec<Value> = found
        .cameras
        .iter()
        .map(|one| {
            let camera = &one.camera;
            let lens = match camera.lens {
                Lens::None => json!(null),
                Lens::Brown(numbers) => json!({ "model": "brown", "distortion": numbers }),
                Lens::Fisheye(numbers) => json!({ "model": "fisheye", "distortion": numbers }),
            };
            let numbers = [camera.fx, camera.fy, camera.cx, camera.cy];
            json!({ "name": one.name, "size": one.size, "numbers": numbers, "lens": lens })
        })
        .collect();
    let poses: Vec<Value> = found
        .poses
        .iter()
        .map(|one| {
            let (rotation, translation) = (one.pose.rotation.transpose(), one.pose.translation);
            let names = [&one.names.name, &one.names.from, &one.names.to];
            json!({ "names": names, "rotation": rotation.as_slice(), "translation": translation.as_slice() })
        })
        .collect();
    json!({ "cameras": cameras, "poses": poses, "says": says(found), "warnings": found.warnings.0 })
}

fn main() {
    for path in std::env::args_os().skip(1) {
        match read_calibration(path.as_ref()) {
            Ok(found) => println!("{}", plain(&found)),
            Err(problem) => println!("{}", json!({ "error": problem.reason() })),
        }
    }
}
