//! Cable whose tension τ parallel to its chord is given: the conditions for its place on the pulley and for its length,
//! and its forces, in numbers or in numbers with derivatives.
//!
//! The exit point follows from the direction of the cable, and this from the exit point. Newton's method on numbers
//! with derivatives, with the derivatives of the conditions as plain numbers, makes one further order right in each
//! step (docs/theory.md, equation (40b9)).

use super::arc::{Beyond, Given, stretch_of, tension_of};
use crate::math::dual::{Dual, Real, combined, dot};
use crate::math::jet::Jet;
use crate::math::{Mat3, Vec3};
use crate::robot::{Anchor, PulleyContact, Wheel};

/// Maximum distance of the exit point from the swivel axis, over the radius, at which it is on the axis. The swivel
/// angle has no effect there.
const ON_AXIS: f64 = 1e-15;

/// Maximum part of the load of a rope across the swivel axis at which it does not turn the swivel: rounding.
const ALONG_AXIS: f64 = 1e-15;

/// Number of unknowns of a cable: changes of wrap and swivel angle, and the unstrained length of the free span. The
/// tension is the variable after them.
const UNKNOWNS: usize = 3;
const TENSION: usize = UNKNOWNS;

/// Variables of the conditions: the unknowns and the tension.
pub(crate) type ByPlace = Dual<4>;

/// Cable without its length.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AtTension<'a, T> {
    /// Attachment [m].
    pub(crate) start_w: [T; 3],
    /// Size of the load per unstrained length [N/m], and unit vector against it.
    pub(crate) load: T,
    pub(crate) up_w: [T; 3],
    /// EA [N].
    pub(crate) axial_stiffness: f64,
    pub(crate) anchor: &'a Anchor,
    /// Place on the pulley near which the cable is; `None` without one.
    pub(crate) contact: Option<PulleyContact>,
    /// True if the direction of the load varies: it may then turn a swivel whose axis is along it now.
    pub(crate) load_turns: bool,
}

/// Unknowns: change of the wrap angle [rad], swivel angle from that place [rad], unstrained length of the span [m].
pub(crate) type Unknown<T> = [T; UNKNOWNS];

/// Cable with values of its unknowns.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SpanAtTension<T> {
    /// Conditions, zero in a cable: force across the tangent, force sideways, length.
    pub(crate) conditions: [T; UNKNOWNS],
    /// Force on the platform [N].
    pub(crate) force_w: [T; 3],
    /// Chord of the free span [m].
    pub(crate) chord: T,
    /// Square of the horizontal force [N²], mean of the vertical end forces and weight of the span [N].
    pub(crate) horizontal_squared: T,
    pub(crate) vertical: T,
    pub(crate) weight: T,
    /// Tension at the drum over a pulley [N].
    pub(crate) drum: Option<T>,
    /// Wheel with the cable on it, and force of the span at the exit point towards the platform [N].
    wheel: Option<Wheel<T>>,
    force_exit_w: [T; 3],
}

/// Derivatives of a cable by its tension, the exit point following, and those of the conditions by the unknowns.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ByTension {
    /// Inverse of the derivatives of the conditions by the unknowns.
    pub(crate) inverse: Mat3,
    /// Force on the platform by τ [-].
    pub(crate) force_w: Vec3,
}

/// Wheel turned by the unknowns.
fn turned_wheel<T: Real>(contact: &PulleyContact, [wrap, swivel, _]: &Unknown<T>) -> Wheel<T> {
    let (sin, cos) = swivel.sin_cos();
    let lifted = |vector: &Vec3| [0, 1, 2].map(|k| T::from(vector[k]));
    let (center, sideways) = (lifted(&contact.center_w), lifted(&contact.sideways_w));
    Wheel {
        radius: T::from(contact.radius),
        wrap: T::from(contact.wrap) + *wrap,
        axis_w: lifted(&contact.axis_w),
        center_w: combined(&center, cos, &sideways, sin),
        sideways_w: combined(&sideways, cos, &center, -sin),
    }
}

