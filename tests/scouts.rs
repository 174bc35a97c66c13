//! Scouts change how long an opening takes, and nothing else.

use std::collections::VecDeque;

use bimodal_stereo::scenes::{Sample, SampleRequest, Scene, light, surface};
use bimodal_stereo::{Angles, Estimator, Finding, LightSource, Options, Scout, Status, StepReport, Task};

fn scene(name: &str, light_name: &str) -> Sample {
    let request = SampleRequest {
        light: light(light_name).unwrap(),
        rotation: Angles { alpha: 10.0, beta: 50.0, gamma: 15.0 }.rotation(),
        scale: 1.1,
        overlap: 0.7,
        noise: 0.01,
        ..Default::default()
    };
    Scene::new(&surface(name).unwrap()).unwrap().sample(&request).unwrap()
}

/// Noise that needs no library: which task is given away, which one comes back, and when.
struct Chance(u64);

impl Chance {
    fn below(&mut self, count: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (self.0 >> 33) % count
    }
}

/// Runs with so many scouts; each brings what it finds late and out of order, and the first one brings nothing at all
/// after a while. Also how many findings came in.
fn run(sample: &Sample, options: &Options, scouts: usize, seed: u64) -> (StepReport, Vec<u32>, usize) {
    let mut chance = Chance(seed);
    let mut estimator = Estimator::new(sample.colour_image(), &sample.depth_map(), options.clone()).unwrap();
    let scout = || Scout::new(sample.colour_image(), &sample.depth_map(), options.clone()).unwrap();
    let mut scouts: Vec<(Scout, VecDeque<Vec<f64>>)> = (0..scouts).map(|_| (scout(), VecDeque::new())).collect();
    let mut findings = 0;
    while estimator.report().status == Status::Running {
        estimator.step();
        for (index, (scout, tasks)) in scouts.iter_mut().enumerate() {
            while tasks.len() < 3 {
                let Some(task) = estimator.take_task() else { break };
                tasks.push_back(task.to_numbers());
            }
            let is_gone = index == 0 && findings > 40;
            if is_gone || chance.below(3) == 0 {
                continue;
            }
            let task = if chance.below(2) == 0 { tasks.pop_front() } else { tasks.pop_back() };
            if let Some(task) = task.and_then(|task| Task::from_numbers(&task)) {
                let finding = scout.perform(&task).to_numbers();
                estimator.accept(Finding::from_numbers(&finding).unwrap());
                findings += 1;
            }
        }
    }
    let depth = estimator.image_depth().iter().map(|depth| depth.to_bits()).collect();
    (estimator.report().clone(), depth, findings)
}

#[test]
fn any_number_of_scouts_leaves_the_same_to_the_bit() {
    for (name, light, known) in [("bust", "window", false), ("ripples", "overcast", false), ("vase", "colourful", true)]
    {
        let sample = scene(name, light);
        let light = if known { LightSource::Known(sample.light) } else { LightSource::Estimate };
        let options = Options { light, ..Options::default() };
        let (alone, depth, _) = run(&sample, &options, 0, 0);
        for (scouts, seed) in [(1, 1), (2, 2), (3, 3)] {
            let (report, other, findings) = run(&sample, &options, scouts, seed);
            assert!(findings > 40, "{name}: {findings}");
            assert_eq!(report, alone, "{name}, {scouts} scouts");
            assert_eq!(depth, other, "{name}, {scouts} scouts");
        }
    }
}
