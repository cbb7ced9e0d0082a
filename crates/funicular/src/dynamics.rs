//! Robot linearised about a static equilibrium: stiffness at a frequency, mass, and the number of natural frequencies
//! below a frequency.

mod blocks;
mod complex_frequency;
mod count;
mod error;
mod min_stiffness;
mod null_vectors;
mod platform_frequency;
mod sheaves;
mod supports;

pub(crate) use blocks::{CableBlocks, CableRow, DrivePartBlock, PlatformBlocks, SupportBlocks};
pub(crate) use complex_frequency::DampedMotion;
pub use error::{DynamicsError, RunningRopeRefusal};
pub(crate) use null_vectors::NullVector;

use crate::cable::catenary_dynamic::{CatenaryDynamicEnd, EndSignal, Shapes};
use crate::cable::{CableModel, DynamicCable, EndStiffness, LocalAxes, LocalStiffness, NoStiffness, span_stiffness};
use crate::math::{CMat6, CVec6, Complex, Mat3, Mat6, Matrix6, Scalar, Vec3, Vec6, order};
use crate::platform::{Coordinates, add_congruent, add_lever_term, add_load_terms, damping_matrix, mass_matrix};
use crate::robot::{Damping, PlatformMotion, Robot, WinchMode};
use crate::statics::{CableState, Equilibrium};
pub(crate) use supports::Supports;
use supports::SupportsBuilder;

/// Relative distance of ω² to a pole of a catenary-dynamic cable below which the pole's mode is a separate unknown of
/// the matrices. Counts and modes are the same at 1e-2 and at 1e-6.
const NEAR_POLE_FRACTION: f64 = 1e-3;

/// Choice of the terms of the tangent stiffness.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Assembly {
    /// All terms: the cables' end stiffness and the geometric stiffness of static forces on their lever arms. Symmetric
    /// at an equilibrium.
    #[default]
    Consistent,
    /// Only the cables' end stiffness, as the paper's equation (11) prints it.
    WithoutGeometricStiffness,
}

impl Assembly {
    /// Both choices.
    pub const ALL: [Self; 2] = [Self::Consistent, Self::WithoutGeometricStiffness];

    /// Name in requests and results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Consistent => "consistent",
            Self::WithoutGeometricStiffness => "without-geometric-stiffness",
        }
    }
}

/// Choices of the linearisation: cable model, assembly, directions and winches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Linearisation {
    /// Model of the cables.
    pub cable_model: CableModel,
    /// Terms of the stiffness.
    pub assembly: Assembly,
    /// Leave out the stiffness of each cable out of its plane, as the paper does.
    pub in_plane_only: bool,
    /// Winches in vibration.
    pub winches: WinchMode,
}

/// Robot linearised about an equilibrium.
///
/// Scaled quantities act on `S x`, with rotations multiplied by ℓ, so that all units are N/m and kg. They are in the
/// platform's coordinates ([`PlatformMotion::reduced`]); entries beyond their number are zero.
#[derive(Debug, Clone)]
pub struct Dynamics {
    coordinates: Coordinates,
    /// Scaled stiffness that does not depend on frequency [N/m].
    constant: Mat6,
    /// Scaled mass of the platform [kg].
    mass: Mat6,
    /// Scaled viscous damping of the platform [N s/m].
    platform_damping: Mat6,
    terms: Vec<DynamicCableAt>,
    /// Flexible supports and ropes that run over sheaves; `None` without either.
    supports: Option<Box<Supports>>,
    /// Linearisation with which it was made.
    pub linearisation: Linearisation,
    /// Damping and mass per length [kg/m] of each cable.
    damping: Vec<(Damping, f64)>,
}

/// Cable whose stiffness depends on frequency, with its local axes as scaled 6-vectors (u; r × u/ℓ).
#[derive(Debug, Clone)]
pub(crate) struct DynamicCableAt {
    cable: usize,
    form: DynamicCable,
    along: Vec6,
    normal: Vec6,
    out: Vec6,
    /// Matrices that the entries of its [`LocalStiffness`] multiply: axial, coupling, normal, out of plane.
    products: [Mat6; 4],
}

