//! The robot for programs whose cables are springs: its equilibrium on straight cables without mass, the spring of
//! every cable, the dead forces on the platform, and what such a program loses.

use anyhow::{Result, bail};
use funicular::cable::CableModel;
use funicular::dynamics::Linearisation;
use funicular::math::Vec3;
use funicular::modes;
use funicular::robot::{Cable, Damping, Load, Material, PlatformMotion, Robot, State, Winch};
use funicular::statics::{self, CableState, Equilibrium, StaticModel};
use funicular_study::at_rest::AtRest;

/// Part of the weight of the platform above which the weight of the cables is reported as lost.
const HEAVY_CABLES: f64 = 1e-6;

/// Robot at rest on springs: straight cables without mass (the static model `spring`), or chains that hang as its
/// cables do.
pub(super) struct SpringRobot<'a> {
    pub(super) robot: &'a Robot,
    pub(super) equilibrium: Equilibrium,
    /// Parts of the robot that the file does not have, one sentence each.
    pub(super) lost: Vec<String>,
}

/// Cable as a spring over its whole length.
pub(super) struct CableSpring {
    /// Stiffness of rope and winch in series [N/m].
    pub(super) stiffness: f64,
    /// Viscous damping of the stretch [N s/m].
    pub(super) damping: f64,
    /// Tension at rest [N].
    pub(super) tension: f64,
}

/// The robot at rest with straight cables: at the lengths of the state, or else at its pose.
///
/// # Errors
/// No such equilibrium, or one with ideal cables, which have no stiffness.
pub(super) fn at_rest(given: &AtRest) -> Result<AtRest> {
    let AtRest { robot, equilibrium, rule, held_pose, .. } = given;
    let straight = match equilibrium.model {
        StaticModel::Spring => equilibrium.clone(),
        StaticModel::Ideal => bail!("ideal cables have no stiffness: give ⟪static_model⟫ `spring` or `catenary`"),
        StaticModel::Catenary if held_pose.is_some() || matches!(robot.state, State::Lengths(_)) => {
            let lengths: Vec<f64> = equilibrium.cables.iter().map(|cable| cable.unstrained_length).collect();
            statics::forward(robot, &lengths, StaticModel::Spring, Some(&equilibrium.pose))?
        }
        StaticModel::Catenary => {
            let rule = rule.clone().unwrap_or_default();
            statics::solve_at(robot, &robot.state, StaticModel::Spring, &rule)?.equilibrium
        }
    };
    Ok(AtRest { equilibrium: straight, ..given.clone() })
}

impl<'a> SpringRobot<'a> {
    /// The robot at rest on straight cables. `given` is the equilibrium that it was made of, `lost` what the file has
    /// lost already.
    pub(super) fn of(at_rest: &'a AtRest, given: &Equilibrium, lost: &[String]) -> Self {
        let mut found = Self { robot: &at_rest.robot, equilibrium: at_rest.equilibrium.clone(), lost: lost.to_vec() };
        found.tell_sag(given);
        found.tell_drives();
        found.tell_ropes_and_platform("the damping of the motion of their ropes is left out, as this motion is");
        found
    }

    /// The robot at rest on chains that have the mass of its cables.
    pub(super) fn of_chains(at_rest: &'a AtRest, lost: &[String]) -> Self {
        let mut found = Self { robot: &at_rest.robot, equilibrium: at_rest.equilibrium.clone(), lost: lost.to_vec() };
        found.tell_drives();
        found.tell_ropes_and_platform("the damping of the motion of their ropes is left out");
        found
    }

