//! Several equilibria of the same lengths.

use funicular::robot::{Robot, State};
use funicular::statics::{self, StaticModel};

#[test]
#[ignore = "prints"]
fn probe() {
    for entry in std::fs::read_dir("../../robots").unwrap() {
        let path = entry.unwrap().path();
        let robot = Robot::from_toml(&std::fs::read_to_string(&path).unwrap()).unwrap();
        let lengths: Vec<f64> = match &robot.state {
            State::Lengths(lengths) => lengths.clone(),
            State::Pose(pose) => statics::inverse(&robot, pose, StaticModel::Catenary)
                .unwrap()
                .cables
                .iter()
                .map(|c| c.unstrained_length)
                .collect(),
            State::Unknown => continue,
        };
        for model in [StaticModel::Catenary, StaticModel::Spring] {
            let asked = if let State::Pose(pose) = &robot.state { Some(pose) } else { None };
            let t = std::time::Instant::now();
            let all = match statics::all(&robot, &lengths, model, asked) {
                Ok(a) => a,
                Err(e) => {
                    println!("{path:?} {e}");
                    continue;
                }
            };
            println!(
                "{} {model:?}: {} found, {} starts, sum {} expected {:?}, {:?}",
                path.display(),
                all.found.len(),
                all.starts,
                all.index_sum,
                all.expected_index_sum,
                t.elapsed()
            );
            for c in all.found.iter().filter(|c| c.is_stable()).take(6) {
                println!(
                    "   falling {} indifferent {} energy {:?} distance {:.4} z {:.3}",
                    c.falling, c.indifferent, c.energy, c.distance, c.equilibrium.pose.position_w.z
                );
            }
            let t = std::time::Instant::now();
            let o =
                statics::forward(&robot, &lengths, model, asked).ok().and_then(|e| statics::other_stable(&robot, &e));
            println!("   other {:?} {:?}", o.map(|o| (o.energy, o.distance)), t.elapsed());
        }
    }
}
