//! Quadratic form of one cable over two motions of the robot, and its coefficients over the state of the cable.
//!
//! `W(a, b) = ∫ δp_a'ᵀ C δp_b' − ω_c² m ∫ δp_aᵀ δp_b` is stationary in the motions inside the cable, so only the numbers
//! of the cable and its ends count. With the change δN = C δp' of the tension vector and the third derivative κ of |N|
//! every coefficient is an integral along the cable (docs/theory.md, equation (60a)).

mod length_rate;

use super::GradientError;
use super::adjoint::CableAdjoint;
use super::scalar::{Field, Vector, add, add_times, cross, dot, times, vector};
use crate::cable::catenary_dynamic::{CatenaryDynamic, CatenaryDynamicEnd, PoleResidue, Stations, smooth_pieces};
use crate::catenary::space::HangingCable;
use crate::math::{DMat, Vec3, legendre};
use crate::statics::CableState;
use crate::statics::derivatives::StaticDerivativeError;
use std::array::from_fn;
use std::ops::Range;

/// Natural logarithm of the accuracy of integrals of the tension alone along a cable at rest: 1e-14.
const DIGITS_OF_REST: f64 = 32.0;

/// Points of the Gauss rule beyond the degree of an element, as in the elements themselves.
const POINTS_FOR_TENSION: usize = 10;

/// Cable about its equilibrium, with what the form needs of it.
pub(super) struct CableForm {
    /// Horizontal, up, out of plane.
    axes_w: [Vec3; 3],
    lever_w: Vec3,
    length: f64,
    axial_stiffness: f64,
    mass_per_length: f64,
    /// Static stiffness of the platform end in the axes: hh, hv, vv, and out of plane [N/m].
    stiffness: [f64; 4],
    /// Load per length, up [N/m]; negative.
    load: f64,
    points: Vec<Point>,
    /// Elements as ranges of points, each with half its length [m] and the number of its rule.
    elements: Vec<(Range<usize>, f64, usize)>,
    /// Integrals over [−1, ξ] from the values at the points of a rule, by rows; one matrix per size.
    rules: Vec<DMat>,
    inertia: Inertia,
}

/// Motion of the points of a cable.
enum Inertia {
    /// None: the model has no inertia of the cable.
    None,
    /// Slow motion: the cable has no mass, but may get some.
    Massless,
    /// Vibration by clamped modes.
    Modes(Box<CatenaryDynamic>, Stations),
}

/// Point of the integrals along a cable.
struct Point {
    /// Fraction σ of the unstrained length from the platform end.
    fraction: f64,
    /// Weight in unstrained length [m].
    weight: f64,
    /// Direction of the tension vector in plane.
    direction: [f64; 2],
    /// Tension [N].
    tension: f64,
}

/// Motion of a cable in the axes (horizontal, up, out of plane).
pub(super) struct CableMotion<T> {
    /// Displacement at each point; empty for a cable without inertia.
    displacement: Vec<Vector<T>>,
    /// Change of the tension vector at each point [N].
    tension: Vec<Vector<T>>,
    /// Force that moves the platform end, world axes [N].
    end_force_w: Vector<T>,
    /// Rotation of the platform, world axes.
    theta: Vector<T>,
}

impl CableForm {
    /// Cable with the static end stiffness of its catenary. `may_have_mass` for a massless cable in a model with inertia.
    pub(super) fn at_rest(state: &CableState, may_have_mass: bool) -> Result<Self, GradientError> {
        let catenary = hanging(state)?.catenary;
        let pieces = smooth_pieces(&catenary, vec![(0.0, catenary.rope().unstrained_length)]);
        let count = |size: f64| (DIGITS_OF_REST / (2.0 * size.ln())).ceil() as usize + 4;
        let sizes: Vec<usize> = pieces.iter().map(|(_, _, size)| count(*size)).collect();
        let inertia = if may_have_mass { Inertia::Massless } else { Inertia::None };
        Self::on_pieces(state, 0.0, &pieces, &sizes, inertia)
    }

