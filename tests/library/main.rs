//! Tests of the library's public interface, one file for each subject. They form one program, because each test program is linked with
//! the whole library and runs alone.
//!
//! On wasm32, wasm-bindgen's harness runs the same tests in Node and in browsers, where `test` is the name of its attribute. Tests that
//! read or write files only run natively.

mod agreement;
mod codes;
mod common;
#[cfg(not(target_arch = "wasm32"))]
mod fuzz_corpus;
mod image_model;
mod initial_pose;
mod initialisation;
mod loop_laws;
mod loop_synthetic;
mod normals;
mod opening;
mod painted;
mod pose_angles;
mod pose_correspondence;
mod pose_icp;
mod pose_laws;
mod pose_photometric;
mod pose_reference;
mod pose_search;
mod pose_transforms;
mod refinement_workers;
mod resolutions;
mod rig_cameras;
mod rig_frames;
mod rig_laws;
mod scene_laws;
mod scenes_geometry;
mod scenes_pictures;
mod scenes_samples;
#[cfg(not(target_arch = "wasm32"))]
mod statue;
mod surface;
mod surface_laws;
mod surface_reference;
mod surface_vase;
#[cfg(feature = "rayon")]
mod threads;
mod uncertainty;
mod varying_albedo;
