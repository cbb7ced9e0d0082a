//! Derivatives of a cable at rest with a drive: force, free length, place on the pulley and numbers of the end, with
//! respect to the geometry, the load and the numbers of the drive.
//!
//! The formulas of `arc` and `anchor_end`, in dual numbers, give the derivatives with respect to the inner variables:
//! force at the exit point, load, stiffness, wheel, drum side and winch. The differentiated conditions (65) then give
//! wrap, swivel angle and free length, and with these the force, with respect to the outer variables (docs/theory.md,
//! equation (60j)).

use super::anchor_end::EndNumbers;
use super::arc::{Beyond, Given};
use crate::catenary::space::HangingCable;
use crate::math::dual::{Dual, Real, dot};
use crate::math::{Mat3, Matrix, Vec3};
use crate::robot::{Anchor, Pulley, PulleyContact, Wheel};

/// Number of outer variables of a cable with a drive, and of the inner variables of its end.
pub(crate) const VARIABLES: usize = 14;

/// Places of the variables. Outer: the vector from the attachment to the anchor's point (`REACH`), the load per
/// unstrained length, EA, the radius, the rotation vector of the pulley, the length from the entry point to the drum,
/// the length that the winch pays out per tension, and the unstrained length (`LENGTH`). Inner: the same with the force
/// at the exit point towards the platform for the reach, and the wrap angle for the length.
pub(crate) mod place {
    pub(crate) const REACH: usize = 0;
    pub(crate) const FORCE: usize = 0;
    pub(crate) const LOAD: usize = 3;
    pub(crate) const AXIAL_STIFFNESS: usize = 6;
    pub(crate) const RADIUS: usize = 7;
    pub(crate) const TURN: usize = 8;
    pub(crate) const DRUM_SIDE: usize = 11;
    pub(crate) const COMPLIANCE: usize = 12;
    pub(crate) const LENGTH: usize = 13;
    pub(crate) const WRAP: usize = 13;
}

use place::{AXIAL_STIFFNESS, COMPLIANCE, DRUM_SIDE, FORCE, LENGTH, LOAD, RADIUS, REACH, TURN, WRAP};

/// Number with its derivatives by the inner variables.
type Inner = Dual<VARIABLES>;

/// Row of the derivatives of a number by the outer variables.
pub(crate) type OuterRow = [f64; VARIABLES];

/// Maximum distance of the exit point from the swivel axis, over the radius, at which it is on the axis. The swivel
/// angle has no effect there.
const ON_AXIS: f64 = 1e-15;

/// Derivatives of a cable at rest with a drive, by the outer variables.
#[derive(Debug, Clone)]
pub(crate) struct DriveDerivatives {
    /// Force on the platform, by components.
    pub(crate) force_w: [OuterRow; 3],
    /// Chord, from the attachment to the exit point, by components.
    pub(crate) chord_w: [OuterRow; 3],
    /// Unstrained length of the free span.
    pub(crate) free_length: OuterRow,
    /// Numbers of the end at the exit point, as in [`end`].
    pub(crate) end: [OuterRow; end::COUNT],
}

/// Numbers of the end of a cable at its exit point, in this order: direction t towards the platform (three components),
/// direction ν sideways, stretch λ at the exit point, stretch λ_E between entry point and drum, compliance Γ_r of arc
/// and drum side, the part of the drum side, stiffness along the cable by its weight, between along and sideways,
/// sideways, distance of the exit point from the swivel axis, tension from the entry point to the drum.
pub(crate) mod end {
    pub(crate) const TRAVEL: usize = 0;
    pub(crate) const SIDEWAYS: usize = 3;
    pub(crate) const STRETCH: usize = 6;
    pub(crate) const STRETCH_DRUM: usize = 7;
    pub(crate) const ROPE_COMPLIANCE: usize = 8;
    pub(crate) const DRUM_SIDE_COMPLIANCE: usize = 9;
    pub(crate) const WEIGHT: usize = 10;
    pub(crate) const COUPLING: usize = 11;
    pub(crate) const SIDEWAYS_STIFFNESS: usize = 12;
    pub(crate) const DISTANCE: usize = 13;
    pub(crate) const TENSION_DRUM: usize = 14;
    pub(crate) const COUNT: usize = 15;
}

/// Inner variables by the outer ones.
struct Chain([OuterRow; VARIABLES]);