    /// Cable that vibrates about its catenary.
    pub(super) fn vibrating(state: &CableState, end: &CatenaryDynamicEnd, name: &str) -> Result<Self, GradientError> {
        let catenary = hanging(state)?.catenary;
        let pieces = smooth_pieces(&catenary, vec![(0.0, catenary.rope().unstrained_length)]);
        let sizes: Vec<usize> = end.cable.degrees.iter().map(|degree| degree + POINTS_FOR_TENSION).collect();
        let mut form = Self::on_pieces(state, end.mass_per_length, &pieces, &sizes, Inertia::None)?;

        let arc_lengths = form.points.iter().map(|point| point.fraction * form.length).collect();
        let (m, limit) = (end.mass_per_length, end.cable.limit);
        let (cable, stations) = CatenaryDynamic::with_stations(&catenary, None, m, limit, arc_lengths, false)
            .map_err(|reason| GradientError::CatenaryDynamic { cable: name.to_owned(), reason })?;
        form.inertia = Inertia::Modes(Box::new(cable), stations);
        Ok(form)
    }

    /// Points on the pieces of a cable, for Gauss rules of these sizes.
    fn on_pieces(
        state: &CableState,
        mass_per_length: f64,
        pieces: &[(f64, f64, f64)],
        sizes: &[usize],
        inertia: Inertia,
    ) -> Result<Self, GradientError> {
        let hanging = hanging(state)?;
        let (catenary, (horizontal_w, up_w)) = (&hanging.catenary, hanging.axes_w());
        let rope = catenary.rope();
        let (h, at_start) = (catenary.horizontal_force(), catenary.vertical_force_at_start());

        let mut of_size: Vec<(usize, Vec<(f64, f64)>)> = Vec::new();
        let mut points: Vec<Point> = Vec::with_capacity(sizes.iter().sum());
        let mut elements = Vec::with_capacity(pieces.len());
        for ((from, to, _), size) in pieces.iter().zip(sizes) {
            let known = of_size.iter().position(|(known, _)| known == size);
            let rule = known.unwrap_or_else(|| {
                of_size.push((*size, legendre::gauss(*size)));
                of_size.len() - 1
            });
            let (center, half) = (0.5 * (from + to), 0.5 * (to - from));
            elements.push((points.len()..points.len() + size, half, rule));
            for (xi, weight) in &of_size[rule].1 {
                let s = center + half * xi;
                let v = at_start + rope.weight_per_length * s;
                let tension = h.hypot(v);
                points.push(Point {
                    fraction: s / rope.unstrained_length,
                    weight: weight * half,
                    direction: [h / tension, v / tension],
                    tension,
                });
            }
        }

        let [[hh, hv], [_, vv]] = catenary.tangent();
        Ok(Self {
            axes_w: [horizontal_w, up_w, horizontal_w.cross(&up_w)],
            lever_w: state.lever_w,
            length: rope.unstrained_length,
            axial_stiffness: rope.axial_stiffness,
            mass_per_length,
            stiffness: [hh, hv, vv, catenary.out_of_plane_stiffness()],
            load: -rope.weight_per_length,
            points,
            elements,
            rules: of_size.iter().map(|(_, rule)| integrals(rule)).collect(),
            inertia,
        })
    }

    /// Motion with the platform (translation of its origin and rotation, world axes) at the square ω_c² of the cable's
    /// complex frequency. `near` are amplitudes that do not follow from the end: index of the clamped mode, in plane or
    /// out of plane, amplitude.
    pub(super) fn motion<T: Field>(
        &self,
        v: &Vector<T>,
        theta: &Vector<T>,
        square: T,
        near: &[(bool, usize, T)],
    ) -> CableMotion<T> {
        let end_w = add(v, &cross(theta, &vector(&self.lever_w)));
        let end: Vector<T> = from_fn(|k| dot(&end_w, &vector(&self.axes_w[k])));

        let Inertia::Modes(cable, stations) = &self.inertia else {
            // Without mass the tension vector changes by the same amount all along the cable.
            let force = self.static_force(&end);
            let tension = vec![times(&force, T::from(-1.0)); self.points.len()];
            let displacement = match self.inertia {
                Inertia::Massless => {
                    let strains: Vec<Vector<T>> =
                        self.points.iter().zip(&tension).map(|(point, change)| self.strain(point, change)).collect();
                    self.gathered(&strains).iter().map(|moved| add(&end, moved)).collect()
                }
                _ => Vec::new(),
            };
            return CableMotion { displacement, tension, end_force_w: self.world(&force), theta: *theta };
        };

        // Momentum: δN(s) = δN(0) − ω_c² m ∫₀ˢ δp ds.
        let displacement = displacement(cable, stations, &end, square, near);
        let mut gathered = self.gathered(&displacement);
        let factor = -(square * self.mass_per_length);
        for sum in &mut gathered {
            *sum = times(sum, factor);
        }

        // The anchor is held: the strains of δN along the cable add up to −a, where a is the motion of the platform end.
        let mut moved = end;
        for (point, gathered) in self.points.iter().zip(&gathered) {
            add_times(&mut moved, &self.strain(point, gathered), T::from(point.weight));
        }
        let force = self.static_force(&moved);
        let tension = gathered.iter().map(|gathered| from_fn(|k| gathered[k] - force[k])).collect();
        CableMotion { displacement, tension, end_force_w: self.world(&force), theta: *theta }
    }

