//! Equilibrium under a wrench before its release, and how far the linear motion is from it.

use crate::at_rest::AtRest;
use crate::request::SettleRequest;
use crate::text::significant;
use funicular::math::Vec3;
use funicular::robot::Pose;
use funicular::statics::{self, StaticModel};

/// Relative difference of the linear displacement from that of the equilibrium under the wrench from which on linear
/// motion is in doubt. A release of 1.95 kg from the robot of Yuan 2014 has 0.19, and its linear history is wrong by
/// 0.18.
const NOT_LINEAR: f64 = 0.1;

/// Equilibrium under the wrench, before the release.
pub(super) struct UnderWrench {
    /// Displacement of the point from its rest, and the names of the cables that are slack; `None` if there is no such
    /// equilibrium.
    pub(super) found: Option<(Vec3, Vec<String>)>,
}

impl UnderWrench {
    /// `None` for ideal cables, which no wrench displaces.
    pub(super) fn of(AtRest { robot, equilibrium, .. }: &AtRest, request: &SettleRequest) -> Option<Self> {
        if equilibrium.model == StaticModel::Ideal {
            return None;
        }
        let [force, moment] = [request.release_n, request.release_n_m].map(|of| Vec3::from(of.unwrap_or_default()));
        let point_p = Vec3::from(request.points.input_point_m.unwrap_or_default());
        let mut loaded = robot.clone();
        let load = &mut loaded.load;
        load.moment_w += moment;
        if load.force_w == Vec3::zeros() {
            load.point_p = point_p;
        } else {
            // Two forces at different points: the arm of the released one is that at rest.
            load.moment_w += (equilibrium.pose.rot_wp * (point_p - load.point_p)).cross(&force);
        }
        load.force_w += force;

        let lengths: Vec<f64> = equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect();
        let under = statics::forward(&loaded, &lengths, equilibrium.model, Some(&equilibrium.pose)).ok();
        let measured_p = Vec3::from(request.points.output_point_m.unwrap_or_default());
        let place = |pose: &Pose| pose.position_w + pose.rot_wp * measured_p;
        let found = under.map(|under| {
            let slack = under.cables.iter().zip(&robot.cables).filter(|(state, _)| state.is_slack());
            let names = slack.map(|(_, cable)| format!("\"{}\"", cable.name)).collect();
            (place(&under.pose) - place(&equilibrium.pose), names)
        });
        Some(Self { found })
    }

    /// Caveat if the linear displacement is not that of the equilibrium, or a cable is slack there.
    pub(super) fn caveat(&self, linear: &Vec3) -> Option<String> {
        let Some((exact, slack)) = &self.found else {
            return Some(
                "there is no equilibrium with this force or moment at these lengths: the linear motion after its \
                 release is not what happens; release less"
                    .to_owned(),
            );
        };
        if !slack.is_empty() {
            return Some(format!(
                "before the release {} slack: the linear motion does not know that; release less",
                if let [one] = &slack[..] {
                    format!("cable {one} is")
                } else {
                    format!("cables {} are", slack.join(", "))
                }
            ));
        }
        let gap = (linear - exact).norm() / exact.norm();
        (gap > NOT_LINEAR).then(|| {
            format!(
                "the release is not small: the linear displacement before it is {} mm, that of the equilibrium {} mm; \
                 amplitudes and the history are wrong by as much",
                significant(1e3 * linear.norm(), 4),
                significant(1e3 * exact.norm(), 4)
            )
        })
    }
}