impl Chain {
    /// Row of a number by the outer variables.
    fn row(&self, number: &Inner) -> OuterRow {
        let mut row = [0.0; VARIABLES];
        for (by, inner) in number.by.iter().zip(&self.0) {
            row.iter_mut().zip(inner).for_each(|(sum, entry)| *sum += by * entry);
        }
        row
    }
}

/// Wheel whose pulley, with the cable's place on it, turns by the variables.
fn turning(contact: &PulleyContact) -> Wheel<Inner> {
    // A unit vector u turns by φ × u.
    let vector = |u: &Vec3| {
        std::array::from_fn(|k| {
            let mut component = Inner::from(u[k]);
            let (next, after) = ((k + 1) % 3, (k + 2) % 3);
            component.by[TURN + next] = u[after];
            component.by[TURN + after] = -u[next];
            component
        })
    };
    Wheel {
        radius: Inner::variable(contact.radius, RADIUS),
        wrap: Inner::variable(contact.wrap, WRAP),
        axis_w: vector(&contact.axis_w),
        center_w: vector(&contact.center_w),
        sideways_w: vector(&contact.sideways_w),
    }
}

impl DriveDerivatives {
    /// Derivatives of a cable with this free span over its anchor's pulley and to its winch; `contact` is its place on
    /// the pulley. `None` if the conditions do not determine that place.
    ///
    /// # References
    /// docs/theory.md, equation (60j).
    pub(crate) fn of(span: &HangingCable, anchor: &Anchor, contact: Option<&PulleyContact>) -> Option<Self> {
        let given = given_variables(span, anchor, contact);
        let beyond = Beyond::at(&given);
        let offset = given.wheel.as_ref().map(|wheel| wheel.offset_w(wheel.wrap));
        let offset_by = |variable: usize| offset.map_or_else(Vec3::zeros, |o| Vec3::from(o.map(|c| c.by[variable])));

        // Changes of the span by the unknowns (wrap, swivel angle, free length) and by the outer variables.
        let rates = SpanRates::of(span);
        let axis_w = contact.map_or_else(Vec3::zeros, |contact| contact.axis_w);
        let offset_by_swivel = (0..3).fold(Vec3::zeros(), |sum, k| sum + offset_by(TURN + k) * axis_w[k]);
        let zero = Vec3::zeros();
        let of_unknowns = [
            rates.change(offset_by(WRAP), 0.0, zero, 0.0),
            rates.change(offset_by_swivel, 0.0, zero, 0.0),
            rates.change(zero, 1.0, zero, 0.0),
        ];
        let unit = |k: usize| Vec3::from_fn(|i, _| f64::from(u8::from(i == k)));
        let of_variables: [SpanChange; VARIABLES] = std::array::from_fn(|variable| match variable {
            REACH..LOAD => rates.change(unit(variable - REACH), 0.0, zero, 0.0),
            LOAD..AXIAL_STIFFNESS => rates.change(zero, 0.0, unit(variable - LOAD), 0.0),
            AXIAL_STIFFNESS => rates.change(zero, 0.0, zero, 1.0),
            LENGTH => rates.change(zero, 0.0, zero, 0.0),
            _ => rates.change(offset_by(variable), 0.0, zero, 0.0),
        });
        let conditions = conditions(&given, &beyond, contact);
        let solved = unknowns(&conditions, contact, &of_unknowns, &of_variables)?;

        // All that changes, by the outer variables.
        let mut chain = [[0.0; VARIABLES]; VARIABLES];
        let (mut force_w, mut chord_w) = ([[0.0; VARIABLES]; 3], [[0.0; VARIABLES]; 3]);
        let mut free_length = [0.0; VARIABLES];
        for (variable, change) in of_variables.iter().enumerate() {
            let mut whole = *change;
            of_unknowns.iter().enumerate().for_each(|(j, of)| whole.add(of, solved[(j, variable)]));
            for k in 0..3 {
                chain[FORCE + k][variable] = whole.at_exit[k];
                chain[TURN + k][variable] = axis_w[k] * solved[(1, variable)];
                force_w[k][variable] = whole.force[k];
                chord_w[k][variable] = whole.chord[k];
            }
            chain[WRAP][variable] = solved[(0, variable)];
            free_length[variable] = whole.longer;
        }
        for (variable, row) in chain.iter_mut().enumerate().take(LENGTH).skip(LOAD) {
            row[variable] += 1.0;
        }

        let chain = Chain(chain);
        let end = end_numbers(&given, &beyond).map(|number| chain.row(&number));
        Some(Self { force_w, chord_w, free_length, end })
    }
}

