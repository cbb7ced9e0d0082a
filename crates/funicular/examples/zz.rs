use funicular::math::Vec3;
use funicular::proof::{PositionBox, ProofSearch, ProofStatement};
use funicular::robot::{Pose, Robot};
use funicular::statics::StaticModel;
fn main() {
    let robot = Robot::from_toml(funicular_robots::COGIRO).unwrap();
    for model in [StaticModel::Spring, StaticModel::Catenary] {
        let s = ProofStatement::of(&robot, &Pose::new([0.0; 3], [0.0; 3]), model, Vec3::zeros()).unwrap();
        let begin = std::time::Instant::now();
        let mut search = ProofSearch::new(PositionBox { lower: Vec3::new(-7.5, -5.5, 0.0), upper: Vec3::new(7.5, 5.5, 5.4) });
        for target in [5000, 10000, 20000, 50_000, 100_000, 200_000, 400_000, 800_000] {
            while search.tried() < target {
                let next = search.next(256.min(target - search.tried()));
                if next.is_empty() { break; }
                let proofs: Vec<_> = next.iter().map(|r| s.prove(r)).collect();
                search.add(&proofs);
            }
            let v = search.volumes();
            println!("{target} {:.1}s in {:.1} out {:.1} und {:.4} share {:.4}", begin.elapsed().as_secs_f64(), v.inside, v.whole - v.outside, v.undecided() / v.whole, v.undecided_share());
        }
    }
}