impl<T: Real> AtTension<'_, T> {
    /// True if the load of the rope turns the swivel, because the axis is not along it.
    fn turns_swivel(&self, contact: &PulleyContact) -> bool {
        let up = Vec3::from_fn(|k, _| self.up_w[k].value());
        self.load.value() > 0.0 && (self.load_turns || up.cross(&contact.axis_w).norm() > ALONG_AXIS)
    }

    /// Load per unstrained length, world axes [N/m].
    fn load_w(&self) -> [T; 3] {
        self.up_w.map(|component| -(component * self.load))
    }

    /// Cable with these unknowns and this tension.
    pub(crate) fn span(&self, tau: T, unknown: &Unknown<T>) -> SpanAtTension<T> {
        let (zero, length) = (T::from(0.0), unknown[2]);
        let wheel = self.contact.as_ref().map(|contact| turned_wheel(contact, unknown));
        let offset = wheel.as_ref().map(|wheel| wheel.offset_w(wheel.wrap));
        let chord_w: [T; 3] = std::array::from_fn(|k| {
            let from_point = T::from(self.anchor.point_w[k]) - self.start_w[k];
            offset.map_or(from_point, |offset| from_point + offset[k])
        });
        let rise = dot(&chord_w, &self.up_w);
        let across_w: [T; 3] = std::array::from_fn(|k| chord_w[k] - self.up_w[k] * rise);
        let span_squared = dot(&across_w, &across_w);
        let chord = (span_squared + rise * rise).sqrt();

        // The curve: (9) and (10a).
        let per_chord = tau / chord;
        let (found, vertical) = if self.load.value() == 0.0 {
            (chord / (T::from(1.0) + tau * (1.0 / self.axial_stiffness)), per_chord * rise)
        } else {
            let across = self.load * chord / tau * 0.5;
            let k = self.load * length * (0.5 / self.axial_stiffness);
            let (sinh, cosh) = (across - k).sinh_cosh();
            let tanh = sinh / cosh;
            let along = tanh + k;
            let (p, q) = (sinh / across, tanh / along * rise);
            ((span_squared * p * p + q * q).sqrt(), self.load * rise / along * 0.5)
        };
        let weight = self.load * length;
        let force =
            |vertical: T| -> [T; 3] { std::array::from_fn(|k| across_w[k] * per_chord + self.up_w[k] * vertical) };
        let force_w = force(vertical - weight * 0.5);
        let force_exit_w = force(vertical + weight * 0.5).map(|component| -component);

        let mut span = SpanAtTension {
            conditions: [unknown[0], unknown[1], length - found],
            force_w,
            chord,
            horizontal_squared: span_squared * per_chord * per_chord,
            vertical,
            weight,
            drum: None,
            wheel,
            force_exit_w,
        };
        if let (Some(wheel), Some(contact), Some(offset)) = (&wheel, &self.contact, &offset) {
            let tension = dot(&force_exit_w, &force_exit_w).sqrt();
            span.conditions[0] = dot(&wheel.exit_normal_w(), &force_exit_w) / tension;
            if contact.distance_from_axis() > ON_AXIS * contact.radius {
                span.conditions[1] = dot(&wheel.sideways_w, &force_exit_w) / tension;
                if self.turns_swivel(contact) {
                    let (sine, _) = self.beyond(&span).kink.sin_cos();
                    span.conditions[1] = span.conditions[1] - sine;
                }
            }
            let ea = T::from(self.axial_stiffness);
            let potential = tension + tension * tension * (0.5 / self.axial_stiffness) + dot(&self.load_w(), offset);
            span.drum = Some(if self.load.value() == 0.0 {
                tension + zero
            } else {
                tension_of(potential, stretch_of(potential, ea))
            });
        }
        span
    }

    fn beyond(&self, span: &SpanAtTension<T>) -> Beyond<T> {
        let winch = self.anchor.winch.as_ref();
        Beyond::at(&Given {
            force_w: span.force_exit_w,
            load_w: self.load_w(),
            axial_stiffness: T::from(self.axial_stiffness),
            wheel: span.wheel,
            winch: winch.map(|winch| (T::from(winch.drum_side_length), T::from(winch.compliance()))),
        })
    }

    /// Unstrained length from the exit point to the drum [m].
    pub(crate) fn length_beyond(&self, span: &SpanAtTension<T>) -> T {
        let beyond = self.beyond(span);
        beyond.arc_length + beyond.drum_side_length
    }
}