impl DynamicCableAt {
    fn new(cable: usize, form: DynamicCable, [along, normal, out]: [Vec6; 3]) -> Self {
        let products = [
            along * along.transpose(),
            symmetric_product(&along, &normal),
            normal * normal.transpose(),
            out * out.transpose(),
        ];
        Self { cable, form, along, normal, out, products }
    }

    /// Index of the cable, in the order of the file.
    pub(crate) fn cable(&self) -> usize {
        self.cable
    }

    /// Dynamic stiffness of its end in local axes.
    pub(crate) fn form(&self) -> &DynamicCable {
        &self.form
    }

    /// Scaled 6-vectors of its axes (e, n, b). Their products with the platform's motion x are the displacement of the
    /// end.
    pub(crate) fn axes(&self) -> [&Vec6; 3] {
        [&self.along, &self.normal, &self.out]
    }

    /// Displacement (e, n, b) of the end for a scaled motion of the platform.
    fn displacement(&self, x: &Vec6) -> [f64; 3] {
        self.axes().map(|axis| axis.dot(x))
    }

    /// Scaled 6-vector of a direction (e, n, b).
    fn vector(&self, [e, n, b]: [f64; 3]) -> Vec6 {
        self.along * e + self.normal * n + self.out * b
    }
}

impl Dynamics {
    /// Linearises a robot about an equilibrium, for frequencies up to `up_to_hz` [Hz]. Catenary-dynamic cables are
    /// discretised as finely as these frequencies require; the other models do not use the number. If a rope is stiffer
    /// in vibration, robot and equilibrium are those of [`Equilibrium::with_dynamic_stiffness`].
    ///
    /// # Errors
    /// [`DynamicsError`] if a cable has no stiffness in the requested model.
    ///
    /// # References
    /// docs/theory.md, equations (13) to (16).
    pub fn about(
        robot: &Robot,
        equilibrium: &Equilibrium,
        linearisation: Linearisation,
        up_to_hz: f64,
    ) -> Result<Self, DynamicsError> {
        Self::with_shapes(robot, equilibrium, linearisation, up_to_hz, Shapes::Dropped)
    }

    /// Robot linearised as by [`about`](Self::about), with the shapes of the clamped modes along its catenary-dynamic
    /// cables. [`Gradients::vibration`](crate::gradient::Gradients::vibration) needs them, and otherwise computes all
    /// clamped modes a second time.
    ///
    /// # Errors
    /// The errors of [`about`](Self::about).
    pub fn for_gradients(
        robot: &Robot,
        equilibrium: &Equilibrium,
        linearisation: Linearisation,
        up_to_hz: f64,
    ) -> Result<Self, DynamicsError> {
        Self::with_shapes(robot, equilibrium, linearisation, up_to_hz, Shapes::Kept)
    }

    /// Robot linearised as by [`about`](Self::about), with the strains of all cables, which
    /// [`Mode::stretching_shares`](crate::modes::Mode::stretching_shares) need. They cost a little time. The
    /// shallow-dynamic model has none in its closed form.
    ///
    /// # Errors
    /// The errors of [`about`](Self::about).
    pub fn with_strains(
        robot: &Robot,
        equilibrium: &Equilibrium,
        linearisation: Linearisation,
        up_to_hz: f64,
    ) -> Result<Self, DynamicsError> {
        Self::with_shapes(robot, equilibrium, linearisation, up_to_hz, Shapes::Strains)
    }

    fn with_shapes(
        robot: &Robot,
        equilibrium: &Equilibrium,
        linearisation: Linearisation,
        up_to_hz: f64,
        shapes: Shapes,
    ) -> Result<Self, DynamicsError> {
        let Linearisation { cable_model, in_plane_only, winches, .. } = linearisation;
        let settled = equilibrium.settled(robot);
        Self::of_ends(robot, equilibrium, linearisation, |i, state| {
            EndStiffness::of_cable(&settled, (i, state), (cable_model, in_plane_only, winches), up_to_hz, shapes)
        })
    }