    /// Adds `factor` times the coefficients of W(a, b); `damping` has the derivatives of ω_c² by mass per length and by
    /// damping.
    pub(super) fn add<T: Field>(
        &self,
        sum: &mut CableAdjoint<T>,
        a: &CableMotion<T>,
        b: &CableMotion<T>,
        square: T,
        damping: [T; 2],
        factor: T,
    ) {
        let zero = T::default();
        let (mut by_force, mut by_load) = ([zero; 3], [zero; 3]);
        let (mut squares, mut work) = (zero, zero);
        for ((point, u), w) in self.points.iter().zip(&a.tension).zip(&b.tension) {
            // Third derivative of |N| along both changes.
            let [h, v] = point.direction;
            let (along_u, along_w) = (u[0] * h + u[1] * v, w[0] * h + w[1] * v);
            let across_u = [u[0] - along_u * h, u[1] - along_u * v, u[2]];
            let across_w = [w[0] - along_w * h, w[1] - along_w * v, w[2]];
            let product = dot(&across_u, &across_w);
            let size = point.weight / (point.tension * point.tension);
            let mut third: Vector<T> = from_fn(|k| across_w[k] * along_u + across_u[k] * along_w);
            third[0] += product * h;
            third[1] += product * v;
            for k in 0..3 {
                let value = third[k] * size;
                by_force[k] += value;
                by_load[k] += value * point.fraction;
            }

            let both = product + along_u * along_w;
            squares += both * point.weight;
            work += (both * (1.0 / self.axial_stiffness) + product * (1.0 / point.tension)) * point.weight;
        }
        let mut moved = zero;
        for ((point, u), w) in self.points.iter().zip(&a.displacement).zip(&b.displacement) {
            moved += dot(u, w) * point.weight;
        }

        let (force_w, load_w) = (self.world(&by_force), self.world(&by_load));
        add_times(&mut sum.force, &force_w, factor);
        add_times(&mut sum.load, &load_w, -(factor * self.length));
        let inertia = square * moved;
        let strained = (work + inertia * self.mass_per_length) * (1.0 / self.length);
        sum.length += -(factor * (by_load[1] * self.load + strained));
        sum.stiffness += factor * squares * self.axial_stiffness.powi(-2);
        let by_square = -(factor * moved * self.mass_per_length);
        sum.mass += by_square * damping[0] - factor * inertia;
        sum.damping += by_square * damping[1];

        // The ends turn with their lever arms.
        let turned = add(&cross(&a.end_force_w, &b.theta), &cross(&b.end_force_w, &a.theta));
        add_times(&mut sum.lever, &turned, factor);
    }

    /// Strain δp' of a change of the tension vector at a point.
    fn strain<T: Field>(&self, point: &Point, change: &Vector<T>) -> Vector<T> {
        let [h, v] = point.direction;
        let along = change[0] * h + change[1] * v;
        let (by_stretch, by_turn) = (1.0 / self.axial_stiffness, 1.0 / point.tension);
        let both = by_stretch + by_turn;
        [change[0] * both - along * (h * by_turn), change[1] * both - along * (v * by_turn), change[2] * both]
    }

    /// Integrals of a vector from the platform end to every point [m].
    fn gathered<T: Field>(&self, values: &[Vector<T>]) -> Vec<Vector<T>> {
        let mut sums = vec![[T::default(); 3]; values.len()];
        let mut before = [T::default(); 3];
        for (range, half, rule) in &self.elements {
            let matrix = &self.rules[*rule];
            let (sums, values) = (&mut sums[range.clone()], &values[range.clone()]);
            sums.fill(before);
            for (column, value) in matrix.column_iter().zip(values) {
                let value = times(value, T::from(*half));
                let (inner, last) = (column.iter().take(values.len()), column[values.len()]);
                for (sum, entry) in sums.iter_mut().zip(inner) {
                    for k in 0..3 {
                        sum[k] += value[k] * *entry;
                    }
                }
                add_times(&mut before, &value, T::from(last));
            }
        }
        sums
    }

