//! Writes pictures to target/tmp for visual inspection, because no test can decide whether a face looks like a face.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::common::{beside, colour_bytes, data_dir, depth_bytes, normal_bytes, write_png};
use bimodal_stereo::scenes::{DepthData, Relief, SampleRequest, Scene, bare_grid, light, lights, surface, surfaces};
use bimodal_stereo::{Angles, Size};

fn draw(name: &str, relief: &Relief, light_name: &str, side: usize) {
    let scene = Scene::new(relief).expect("a surface");
    let size = Size { width: side, height: side };
    let request = SampleRequest { light: light(light_name).expect("a name"), size, ..SampleRequest::default() };
    let sample = scene.sample(&request).expect("a sample");
    let DepthData::Map(depth) = &sample.depth.data else { panic!("a depth map") };
    let pictures = [
        colour_bytes(&sample.image.colours),
        normal_bytes(&sample.truth.image_normals),
        depth_bytes(depth),
        normal_bytes(&sample.truth.depth_normals),
    ];
    let (size, bytes) = beside(size, &pictures);
    let seen = sample.image.mask.iter().filter(|&&inside| inside).count();
    println!("{}: {seen} pixels", write_png(&format!("{name}-{light_name}-{side}.png"), size, &bytes).display());
    assert!(seen > side * side / 6, "{name} fills {seen} of {} pixels", side * side);
}

#[cfg_attr(target_arch = "wasm32", ignore = "writes files")]
#[test]
fn built_in_surfaces_under_built_in_lights() {
    for name in surfaces::NAMES {
        for light_name in lights::NAMES {
            draw(name, &surface(name).expect("a name"), light_name, 256);
        }
        draw(name, &surface(name).expect("a name"), "colourful", 64);
    }
}

#[test]
#[ignore = "needs ../shared/data"]
fn mozart() {
    let data = data_dir();
    let relief = crate::common::mozart(&data);
    for side in [32, 64, 128] {
        draw("mozart", &relief, "colourful", side);
    }
    let rotation = Angles { beta: 20.0, ..Angles::default() }.rotation();
    let pair = bare_grid(&relief, &lights::COLOURFUL, &rotation, 1.0).expect("a pair");
    let pictures = [colour_bytes(&pair.image.colours), normal_bytes(&pair.truth.image_normals)];
    let (size, bytes) = beside(pair.image.size, &pictures);
    let seen = pair.image.mask.iter().filter(|&&inside| inside).count();
    println!("{}: {seen} samples", write_png("mozart-bare-grid.png", size, &bytes).display());
    assert!(seen > 400, "the bare grid keeps {seen} samples");
}