    /// Linearises a robot about an equilibrium with the end stiffness of each cable that `end` gives for its index and
    /// its state. A model of one's own needs nothing else: [`EndStiffness::Constant`], or poles and residues by
    /// [`CatenaryDynamicEnd::of_families`](crate::cable::catenary_dynamic::CatenaryDynamicEnd::of_families). The cable
    /// model of the linearisation then counts only for the static stiffness of cables on flexible supports.
    ///
    /// # Errors
    /// [`DynamicsError`] if a cable has no stiffness.
    pub fn of_ends(
        robot: &Robot,
        equilibrium: &Equilibrium,
        linearisation: Linearisation,
        end: impl Fn(usize, &CableState) -> Result<EndStiffness, NoStiffness>,
    ) -> Result<Self, DynamicsError> {
        let Linearisation { cable_model, assembly, .. } = linearisation;
        let coordinates = Coordinates::of(robot);
        refuse_two_stiffnesses(robot)?;
        refuse_on_supports(robot, linearisation)?;
        let settled = equilibrium.settled(robot);
        let is_coupled = robot.has_supports() || robot.has_running_ropes();
        let mut supports = is_coupled.then(|| SupportsBuilder::new(robot, &coordinates));

        // Cables: a constant stiffness is added to the matrix, the others become terms.
        let mut constant = Mat6::zeros();
        let mut terms = Vec::new();
        for (i, state) in equilibrium.cables.iter().enumerate() {
            let stiffness =
                end(i, state).map_err(|reason| DynamicsError::of_cable(&robot.cables[i].name, cable_model, reason))?;
            match stiffness {
                EndStiffness::Constant(k) => {
                    add_congruent(&mut constant, &k, &state.lever_w);
                    if let Some(supports) = &mut supports {
                        let held = span_stiffness(&settled, i, state, cable_model).unwrap_or(k);
                        supports.add_constant(i, state, &held);
                        supports.run_constant(i, state, &k);
                    }
                }
                EndStiffness::Dynamic(form) => {
                    if let Some(supports) = &mut supports {
                        supports.add_dynamic(i, state, &form);
                        supports.run_dynamic(i, state, &form)?;
                    }
                    let vector = |u: &Vec3| coordinates.reduce_force(u, &state.lever_w);
                    let LocalAxes { e, n, b } = *form.axes();
                    terms.push(DynamicCableAt::new(i, form, [vector(&e), vector(&n), vector(&b)]));
                }
            }
        }

        // Static forces on their lever arms.
        if assembly == Assembly::Consistent {
            constant += static_terms(&settled, equilibrium);
        }

        Ok(Self {
            coordinates,
            // Symmetric to rounding at an equilibrium; the methods below need exact symmetry.
            constant: coordinates.reduce_symmetric(&constant),
            mass: coordinates.reduce_matrix(&mass_matrix(&robot.platform, &equilibrium.pose)),
            platform_damping: coordinates.reduce_matrix(&damping_matrix(&robot.platform, &equilibrium.pose)),
            terms,
            supports: supports.map(|supports| Box::new(supports.finish())),
            linearisation,
            damping: robot.cables.iter().map(|c| (c.material.damping, c.material.mass_per_length)).collect(),
        })
    }

    /// Copy in which a few modes replace the clamped modes of catenary-dynamic cables from ω [rad/s] on. They represent
    /// the `signals` at the far ends of cables (index of the cable in the order of the file, signal), too.
    pub(crate) fn with_poles_below(&self, omega: f64, signals: &[(usize, EndSignal)]) -> Self {
        let mut cut = self.clone();
        for (t, term) in cut.terms.iter_mut().enumerate() {
            if let Some(end) = term.form.by_poles_mut() {
                let mut own: Vec<EndSignal> =
                    signals.iter().filter(|(cable, _)| *cable == term.cable).map(|(_, signal)| *signal).collect();
                // A flexible support moves the far end, too.
                let carrier = self.supports().and_then(|supports| supports.carrier_motions(t));
                own.extend(carrier.into_iter().flat_map(|(_, motions)| motions).map(EndSignal::Carrier));
                *end = end.with_poles_below(omega * omega, &own);
            }
        }
        if let Some(supports) = &mut cut.supports {
            **supports = supports.with_cables(&cut.terms);
        }
        cut
    }

