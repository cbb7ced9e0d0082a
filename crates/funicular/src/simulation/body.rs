//! The platform as a body in space: its motion about the centre of mass, in world axes, and its turn, in its own axes.

use crate::math::{Mat3, Mat6, Rotation, Vec3, Vec6, skew};
use crate::robot::{Load, Platform, PlatformMotion, Pose, Robot, Wind};

/// Force and moment on the platform for a while.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Push {
    pub(super) from: f64,
    pub(super) until: f64,
    /// Time in which it grows at the beginning and fades at the end [s].
    pub(super) rise: f64,
    pub(super) force_w: Vec3,
    pub(super) moment_w: Vec3,
    pub(super) point_p: Vec3,
}

/// Force and moment on the platform that begin at a time and change with a constant rate, about the platform's origin.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct HeldWrench {
    pub(super) from: f64,
    pub(super) force_w: Vec3,
    pub(super) moment_w: Vec3,
    /// Rates [N/s, N m/s].
    pub(super) force_rate_w: Vec3,
    pub(super) moment_rate_w: Vec3,
}

impl HeldWrench {
    /// Force and moment at a time.
    pub(super) fn at(&self, time: f64) -> [Vec3; 2] {
        let since = time - self.from;
        [self.force_w + self.force_rate_w * since, self.moment_w + self.moment_rate_w * since]
    }
}

impl Push {
    /// Share of the push that acts from a time on.
    pub(super) fn share(&self, time: f64) -> f64 {
        if !(time >= self.from && time < self.until) {
            return 0.0;
        }
        if self.rise == 0.0 {
            return 1.0;
        }
        let step = |x: f64| {
            let x = x.clamp(0.0, 1.0);
            x * x * x * (10.0 - x * (15.0 - 6.0 * x))
        };
        step((time - self.from) / self.rise).min(step((self.until - time) / self.rise))
    }
}

/// The platform as a rigid body.
#[derive(Debug, Clone)]
pub(super) struct MovingBody {
    pub(super) mass: f64,
    /// Inertia about the centre of mass, platform axes.
    pub(super) inertia_p: Mat3,
    pub(super) center_p: Vec3,
    /// Freedoms; `None` for a platform that is held.
    pub(super) motion: Option<PlatformMotion>,
    /// Attachments in the platform frame.
    pub(super) attachments_p: Vec<Vec3>,
    pub(super) gravity_w: Vec3,
    pub(super) load: Load,
    pub(super) drag_area: f64,
    pub(super) translational_damping_p: Vec3,
    pub(super) rotational_damping_p: Vec3,
    pub(super) pushes: Vec<Push>,
    /// Load that a caller gives from step to step.
    pub(super) held: Option<HeldWrench>,
}

/// Motion of the body: position of the centre of mass, rotation, velocity and acceleration (translation in world axes,
/// turn in platform axes).
#[derive(Debug, Clone, Copy)]
pub(super) struct BodyMotion {
    pub(super) center_w: Vec3,
    pub(super) rot_wp: Mat3,
    pub(super) velocity: Vec6,
    pub(super) acceleration: Vec6,
}

/// Translation and turn of six numbers.
pub(super) fn halves(six: &Vec6) -> (Vec3, Vec3) {
    (six.fixed_rows::<3>(0).into_owned(), six.fixed_rows::<3>(3).into_owned())
}

/// Six numbers of a translation and a turn.
pub(super) fn joined(translation: &Vec3, turn: &Vec3) -> Vec6 {
    Vec6::new(translation.x, translation.y, translation.z, turn.x, turn.y, turn.z)
}

impl BodyMotion {
    /// Place, velocity and acceleration of a point of the platform given by its lever arm from the centre of mass.
    #[inline]
    pub(super) fn point(&self, lever_p: &Vec3) -> [Vec3; 3] {
        let (velocity, omega) = halves(&self.velocity);
        let (acceleration, alpha) = halves(&self.acceleration);
        let turn = omega.cross(lever_p);
        [
            self.center_w + self.rot_wp * lever_p,
            velocity + self.rot_wp * turn,
            acceleration + self.rot_wp * (alpha.cross(lever_p) + omega.cross(&turn)),
        ]
    }
}

impl MovingBody {
    pub(super) fn of(robot: &Robot, is_held: bool) -> Self {
        let Platform { mass, inertia_p, drag_area, center_of_mass_p, motion, .. } = robot.platform;
        Self {
            mass,
            inertia_p,
            center_p: center_of_mass_p,
            motion: (!is_held).then_some(motion),
            attachments_p: robot.cables.iter().map(|cable| cable.attachment_p).collect(),
            gravity_w: robot.gravity_w,
            load: robot.load,
            drag_area,
            translational_damping_p: robot.platform.translational_damping_p,
            rotational_damping_p: robot.platform.rotational_damping_p,
            pushes: Vec::new(),
            held: None,
        }
    }

    /// Lever arm of an attachment from the centre of mass, platform axes [m].
    #[inline]
    pub(super) fn lever_p(&self, cable: usize) -> Vec3 {
        self.attachments_p[cable] - self.center_p
    }

