//! Integrations of one size do not allocate after the first.

#[path = "common/allocations.rs"]
mod allocations;

use std::sync::atomic::Ordering;

use allocations::ALLOCATIONS;
use bimodal_stereo::{
    AnchorWeight, Anchors, Camera, IntegrationOptions, Integrator, Normals, Robustness, Size, gradients, normals,
};

// This binary has only one test, so nothing else runs during the count. The test harness has a thread too, so the smallest
// count of several trials is taken.
#[test]
fn later_integrations_allocate_nothing() {
    let size = Size { width: 61, height: 47 };
    let mask: Vec<bool> = (0..size.len()).map(|index| index % 61 > 4 && index / 61 > 2).collect();
    let field = |scale: f32| (0..size.len()).map(|index| (index as f32 * scale).sin()).collect::<Vec<f32>>();
    let (mut p, mut q, height) = (field(0.01), field(0.03), field(0.002));
    let options = IntegrationOptions { robustness: Robustness::Estimated, ..Default::default() };
    let mut z = vec![0.0; size.len()];
    let mut surface = Normals::missing(size.len());
    let mut integrator = Integrator::new(size, &mask).expect("a mask");
    let least = (0..5)
        .map(|round| {
            // In each trial, other pixels are unknown and form other components.
            p[500 + 100 * round..540 + 100 * round].fill(f32::NAN);
            let before = ALLOCATIONS.load(Ordering::Relaxed);
            integrator.integrate(&p, &q, None, &options, &mut z).expect("sizes agree");
            let anchors = Anchors { height: &height, weight: AnchorWeight::Uniform(0.1) };
            integrator.integrate(&p, &q, Some(anchors), &options, &mut z).expect("sizes agree");
            normals::of_depth_into(size, Camera::Orthographic, &z, &mut surface);
            gradients(size, &Camera::Orthographic, &surface, &mask, &mut p, &mut q);
            ALLOCATIONS.load(Ordering::Relaxed) - before
        })
        .min();
    assert_eq!(least, Some(0));
}