    /// True if a cable with mass or a flexible support has a constant damping ratio, or a rope a constant loss factor.
    pub(crate) fn has_damping_ratios(&self) -> bool {
        let has_loss_factor = |end: &CatenaryDynamicEnd| end.has_drive_losses() && end.stretch_loss.factor > 0.0;
        let has_loss_factors = self.terms.iter().any(|term| term.form.by_poles().is_some_and(has_loss_factor));
        has_loss_factors
            || self.terms.iter().any(|term| matches!(self.damping[term.cable].0, Damping::Ratio(xi) if xi > 0.0))
            || self.supports().is_some_and(Supports::has_losses)
    }

    /// Number of degrees of freedom of the platform.
    pub fn dof(&self) -> usize {
        self.coordinates.count()
    }

    /// Coordinates of the platform, with the length ℓ.
    pub(crate) fn coordinates(&self) -> &Coordinates {
        &self.coordinates
    }

    /// Number of cables, including those without mass.
    pub(crate) fn cable_count(&self) -> usize {
        self.damping.len()
    }

    /// Cables whose stiffness depends on frequency.
    pub(crate) fn terms(&self) -> &[DynamicCableAt] {
        &self.terms
    }

    /// Scaled stiffness that does not depend on frequency [N/m]: static forces on their lever arms, cables without
    /// mass.
    pub(crate) fn constant_stiffness(&self) -> &Mat6 {
        &self.constant
    }

    /// Scaled mass of the platform [kg].
    pub(crate) fn platform_mass(&self) -> &Mat6 {
        &self.mass
    }

    /// Scaled viscous damping of the platform [N s/m].
    pub(crate) fn platform_damping(&self) -> &Mat6 {
        &self.platform_damping
    }

    /// Complex 6×6 stiffness with all damping at ω [rad/s], about the platform origin, world axes [N/m, N, N·m]. It is
    /// zero for motions that the platform does not have.
    pub fn stiffness(&self, omega: f64) -> CMat6 {
        self.unscaled(&self.scaled_stiffness(omega))
    }

    /// Mass matrix about the platform origin, world axes, 6×6 [kg, kg m, kg m²].
    pub fn mass(&self) -> Mat6 {
        let (scale, mass) = (self.scale(), self.coordinates.motion().expanded_matrix(&self.mass));
        Mat6::from_fn(|i, j| mass[(i, j)] * scale[i] * scale[j])
    }

    /// Factors from scaled forces to wrench components: 1 for forces, ℓ for moments.
    pub(crate) fn scale(&self) -> [f64; 6] {
        let ell = self.coordinates.ell();
        [1.0, 1.0, 1.0, ell, ell, ell]
    }

    /// Factors of the platform's coordinates: 1 for translations, ℓ for rotations.
    fn coordinate_scale(&self) -> [f64; 6] {
        std::array::from_fn(|k| if self.coordinates.motion().is_rotation(k) { self.coordinates.ell() } else { 1.0 })
    }

    /// Expands a matrix over the platform's coordinates to motions in world axes; the result is still scaled.
    pub(crate) fn expanded(&self, matrix: &CMat6) -> CMat6 {
        let motion = self.coordinates.motion();
        match motion {
            PlatformMotion::Rigid | PlatformMotion::PointMass => *matrix,
            PlatformMotion::Planar(_) => {
                let [re, im] = [matrix.map(|z| z.re), matrix.map(|z| z.im)].map(|real| motion.expanded_matrix(&real));
                re.zip_map(&im, Complex::new)
            }
        }
    }

