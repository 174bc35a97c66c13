//! Tests of the library's public face, a file a subject. One program: each test program more is compiled and linked with all of the
//! library, and runs alone.
//!
//! On wasm32 the same tests run by wasm-bindgen's harness, in Node and in browsers: there `test` is the name of its attribute. Those that
//! read or write files run natively alone.

mod agreement;
mod codes;
mod common;
#[cfg(not(target_arch = "wasm32"))]
mod fuzz_corpus;
mod image_model;
mod initialisation;
mod loop_laws;
mod loop_synthetic;
mod normals;
mod opening;
mod paint;
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
mod told_start;
mod uncertainty;