    /// Reports what straight cables without mass change.
    fn tell_sag(&mut self, given: &Equilibrium) {
        let masses = self.robot.cables.iter().zip(&given.cables);
        let rope: f64 = masses.map(|(cable, state)| cable.material.mass_per_length * state.unstrained_length).sum();
        if rope < HEAVY_CABLES * self.robot.platform.mass {
            return;
        }

        let compared = if given.model == StaticModel::Catenary {
            let pairs = || self.equilibrium.cables.iter().zip(&given.cables);
            let moved = pairs().map(|(a, b)| (a.attachment_w - b.attachment_w).norm()).fold(0.0, f64::max);
            let length = pairs().map(|(a, b)| (a.unstrained_length - b.unstrained_length).abs()).fold(0.0, f64::max);
            let tension = pairs().map(|(a, b)| (a.tension_platform - b.tension_platform).abs()).fold(0.0, f64::max);
            format!(
                ". With sagging cables the attachments rest up to {moved:.2e} m from here, unstrained lengths differ \
                 by up to {length:.2e} m and tensions by up to {tension:.2e} N"
            )
        } else {
            String::new()
        };
        self.lost.push(format!(
            "the cables are straight and have no mass: {rope:.3} kg of rope beside {} kg of the platform, their sag \
             and their vibration are left out{compared}",
            self.robot.platform.mass
        ));
    }

    /// Reports what cables with a property lose.
    pub(super) fn lose(&mut self, has: impl Fn(&Cable) -> bool, what: &str) {
        let cables = self.robot.cables.iter().filter(|cable| has(cable));
        let names: Vec<&str> = cables.map(|cable| cable.name.as_str()).collect();
        if !names.is_empty() {
            self.lost.push(format!("cables {}: {what}", names.join(", ")));
        }
    }

    /// Reports what pulleys and winches have and springs do not.
    fn tell_drives(&mut self) {
        self.lose(
            |cable| cable.anchor.pulley.as_ref().is_some_and(|pulley| pulley.friction.is_some()),
            "the friction of their pulleys is left out: the state is that without friction",
        );
        self.lose(
            |cable| cable.anchor.pulley.as_ref().is_some_and(|pulley| pulley.inertia > 0.0),
            "the inertia of the wheel about its axle is left out",
        );
        let moves = |winch: &Winch| winch.drum_mass + winch.motor_mass + winch.damping > 0.0;
        self.lose(
            |cable| cable.anchor.winch.as_ref().is_some_and(|winch| moves(winch) || !winch.guide_wheels.is_empty()),
            "inertia, damping and guide wheels of their winches are left out; a winch has the stiffness that it has at \
             rest, and follows its command at once",
        );
    }

    /// Reports what ropes and platform have and the file does not; `undamped` is what becomes of the damping of ropes.
    fn tell_ropes_and_platform(&mut self, undamped: &str) {
        let robot = self.robot;
        self.lose(
            |cable| cable.material.dynamic_axial_stiffness.is_some(),
            "`dynamic_axial_stiffness_n` is left out: the ropes have their stiffness under a slow load",
        );
        self.lose(|cable| is_loaded(robot, cable), "wind and other loads along the cables are left out");
        let damped = |rope: &Material| {
            let (Damping::Ratio(by) | Damping::Viscous(by)) = rope.damping;
            by > 0.0 && rope.mass_per_length > 0.0
        };
        self.lose(|cable| damped(&cable.material), &format!("{undamped}; the loss of their stretch is kept"));
        if robot.platform.translational_damping_p.norm() + robot.platform.rotational_damping_p.norm() > 0.0 {
            self.lost.push("the viscous damping of the platform is left out".to_owned());
        }
        if robot.judges_clearance() {
            self.lost.push("obstacles, bodies of the platform and required clearances are left out".to_owned());
        }
    }

    /// Natural frequencies of the platform on these springs [Hz], all of them: those of `modes` with the static model
    /// `spring` and the cable model `catenary-static`, which has the stiffness T/L of a tensioned cable across it too.
    pub(super) fn frequencies(&self) -> Result<Vec<f64>> {
        // Far above any platform on ropes; without rope mass the list has no other modes.
        const MAX_HZ: f64 = 1e5;

        let linearisation = Linearisation { cable_model: CableModel::CatenaryStatic, ..Linearisation::default() };
        let count = self.robot.platform.motion.count();
        let lowest = |count| modes::lowest(self.robot, &self.equilibrium, linearisation, count, MAX_HZ);
        let (_, found) = match lowest(count) {
            Err(modes::LowestError::Dynamics(error)) => return Err(error.into()),
            // A platform that some cables leave free to move, or that is unstable, has fewer.
            Err(modes::LowestError::TooFew { found: 0, .. }) => return Ok(Vec::new()),
            Err(modes::LowestError::TooFew { found, .. }) => lowest(found)?,
            Ok(found) => found,
        };
        Ok(found.modes.iter().map(|mode| mode.frequency_hz).collect())
    }