    /// Vector about the platform origin, world axes [N, N·m], of a scaled one over the platform's coordinates.
    pub(crate) fn unscaled_vector(&self, vector: &CVec6) -> CVec6 {
        let scale = self.scale();
        let expanded =
            |part: fn(&Complex) -> f64| self.coordinates.motion().expanded(&vector.map(|entry| part(&entry)));
        let (re, im) = (expanded(|entry| entry.re), expanded(|entry| entry.im));
        CVec6::from_fn(|i, _| Complex::new(re[i], im[i]) * scale[i])
    }

    /// Matrix over motions in world axes [m, rad] of a scaled one over the platform's coordinates.
    fn unscaled(&self, matrix: &CMat6) -> CMat6 {
        let (scale, matrix) = (self.scale(), self.expanded(matrix));
        CMat6::from_fn(|i, j| matrix[(i, j)] * (scale[i] * scale[j]))
    }

    /// Scaled stiffness with all damping, `K(ω) + iωC` [N/m].
    fn scaled_stiffness(&self, omega: f64) -> CMat6 {
        let mut total = self.constant.zip_map(&self.platform_damping, |k, c| Complex::new(k, omega * c));
        for term in &self.terms {
            let k = term.form.damped(omega);
            add_local(&mut total, term, &k);
        }
        match &self.supports {
            Some(supports) => total - self.damped_loss(supports, omega),
            None => total,
        }
    }

    /// Scaled dynamic stiffness with all damping, `D = K(ω) + iωC − ω²M` [N/m].
    pub(crate) fn damped_dynamic_stiffness(&self, omega: f64) -> CMat6 {
        self.scaled_stiffness(omega) - self.mass.map(|m| Complex::new(m * omega * omega, 0.0))
    }

    /// Scaled undamped dynamic stiffness `D = K(ω) − ω²M` [N/m].
    pub(crate) fn dynamic_stiffness(&self, omega: f64) -> Mat6 {
        let mut total = self.constant - self.mass * (omega * omega);
        for term in &self.terms {
            add_local(&mut total, term, &term.form.undamped(omega));
        }
        match &self.supports {
            Some(supports) => total - self.undamped_loss(supports, omega),
            None => total,
        }
    }

    /// Number with the sign of the determinant of the undamped dynamic stiffness at ω [rad/s], supports included.
    pub(crate) fn determinant(&self, omega: f64) -> f64 {
        if let Some(supports) = &self.supports {
            return self.determinant_with_supports(supports, omega);
        }
        let d = self.dynamic_stiffness(omega);
        // By elimination: in the expansion of a 3×3 determinant the squares of a pole's large term cancel, which loses
        // the sign.
        if self.dof() == 6 { d.determinant() } else { d.fixed_view::<3, 3>(0, 0).clone_owned().lu().determinant() }
    }

    /// Scaled moving mass of the platform, and of each cable (`−dK/dω²`), for the scaled motion `x` of the platform
    /// [kg].
    pub(crate) fn effective_masses(&self, omega: f64, x: &Vec6) -> (f64, Vec<f64>) {
        let platform = x.dot(&(self.mass * x));
        let mut cables = vec![0.0; self.cable_count()];
        for term in &self.terms {
            let m = term.form.effective_mass(omega);
            let [a, n, b] = term.displacement(x);
            cables[term.cable] = m.axial * a * a
                + 2.0 * m.coupling * a * n
                + m.normal * n * n
                + m.out_of_plane * b * b
                + 2.0 * (m.across[0] * a + m.across[1] * n) * b;
        }
        (platform, cables)
    }

    /// Viscous damping of the platform along a scaled motion x, `xᵀCx` [N s/m].
    pub(crate) fn platform_damping_along(&self, x: &Vec6) -> f64 {
        x.dot(&(self.platform_damping * x))
    }