/// Numbers that the end of a cable is given, as inner variables.
fn given_variables(span: &HangingCable, anchor: &Anchor, contact: Option<&PulleyContact>) -> Given<Inner> {
    let given = Given::of(span, anchor, contact);
    let vector = |values: [f64; 3], first: usize| std::array::from_fn(|k| Inner::variable(values[k], first + k));
    Given {
        force_w: vector(given.force_w, FORCE),
        load_w: vector(given.load_w, LOAD),
        axial_stiffness: Inner::variable(given.axial_stiffness, AXIAL_STIFFNESS),
        wheel: contact.map(turning),
        winch: given
            .winch
            .map(|(length, compliance)| (Inner::variable(length, DRUM_SIDE), Inner::variable(compliance, COMPLIANCE))),
    }
}

/// Change of a free span: chord, force on the platform, free length, and force at the exit point towards the platform.
#[derive(Clone, Copy)]
struct SpanChange {
    chord: Vec3,
    force: Vec3,
    longer: f64,
    at_exit: Vec3,
}

impl SpanChange {
    /// Adds a multiple of another change.
    fn add(&mut self, other: &Self, size: f64) {
        self.chord += other.chord * size;
        self.force += other.force * size;
        self.longer += other.longer * size;
        self.at_exit += other.at_exit * size;
    }
}

/// Derivatives of the force of a free span on the platform, (53), with its length and its load.
struct SpanRates {
    by_chord: Mat3,
    by_free_length: Vec3,
    by_load: Mat3,
    by_stiffness: Vec3,
    free_length: f64,
    load_w: Vec3,
}

impl SpanRates {
    fn of(span: &HangingCable) -> Self {
        let rope = span.catenary.rope();
        let (free_length, load_w, by_chord) = (rope.unstrained_length, span.load_w(), span.tangent_w());
        let mean_w = span.force_on_start_w() - load_w * (0.5 * free_length);
        Self {
            by_chord,
            by_free_length: span.force_by_length_w(),
            by_load: span.force_by_load_w(),
            by_stiffness: by_chord * mean_w * (free_length / rope.axial_stiffness.powi(2)),
            free_length,
            load_w,
        }
    }

    /// Change of the span with its chord, its length, its load and its EA. The force at the exit point is S q − f.
    fn change(&self, chord: Vec3, longer: f64, load: Vec3, stiffness: f64) -> SpanChange {
        let force =
            self.by_chord * chord + self.by_free_length * longer + self.by_load * load + self.by_stiffness * stiffness;
        SpanChange { chord, force, longer, at_exit: self.load_w * longer + load * self.free_length - force }
    }
}

/// Derivatives of wrap, swivel angle and free length by the outer variables, from the conditions (65); `None` if these
/// do not determine them.
fn unknowns(
    conditions: &[Inner; 3],
    contact: Option<&PulleyContact>,
    of_unknowns: &[SpanChange; 3],
    of_variables: &[SpanChange; VARIABLES],
) -> Option<Matrix<3, VARIABLES>> {
    let mut matrix = Matrix::<3, 3>::zeros();
    let mut right = Matrix::<3, VARIABLES>::zeros();
    for (row, condition) in conditions.iter().enumerate() {
        let is_of_length = f64::from(u8::from(row == 2));
        let by_force = |change: &SpanChange| (0..3).map(|k| condition.by[FORCE + k] * change.at_exit[k]).sum::<f64>();
        for (j, change) in of_unknowns.iter().enumerate() {
            let own = match j {
                0 => condition.by[WRAP],
                1 => by_swivel(condition, contact),
                _ => change.longer * is_of_length,
            };
            matrix[(row, j)] = by_force(change) + own;
        }
        for (variable, change) in of_variables.iter().enumerate() {
            let own = match variable {
                REACH..LOAD => 0.0,
                LENGTH => -is_of_length,
                _ => condition.by[variable],
            };
            right[(row, variable)] = -(by_force(change) + own);
        }
    }

    // An unknown without effect stays where it is.
    let is_swivel_free = contact.is_some_and(|contact| contact.distance_from_axis() > ON_AXIS * contact.radius);
    for (unknown, is_free) in [(0, contact.is_some()), (1, is_swivel_free)] {
        if !is_free {
            matrix.row_mut(unknown).fill(0.0);
            matrix[(unknown, unknown)] = 1.0;
            right.row_mut(unknown).fill(0.0);
        }
    }
    matrix.lu().solve(&right)
}

/// Derivative by the swivel angle: the part of the rotation about the axis.
fn by_swivel(number: &Inner, contact: Option<&PulleyContact>) -> f64 {
    contact.map_or(0.0, |contact| (0..3).map(|k| number.by[TURN + k] * contact.axis_w[k]).sum())
}