    /// Spring of cable `i`; `first_hz` [Hz] is the frequency at which a loss factor becomes a viscous damping.
    pub(super) fn spring(&self, i: usize, first_hz: Option<f64>) -> CableSpring {
        let (cable, state) = (&self.robot.cables[i], &self.equilibrium.cables[i]);
        let yields = cable.anchor.winch.as_ref().map_or(0.0, Winch::compliance);
        let stiffness = 1.0 / (state.unstrained_length / cable.material.axial_stiffness + yields);
        let loss = cable.material.stretch_loss;
        let time = loss.time + first_hz.map_or(0.0, |hz| loss.factor / (std::f64::consts::TAU * hz));
        CableSpring { stiffness, damping: stiffness * time, tension: state.tension_platform }
    }

    /// Dead forces that act on the platform besides its weight: point in the platform frame [m], force in world axes
    /// [N].
    ///
    /// A moment becomes two couples of dead forces at right angles for each of its components, which have the stiffness
    /// ½\[m\]× of the theory (48) in the mean of both: a moment that stays fixed in the world would not be symmetric.
    pub(super) fn dead_forces(&self) -> Vec<(Vec3, Vec3)> {
        let Load { force_w, moment_w, point_p } = self.robot.load;
        let platform = &self.robot.platform;
        let of_wind = self.robot.force_at_mass_centre_w() - self.robot.gravity_w * platform.mass;
        let mut forces = vec![(platform.center_of_mass_p, of_wind), (point_p, force_w)];

        let arms_w = match platform.motion {
            PlatformMotion::PointMass => Vec::new(),
            PlatformMotion::Rigid => vec![Vec3::x(), Vec3::y(), Vec3::z()],
            PlatformMotion::Planar(plane) => in_plane(&plane.normal_w()).to_vec(),
        };
        let reach = self.robot.platform_length();
        let to_platform = self.equilibrium.pose.rot_wp.inverse();
        for (i, a) in arms_w.iter().enumerate() {
            for b in &arms_w[i + 1..] {
                let about = 0.25 * moment_w.dot(&a.cross(b)) / reach;
                for (arm, force) in [(a, b * about), (b, -a * about)] {
                    let at_p = to_platform * (arm * reach);
                    forces.extend([(at_p, force), (-at_p, -force)]);
                }
            }
        }
        forces.retain(|(_, force)| *force != Vec3::zeros());
        forces
    }

    /// Half sides of a box about the attachments, in the platform frame, with its centre [m]; no side is thinner than a
    /// part of the platform's size.
    pub(super) fn shown_box(&self) -> [Vec3; 2] {
        const THINNEST: f64 = 0.02;

        let first = self.robot.cables[0].attachment_p;
        let (mut low, mut high) = (first, first);
        for cable in &self.robot.cables {
            (low, high) = (low.inf(&cable.attachment_p), high.sup(&cable.attachment_p));
        }
        let widest = (high - low).amax();
        let reach = if widest > 0.0 { widest } else { self.distance_of_anchors() };
        [(low + high) * 0.5, (high - low).map(|side| (0.5 * side).max(THINNEST * reach))]
    }

    /// Mean length of the free spans [m].
    fn distance_of_anchors(&self) -> f64 {
        self.equilibrium.cables.iter().map(CableState::chord).sum::<f64>() / self.robot.cables.len() as f64
    }
}

/// True if the wind or another load acts along a cable.
pub(super) fn is_loaded(robot: &Robot, cable: &Cable) -> bool {
    let drags = robot.wind.velocity_w != Vec3::zeros() && cable.material.drag_width.is_some_and(|width| width > 0.0);
    drags || cable.load_per_length_w != Vec3::zeros()
}

/// Two unit vectors that form right-handed axes together with a normal.
pub(super) fn in_plane(normal: &Vec3) -> [Vec3; 2] {
    let first = normal.cross(&Vec3::ith(normal.iamin(), 1.0)).normalize();
    [first, normal.cross(&first)]
}