    /// Damping ratio of a vibration of cable `i` alone, at ω [rad/s].
    pub(crate) fn cable_damping_ratio(&self, i: usize, omega: f64) -> f64 {
        let (damping, mass_per_length) = self.damping[i];
        damping.ratio_at(omega, mass_per_length)
    }

    /// Square of the complex frequency of cable `i`, `ω_c²` [rad²/s²], at ω [rad/s].
    pub(crate) fn cable_square(&self, i: usize, omega: f64) -> Complex {
        let (damping, mass_per_length) = self.damping[i];
        let (re, im) = damping.square(omega, mass_per_length);
        Complex::new(re, im)
    }

    /// Complex frequency ω [rad/s] at which cable `i` vibrates alone, from its undamped frequency, with its damping
    /// multiplied by `losses`.
    pub(crate) fn cable_zero(&self, i: usize, undamped: f64, losses: f64) -> Complex {
        let (damping, mass_per_length) = self.damping[i];
        damping.times(losses).zero(undamped, mass_per_length)
    }

    /// True if the control of a motor has a delay.
    pub(crate) fn has_delays(&self) -> bool {
        self.terms.iter().any(|term| term.form.by_poles().is_some_and(CatenaryDynamicEnd::has_delay))
    }

    /// True if a drive adds mass or losses to cable `i` that do not share the damping of the cable.
    pub(crate) fn has_drive_losses(&self, i: usize) -> bool {
        self.terms
            .iter()
            .any(|term| term.cable == i && term.form.by_poles().is_some_and(CatenaryDynamicEnd::has_drive_losses))
    }

    /// True if the model has no inertia of cable `i`.
    pub(crate) fn is_at_rest(&self, i: usize) -> bool {
        let vibrates = |form: &DynamicCable| form.by_poles().is_none_or(|end| !end.is_at_rest);
        !self.terms.iter().any(|term| term.cable == i && vibrates(&term.form))
    }

    /// Mass per length of cable `i` in its model [kg/m]: zero if its stiffness does not depend on frequency.
    pub(crate) fn moving_mass_per_length(&self, i: usize) -> f64 {
        if self.is_at_rest(i) { 0.0 } else { self.damping[i].1 }
    }

    /// True if every catenary-dynamic cable is resolved up to ω [rad/s], with an estimated error of its clamped
    /// frequencies of at most 1e-9. Also true for the models that are not discretised.
    pub fn resolves(&self, omega: f64) -> bool {
        // Conversions to Hz and back leave rounding errors of the limit.
        let is_resolved =
            |end: &CatenaryDynamicEnd| omega <= end.cable.limit * (1.0 + 1e-12) && end.cable.error <= RESOLUTION;
        self.terms.iter().all(|term| term.form.by_poles().is_none_or(is_resolved))
    }

    /// Clamped-clamped frequencies of all cables below ω [rad/s]: (frequency, cable), ascending, with multiplicity.
    pub fn clamped_frequencies_below(&self, omega: f64) -> Vec<(f64, usize)> {
        let mut all: Vec<(f64, usize)> = self
            .terms
            .iter()
            .flat_map(|t| t.form.clamped_frequencies_below(omega).into_iter().map(|f| (f, t.cable)))
            .collect();
        order::sort_ascending(&mut all, |(omega, _)| *omega);
        all
    }
}

pub(crate) fn refuse_two_stiffnesses(robot: &Robot) -> Result<(), DynamicsError> {
    let mut ropes = robot.cables.iter().map(|cable| &cable.material);
    match ropes.find(|rope| rope.dynamic_axial_stiffness.is_some()) {
        Some(rope) => Err(DynamicsError::TwoStiffnesses { rope: rope.name.clone() }),
        None => Ok(()),
    }
}

