//! Benchmarks of maps on one core, with the robot robots/yuan2014-4mm.toml at 10.55 kg.
#![allow(missing_docs)]

use criterion::{Criterion, criterion_group, criterion_main};
use funicular::robot::Robot;
use funicular_study::sweep::{Options, Plan, Poses, Quantity};
use std::time::Duration;

/// Measures a thousand poses in the middle of the workspace, on one thread.
fn sweeps(c: &mut Criterion) {
    let robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).expect("the library's robot");
    let part = |i: u32, root: f64| (f64::from(i + 1) * root).fract() - 0.5;
    let poses = (0..1000)
        .map(|i| [part(i, 2f64.sqrt()), part(i, 3f64.sqrt()), 0.6 + 0.4 * part(i, 5f64.sqrt()), 0.0, 0.0, 0.0])
        .collect();
    let points = Poses::list(robot.clone(), poses);
    let options = Options::default();
    let mut bench = |name: &str, quantities: &[&str]| {
        let quantities: Vec<Quantity> = quantities.iter().map(|name| name.parse().expect("a quantity")).collect();
        let plan = Plan::new(&points, &robot, &quantities, &options).expect("a plan");
        c.bench_function(&format!("sweep: 1,000 poses, {name}"), |b| {
            b.iter(|| (0..plan.chunks()).map(|i| plan.evaluate(i, || false).map_or(0, |c| c.rows())).sum::<usize>());
        });
    };
    bench("lengths and tensions", &["lengths", "tensions"]);
    bench("lengths, tensions and exact first frequency", &["lengths", "tensions", "first-frequency"]);
}

criterion_group! {
    name = maps;
    config = Criterion::default()
        .warm_up_time(Duration::from_secs(1))
        .measurement_time(Duration::from_secs(3))
        .sample_size(30);
    targets = sweeps
}
criterion_main!(maps);
