//! Tangent stiffness compared with differences of the wrench.

use super::{COGIRO, YUAN_4MM, YUAN_8MM, load};
use funicular::math::{Mat6, Vec3, Vec6};
use funicular::statics::{self, StaticModel};

#[test]
fn stiffness_is_symmetric_and_the_differenced_wrench() {
    for text in [YUAN_4MM, YUAN_8MM, COGIRO] {
        let (robot, lengths) = load(text);
        for model in [StaticModel::Spring, StaticModel::Catenary] {
            let rest = statics::forward(&robot, &lengths, model, None).unwrap();
            let k = statics::tangent_stiffness(&robot, &rest).unwrap();
            assert!((k - k.transpose()).amax() < 1e-12 * k.amax());
            // Central differences, extrapolated (Richardson): error of fourth order in the step.
            let along = |i: usize, step: f64| {
                let mut small = [0.0; 6];
                small[i] = step;
                let (translation, turn) =
                    (Vec3::new(small[0], small[1], small[2]), Vec3::new(small[3], small[4], small[5]));
                statics::wrench(&robot, &rest.pose.moved(&translation, &turn), &lengths, model).unwrap()
            };
            let mut differenced = Mat6::zeros();
            for i in 0..6 {
                let h = 2e-6;
                let column: Vec6 =
                    ((along(i, h) - along(i, -h)) * 8.0 - (along(i, 2.0 * h) - along(i, -2.0 * h))) / (-12.0 * h);
                differenced.set_column(i, &column);
            }
            let gap = (k - differenced).amax() / k.amax();
            assert!(gap < 1e-6, "{} {model:?}: {gap:e}", robot.name);
        }
    }
}