/// Refuses motion in plane alone for a robot with anchors on flexible supports or ropes that run over sheaves.
fn refuse_on_supports(robot: &Robot, linearisation: Linearisation) -> Result<(), DynamicsError> {
    if let Some(rope) = robot.ropes.iter().find(|rope| linearisation.in_plane_only && !rope.running_parts().is_empty())
    {
        let cable = robot.cables[rope.cables[0]].name.clone();
        return Err(DynamicsError::RunningRope { cable, reason: RunningRopeRefusal::InPlaneOnly });
    }
    let Some(cable) = robot.cables.iter().find(|cable| cable.anchor.support.is_some()) else { return Ok(()) };
    if linearisation.in_plane_only {
        return Err(DynamicsError::Support { cable: cable.name.clone() });
    }
    Ok(())
}

/// Estimated relative error of the clamped frequencies up to which a catenary-dynamic cable counts as resolved.
const RESOLUTION: f64 = 1e-9;

/// `p qᵀ + q pᵀ`.
fn symmetric_product(p: &Vec6, q: &Vec6) -> Mat6 {
    p * q.transpose() + q * p.transpose()
}

/// Adds the stiffness of a cable in local axes.
fn add_local<T>(total: &mut Matrix6<T>, term: &DynamicCableAt, k: &LocalStiffness<T>)
where
    T: Copy + Default + std::ops::AddAssign + std::ops::Mul<f64, Output = T> + Scalar,
{
    let LocalStiffness { axial, coupling, normal, out_of_plane, across } = *k;
    let [by_axial, by_coupling, by_normal, by_out_of_plane] = &term.products;
    for (n, entry) in total.iter_mut().enumerate() {
        *entry += axial * by_axial[n];
        *entry += coupling * by_coupling[n];
        *entry += normal * by_normal[n];
        *entry += out_of_plane * by_out_of_plane[n];
    }

    // Most cables couple no motion out of plane.
    if across == [T::default(); 2] {
        return;
    }
    for (k, axis) in across.iter().zip([&term.along, &term.normal]) {
        let by_axis = symmetric_product(axis, &term.out);
        total.iter_mut().zip(by_axis.iter()).for_each(|(entry, product)| *entry += *k * *product);
    }
}

/// Geometric stiffness: static forces of cables and loads, whose lever arms turn with the platform; not scaled.
fn static_terms(robot: &Robot, equilibrium: &Equilibrium) -> Mat6 {
    let mut terms = Mat6::zeros();
    for state in &equilibrium.cables {
        add_lever_term(&mut terms, &state.force_on_platform_w, &state.lever_w);
    }
    add_load_terms(&mut terms, robot, &equilibrium.pose);
    terms
}

/// Terms of the linearised robot without the end stiffness of its cables; scaled, in the platform's coordinates.
pub(crate) struct PlatformTerms {
    /// Geometric stiffness of static forces on their lever arms [N/m].
    pub(crate) constant: Mat6,
    /// Mass of the platform [kg].
    pub(crate) mass: Mat6,
    pub(crate) coordinates: Coordinates,
}

/// Terms of a robot at an equilibrium that do not depend on the model of its cables.
pub(crate) fn platform_terms(robot: &Robot, equilibrium: &Equilibrium) -> PlatformTerms {
    let coordinates = Coordinates::of(robot);
    let constant = coordinates.reduce_symmetric(&static_terms(robot, equilibrium));
    let mass = coordinates.reduce_matrix(&mass_matrix(&robot.platform, &equilibrium.pose));
    PlatformTerms { constant, mass, coordinates }
}

/// Viscous damping of the platform at an equilibrium; scaled, in the platform's coordinates [N s/m].
pub(crate) fn platform_damping(robot: &Robot, equilibrium: &Equilibrium) -> Mat6 {
    Coordinates::of(robot).reduce_matrix(&damping_matrix(&robot.platform, &equilibrium.pose))
}

/// Stiffness of a cable whose end stiffness [N/m] does not depend on frequency; scaled, in the platform's coordinates.
pub(crate) fn constant_cable(robot: &Robot, state: &CableState, stiffness: &Mat3) -> Mat6 {
    let mut total = Mat6::zeros();
    add_congruent(&mut total, stiffness, &state.lever_w);
    Coordinates::of(robot).reduce_matrix(&total)
}