/// Numbers of the end, in the order of [`end`].
fn end_numbers(given: &Given<Inner>, beyond: &Beyond<Inner>) -> [Inner; end::COUNT] {
    let wheel = given.wheel.as_ref();
    let along = || given.force_w.map(|component| component / beyond.tension);
    let travel_w = wheel.map_or_else(along, Wheel::exit_direction_w);
    let numbers = EndNumbers::at(&travel_w, &given.load_w, wheel, beyond);

    let mut all = [Inner::from(0.0); end::COUNT];
    all[end::TRAVEL..end::SIDEWAYS].copy_from_slice(&travel_w);
    all[end::STRETCH] = beyond.stretch;
    all[end::STRETCH_DRUM] = beyond.stretch_entry;
    all[end::ROPE_COMPLIANCE] = beyond.rope_compliance;
    all[end::DRUM_SIDE_COMPLIANCE] = beyond.drum_side_compliance;
    all[end::WEIGHT] = numbers.weight;
    all[end::TENSION_DRUM] = beyond.tension_entry;
    if let (Some(wheel), Some(sideways)) = (wheel, numbers.sideways) {
        all[end::SIDEWAYS..end::STRETCH].copy_from_slice(&wheel.sideways_w);
        all[end::COUPLING] = sideways.coupling;
        all[end::SIDEWAYS_STIFFNESS] = sideways.stiffness;
        all[end::DISTANCE] = sideways.distance;
    }
    all
}

/// Conditions (65) but for the free length: `n·N/T`, `(ν·N + (q·ν) M_a/c)/T`, and the unstrained length beyond the exit
/// point.
fn conditions(given: &Given<Inner>, beyond: &Beyond<Inner>, contact: Option<&PulleyContact>) -> [Inner; 3] {
    let zero = Inner::from(0.0);
    let mut all = [zero, zero, beyond.arc_length + beyond.drum_side_length];
    if let (Some(wheel), Some(contact)) = (&given.wheel, contact) {
        all[0] = dot(&wheel.exit_normal_w(), &given.force_w) / beyond.tension;
        all[1] = dot(&wheel.sideways_w, &given.force_w) / beyond.tension;
        if contact.distance_from_axis() > ON_AXIS * contact.radius {
            let (sine, _) = beyond.kink.sin_cos();
            all[1] = all[1] - sine;
        }
    }
    all
}

/// Derivatives of the chord of a straight cable, from the attachment to the exit point, by components: the direction in
/// which the wind sees the cable. By the outer variables `REACH`, `RADIUS` and `TURN`; the others have no effect.
/// `None` if the attachment is on the swivel axis.
///
/// # References
/// docs/theory.md, equations (61) to (63).
pub(crate) fn straight_chord(pulley: &Pulley, reach_w: &Vec3) -> Option<[OuterRow; 3]> {
    let contact = pulley.contact(&-reach_w);
    let wheel = turning(&contact);
    let offset = wheel.offset_w(wheel.wrap);

    // The chord is normal to n and to ν.
    let chord: [Inner; 3] = std::array::from_fn(|k| offset[k] + Inner::from(reach_w[k]));
    let normals = [wheel.exit_normal_w(), wheel.sideways_w];
    let mut matrix = Matrix::<2, 2>::zeros();
    let mut right = Matrix::<2, VARIABLES>::zeros();
    let swivel_by = |number: &Inner| by_swivel(number, Some(&contact));
    for (row, normal) in normals.iter().enumerate() {
        let condition = dot(normal, &chord);
        matrix[(row, 0)] = condition.by[WRAP];
        matrix[(row, 1)] = swivel_by(&condition);
        for variable in (REACH..LOAD).chain(RADIUS..DRUM_SIDE) {
            let by_reach = if variable < LOAD { normal[variable - REACH].value } else { 0.0 };
            right[(row, variable)] = -(condition.by[variable] + by_reach);
        }
    }
    let solved = matrix.lu().solve(&right)?;

    Some(std::array::from_fn(|k| {
        std::array::from_fn(|variable| {
            let own = match variable {
                REACH..LOAD => f64::from(u8::from(variable - REACH == k)),
                RADIUS..DRUM_SIDE => chord[k].by[variable],
                _ => 0.0,
            };
            own + chord[k].by[WRAP] * solved[(0, variable)] + swivel_by(&chord[k]) * solved[(1, variable)]
        })
    }))
}