    /// Force that moves the platform end slowly, in the axes of the cable.
    fn static_force<T: Field>(&self, end: &Vector<T>) -> Vector<T> {
        let [hh, hv, vv, out] = self.stiffness;
        [end[0] * hh + end[1] * hv, end[0] * hv + end[1] * vv, end[2] * out]
    }

    /// World components of a vector in the axes of the cable.
    fn world<T: Field>(&self, local: &Vector<T>) -> Vector<T> {
        from_fn(|k| local[0] * self.axes_w[0][k] + local[1] * self.axes_w[1][k] + local[2] * self.axes_w[2][k])
    }
}

/// Displacement of the points for a motion of the platform end.
fn displacement<T: Field>(
    cable: &CatenaryDynamic,
    stations: &Stations,
    end: &Vector<T>,
    square: T,
    near: &[(bool, usize, T)],
) -> Vec<Vector<T>> {
    let in_plane = amplitudes(&cable.in_plane, &[end[0], end[1]], square, near, true);
    let out_of_plane = amplitudes(&cable.out_of_plane, &[end[2]], square, near, false);

    let (of_plane, of_normal) = (&stations.in_plane, &stations.out_of_plane);
    let mut displacement: Vec<Vector<T>> = (of_plane.still.iter().zip(&of_normal.still))
        .map(|(plane, normal)| {
            [
                end[0] * plane[0][0] + end[1] * plane[0][1],
                end[0] * plane[1][0] + end[1] * plane[1][1],
                end[2] * normal[0][0],
            ]
        })
        .collect();
    for (mode, q) in of_plane.modes.iter().zip(&in_plane) {
        for (sum, [h, v]) in displacement.iter_mut().zip(mode) {
            sum[0] += *q * *h;
            sum[1] += *q * *v;
        }
    }
    for (mode, q) in of_normal.modes.iter().zip(&out_of_plane) {
        for (sum, [b]) in displacement.iter_mut().zip(mode) {
            sum[2] += *q * *b;
        }
    }
    displacement
}

/// Curve of the cable; ideal cables have none.
fn hanging(state: &CableState) -> Result<&HangingCable, GradientError> {
    Ok(state.hanging.as_ref().ok_or(StaticDerivativeError::Ideal)?)
}

/// Amplitudes of the clamped modes (unit modal mass) for a motion of the platform end, `q_k = ω_c² g_k·u/(ω_k² − ω_c²)`.
/// Those of `near` modes are given.
fn amplitudes<T: Field, const N: usize, const E: usize, const M: usize>(
    family: &PoleResidue<N, E>,
    end: &[T; M],
    square: T,
    near: &[(bool, usize, T)],
    is_in_plane: bool,
) -> Vec<T> {
    let mut all: Vec<T> = (family.poles.iter().zip(&family.participation))
        .map(|(pole, g)| {
            let mut drive = T::default();
            for (u, g) in end.iter().zip(g) {
                drive += *u * *g;
            }
            square * drive / (T::from(*pole) - square)
        })
        .collect();
    for (_, index, amplitude) in near.iter().filter(|(in_plane, ..)| *in_plane == is_in_plane) {
        all[*index] = *amplitude;
    }
    all
}

/// Integrals over [−1, ξ] at the points of a Gauss rule from values there, by rows; the last row is the integral over
/// [−1, 1].
fn integrals(rule: &[(f64, f64)]) -> DMat {
    let count = rule.len();
    // Orthonormal polynomials at the points, and their integrals: of P_k it is (P_{k+1} − P_{k−1})/(2k + 1).
    let at_points: Vec<Vec<f64>> = rule.iter().map(|(xi, _)| legendre::orthonormal(*xi, count)).collect();
    let plain = |values: &[f64], k: usize| values[k] / (k as f64 + 0.5).sqrt();
    let primitive = |values: &[f64], k: usize| {
        let below = if k == 0 { -1.0 } else { plain(values, k - 1) };
        (plain(values, k + 1) - below) / (2.0 * k as f64 + 1.0) * (k as f64 + 0.5).sqrt()
    };
    let primitives = DMat::from_fn(count, count, |i, k| primitive(&at_points[i], k));
    let expansion = DMat::from_fn(count, count, |k, j| rule[j].1 * at_points[j][k]);
    let inner = primitives * expansion;
    DMat::from_fn(count + 1, count, |i, j| if i < count { inner[(i, j)] } else { rule[j].1 })
}