    /// Force and moment about the centre of mass (platform axes) of all loads without the cables.
    pub(super) fn loads(&self, time: f64, wind: &Wind, motion: &BodyMotion) -> Vec6 {
        let to_p = motion.rot_wp.transpose();
        let (velocity, omega) = halves(&motion.velocity);
        let relative = Wind { velocity_w: wind.velocity_w - velocity, ..*wind };
        let mut force = self.gravity_w * self.mass + self.load.force_w + relative.pressure_w() * self.drag_area;
        let mut moment =
            to_p * self.load.moment_w + (self.load.point_p - self.center_p).cross(&(to_p * self.load.force_w));

        let of_origin = to_p * velocity - omega.cross(&self.center_p);
        let damping = -self.translational_damping_p.component_mul(&of_origin);
        force += motion.rot_wp * damping;
        moment += -self.center_p.cross(&damping) - self.rotational_damping_p.component_mul(&omega);

        if let Some(held) = &self.held {
            let [force_w, moment_w] = held.at(time);
            force += force_w;
            moment += to_p * moment_w - self.center_p.cross(&(to_p * force_w));
        }
        for push in &self.pushes {
            let share = push.share(time);
            if share > 0.0 {
                force += push.force_w * share;
                let lever = push.point_p - self.center_p;
                moment += (to_p * push.moment_w + lever.cross(&(to_p * push.force_w))) * share;
            }
        }
        joined(&force, &moment)
    }

    /// Power of loads without weight and damping [W], and power lost in the platform's damping.
    pub(super) fn powers(&self, time: f64, wind: &Wind, motion: &BodyMotion) -> [f64; 2] {
        let all = self.loads(time, wind, motion).dot(&motion.velocity);
        let (velocity, omega) = halves(&motion.velocity);
        let weight = self.mass * self.gravity_w.dot(&velocity);
        let of_origin = motion.rot_wp.transpose() * velocity - omega.cross(&self.center_p);
        let lost = self.translational_damping_p.dot(&of_origin.component_mul(&of_origin))
            + self.rotational_damping_p.dot(&omega.component_mul(&omega));
        // Guides of a planar platform do no work, and a held platform does not move.
        [all - weight + lost, lost]
    }

    /// Inertia less loads: what the forces of the cables, −Σ f, have to give.
    pub(super) fn needed(&self, time: f64, wind: &Wind, motion: &BodyMotion) -> Vec6 {
        let (_, omega) = halves(&motion.velocity);
        let (acceleration, alpha) = halves(&motion.acceleration);
        let moment = self.inertia_p * alpha + omega.cross(&(self.inertia_p * omega));
        joined(&(acceleration * self.mass), &moment) - self.loads(time, wind, motion)
    }

    /// Wrench on the body (platform axes for the moment) of a force in world axes at a lever arm.
    #[inline]
    pub(super) fn wrench(motion: &BodyMotion, lever_p: &Vec3, force_w: &Vec3) -> Vec6 {
        joined(force_w, &lever_p.cross(&(motion.rot_wp.transpose() * force_w)))
    }

    /// Part of the Newton matrix that belongs to the platform alone: mass, damping and lever of its load.
    pub(super) fn matrix(&self, motion: &BodyMotion, mass: f64, damping: f64, stiffness: f64) -> Mat6 {
        let mut matrix = Mat6::zeros();
        let rot = motion.rot_wp;
        let along = rot * Mat3::from_diagonal(&self.translational_damping_p) * rot.transpose();
        let translation = Mat3::identity() * (self.mass * mass) + along * damping;
        let mut turn = self.inertia_p * mass + Mat3::from_diagonal(&self.rotational_damping_p) * damping;
        turn -= skew(&(self.load.point_p - self.center_p)) * skew(&(rot.transpose() * self.load.force_w)) * stiffness;
        matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&translation);
        matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&turn);
        matrix
    }

    /// Kinetic and potential energy [J].
    pub(super) fn energy(&self, motion: &BodyMotion) -> [f64; 2] {
        let (velocity, omega) = halves(&motion.velocity);
        let kinetic = 0.5 * (self.mass * velocity.norm_squared() + omega.dot(&(self.inertia_p * omega)));
        [kinetic, -self.mass * self.gravity_w.dot(&motion.center_w)]
    }

    /// Components that the platform can follow; the guide or the hold carries the others.
    #[inline]
    pub(super) fn reduced(&self, vector: &Vec6) -> Vec6 {
        self.motion.map_or_else(Vec6::zeros, |motion| motion.reduced(vector))
    }

    /// Motion of these coordinates.
    #[inline]
    pub(super) fn expanded(&self, coordinates: &Vec6) -> Vec6 {
        self.motion.map_or_else(Vec6::zeros, |motion| motion.expanded(coordinates))
    }

    /// Matrix in the coordinates of the platform, with ones where there is no freedom.
    pub(super) fn reduced_matrix(&self, matrix: &Mat6) -> Mat6 {
        let Some(motion) = self.motion else { return Mat6::identity() };
        let mut reduced = motion.reduced_matrix(matrix);
        for k in motion.count()..6 {
            reduced[(k, k)] = 1.0;
        }
        reduced
    }

    /// Pose of the platform frame.
    pub(super) fn pose(&self, center_w: &Vec3, rot_wp: &Rotation) -> Pose {
        Pose { position_w: center_w - rot_wp * self.center_p, rot_wp: *rot_wp }
    }
}
