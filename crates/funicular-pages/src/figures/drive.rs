//! Pulleys, guide wheels, drum sides and drums in space, for the figures of a robot.

use funicular::math::Vec3;
use funicular::robot::Cable;
use funicular::statics::CableState;

/// Number of intervals of a complete wheel.
const INTERVALS: u32 = 48;

/// Pulley of a cable with the cable behind it.
pub(crate) struct DriveLines {
    /// Rim of the wheel, closed.
    pub(crate) wheel: Vec<Vec3>,
    /// Cable from the exit point around the wheel to the entry point, and on to the drum.
    pub(crate) path: Vec<Vec3>,
    /// Guide wheels between pulley and drum: name and place.
    pub(crate) guide_wheels: Vec<(String, Vec3)>,
    /// Place of the drum if the drum side is straight; `None` without a winch, or with the drum at the entry point.
    pub(crate) drum: Option<Vec3>,
}

impl DriveLines {
    /// Lines of a cable at rest; `None` without a pulley.
    ///
    /// The robot file does not say where the drum is. It is drawn as if the cable came to the pulley in a straight
    /// line.
    pub(crate) fn of(cable: &Cable, state: &CableState) -> Option<Self> {
        let at_rest = state.drive.as_ref().and_then(|drive| drive.contact);
        let contact = at_rest.or_else(|| cable.anchor.contact(&state.attachment_w))?;
        let entry_w = cable.anchor.reference_w() + state.displacement_w;
        let rim = |angle: f64| entry_w + contact.offset_w(angle);

        let whole = (0..=INTERVALS).map(|k| rim(std::f64::consts::TAU * f64::from(k) / f64::from(INTERVALS)));
        let arc = (0..=INTERVALS).rev().map(|k| rim(contact.wrap * f64::from(k) / f64::from(INTERVALS)));
        let mut path: Vec<Vec3> = arc.collect();
        let length = cable.anchor.drum_side_length();
        let drum = (length > 0.0).then(|| entry_w - contact.axis_w * length);
        path.extend(drum);
        let guide_wheels = cable.anchor.winch.iter().flat_map(|winch| &winch.guide_wheels);
        let guide_wheels =
            guide_wheels.map(|wheel| (wheel.name.clone(), entry_w - contact.axis_w * wheel.distance)).collect();
        Some(Self { wheel: whole.collect(), path, guide_wheels, drum })
    }

    /// Lines of all cables with pulleys.
    pub(crate) fn all(cables: &[Cable], states: &[CableState]) -> Vec<Self> {
        cables.iter().zip(states).filter_map(|(cable, state)| Self::of(cable, state)).collect()
    }

    /// Points that a figure has to show.
    pub(crate) fn points(&self) -> impl Iterator<Item = Vec3> {
        self.wheel.iter().chain(&self.path).copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use funicular::robot::Robot;
    use funicular::statics::{self, StaticModel};

    #[test]
    fn the_lines_meet_the_free_span_and_end_at_the_drum() {
        let text = "name = \"one\"\n[platform]\nmass_kg = 5.0\nmotion = \"point-mass\"\n[materials.rope]\n\
                    axial_stiffness_n = 1e5\nmass_kg_per_m = 0.01\n[pulleys.wheel]\nradius_m = 0.2\n\
                    entry_direction = [0, 0, 1]\n[winches.drum]\ndrum_side_length_m = 1.5\n\
                    [guide_wheels.foot]\nwinch = \"drum\"\ndistance_m = 1.2\nradius_m = 0.04\ninertia_kg_m2 = 1e-4\n\
                    [[cables]]\nname = \"1\"\n\
                    material = \"rope\"\npulley = \"wheel\"\nwinch = \"drum\"\nanchor_m = [0, 0, 4]\n\
                    unstrained_length_m = 4.0\n";
        let robot = Robot::from_toml(text).unwrap();
        let rest = statics::forward(&robot, &[4.0], StaticModel::Catenary, None).unwrap();
        let lines = DriveLines::of(&robot.cables[0], &rest.cables[0]).unwrap();
        assert!((lines.path[0] - rest.cables[0].anchor_w).norm() < 1e-12);
        assert!((lines.drum.unwrap() - Vec3::new(0.0, 0.0, 2.5)).norm() < 1e-12);

        assert_eq!(lines.guide_wheels[0].0, "foot");
        assert!((lines.guide_wheels[0].1 - Vec3::new(0.0, 0.0, 2.8)).norm() < 1e-12);

        // The platform hangs below the far side of the wheel, half around.
        assert!((rest.cables[0].anchor_w.z - 4.0).abs() < 1e-6);
        let radii = lines.wheel.iter().map(|point| {
            let center_w = 0.5 * (lines.wheel[0] + lines.wheel[INTERVALS as usize / 2]);
            (point - center_w).norm()
        });
        assert!(radii.fold(0.0_f64, |most, radius| most.max((radius - 0.2).abs())) < 1e-12);
    }
}