impl<'a> AtTension<'a, f64> {
    /// Cable in numbers with derivatives, by which it does not change.
    fn lifted<T: Real>(&self) -> AtTension<'a, T> {
        AtTension {
            start_w: self.start_w.map(T::from),
            load: T::from(self.load),
            up_w: self.up_w.map(T::from),
            axial_stiffness: self.axial_stiffness,
            anchor: self.anchor,
            contact: self.contact,
            load_turns: self.load_turns,
        }
    }

    /// Cable with its derivatives by the unknowns and by the tension.
    pub(crate) fn span_by_place(&self, tau: f64, length: f64) -> (AtTension<'a, ByPlace>, SpanAtTension<ByPlace>) {
        let unknown = [ByPlace::variable(0.0, 0), ByPlace::variable(0.0, 1), ByPlace::variable(length, 2)];
        let lifted = self.lifted::<ByPlace>();
        (lifted, lifted.span(ByPlace::variable(tau, TENSION), &unknown))
    }

    /// Inverse of the derivatives of the conditions by the unknowns, and the conditions; `None` if it has none.
    pub(crate) fn place_by(&self, tau: f64, length: f64) -> Option<(Mat3, [f64; UNKNOWNS])> {
        let (_, span) = self.span_by_place(tau, length);
        let inverse = Mat3::from_fn(|row, column| span.conditions[row].by[column]).try_inverse()?;
        Some((inverse, span.conditions.map(|condition| condition.value)))
    }

    /// Derivatives by the tension; `length` is the unstrained length of the free span [m]. `None` if the conditions do
    /// not determine the place on the pulley.
    pub(crate) fn by_tension(&self, tau: f64, length: f64) -> Option<ByTension> {
        let (_, span) = self.span_by_place(tau, length);
        let inverse = Mat3::from_fn(|row, column| span.conditions[row].by[column]).try_inverse()?;
        let unknown = -inverse * Vec3::from_fn(|row, _| span.conditions[row].by[TENSION]);
        let follows =
            |number: &ByPlace| number.by[TENSION] + (0..UNKNOWNS).map(|k| number.by[k] * unknown[k]).sum::<f64>();
        Some(ByTension { inverse, force_w: Vec3::from_fn(|k, _| follows(&span.force_w[k])) })
    }
}

impl<const N: usize> AtTension<'_, Jet<N>> {
    /// Cable with this tension along a motion. `inverse` is that of [`ByTension`] at the time zero and `length` the
    /// free length there; as many steps as there are orders of derivatives. With the unstrained length of the free
    /// span.
    pub(crate) fn along(
        &self,
        tau: Jet<N>,
        length: f64,
        inverse: &Mat3,
        orders: usize,
    ) -> (SpanAtTension<Jet<N>>, Jet<N>) {
        let mut unknown = [Jet::from(0.0), Jet::from(0.0), Jet::from(length)];
        let mut span = self.span(tau, &unknown);
        for _ in 0..orders {
            for (k, value) in unknown.iter_mut().enumerate() {
                let of = |row: usize| span.conditions[row] * inverse[(k, row)];
                *value = *value - (of(0) + of(1) + of(2));
            }
            span = self.span(tau, &unknown);
        }
        (span, unknown[2])
    }
}
