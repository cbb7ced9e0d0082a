//! Dynamic stiffness of a cable between its platform end and an anchor that moves with a flexible support.
//!
//! The seven motions are those of the platform end and of the exit point, both in (e, n, b), and the motion of the
//! entry point along the drum side: it stretches a drum side whose drum stays on the ground, and carries one along
//! whose drum moves with the support. For that motion a clamped mode has the participation `μ − κ/ω_k²`, κ and μ being
//! its work on the stiffness and the mass between drum side and drive (docs/theory.md, equation (93)).

use super::{CatenaryDynamic, CatenaryDynamicEnd, DriveMotion, Family, InternalMotion, NearRanges, PoleResidue};
use crate::math::{Complex, DMat};

/// Number of motions at the ends.
pub(crate) const ENDS: usize = 7;

/// Motion of the entry point along the drum side.
const ALONG: usize = 6;

/// Stiffness of a cable over the motions of both ends by poles and residues.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TwoEnded {
    stiffness: [[f64; ENDS]; ENDS],
    mass: [[f64; ENDS]; ENDS],
    modes: Vec<TwoEndedMode>,
    /// Static motion of each part of the drive per motion of the ends.
    still: Vec<[f64; ENDS]>,
}

/// Clamped mode of a cable.
#[derive(Debug, Clone, PartialEq)]
struct TwoEndedMode {
    family: Family,
    /// Index among the poles of the family.
    index: usize,
    /// ω_k² [rad²/s²].
    pole: f64,
    participation: [f64; ENDS],
    /// κ and μ: its work on stiffness and mass between drum side and drive.
    on_drum_side: (f64, f64),
    /// Motions of the drive [1/√kg].
    drive: Vec<f64>,
}

/// Value of a matrix over the motions of the ends, and its derivative.
pub(crate) type EndMatrix = ([[Complex; ENDS]; ENDS], [[Complex; ENDS]; ENDS]);

impl TwoEnded {
    /// Both ends of a cable. `from_ground` is true if its drum stays on the ground.
    pub(crate) fn new(end: &CatenaryDynamicEnd, from_ground: bool) -> Self {
        let mut both =
            Self { stiffness: [[0.0; ENDS]; ENDS], mass: [[0.0; ENDS]; ENDS], modes: Vec::new(), still: Vec::new() };

        // The families.
        let ((_, along), all) = (end.motions_along(), end.motions());
        both.still = vec![[0.0; ENDS]; end.motions()];
        let drive = end.cable.drive.as_ref();
        if let Some(family) = end.coupled() {
            let rows = drive.map(|drive| (0, &drive.coupled.still[..all]));
            both.add(family, [0, 1, 2, 3, 4, 5], Family::Coupled, drive, rows);
        } else {
            let rows = drive.map(|drive| (0, &drive.along.still[..along]));
            both.add(end.in_plane(), [0, 1, 3, 4], Family::InPlane, drive, rows);
            if let Some(family) = end.out_of_plane() {
                let rows = drive.map(|drive| (along, &drive.sideways.still[..all - along]));
                both.add(family, [2, 5], Family::OutOfPlane, drive, rows);
            }
        }

        both.add_drum_side(end, from_ground);
        both
    }

    /// Adds a family, whose components are these motions, with the static motions of the drive in it from a first one
    /// on.
    fn add<const D: usize, const N: usize, const E: usize>(
        &mut self,
        family: &PoleResidue<N, E>,
        places: [usize; N],
        of: Family,
        drive: Option<&DriveMotion>,
        still: Option<(usize, &[[[f64; N]; D]])>,
    ) {
        for (i, place) in places.iter().enumerate() {
            for (j, other) in places.iter().enumerate() {
                self.stiffness[*place][*other] += family.stiffness[i][j];
                self.mass[*place][*other] += family.mass[i][j];
            }
        }

        for (index, (pole, g)) in family.poles.iter().zip(&family.participation).enumerate() {
            let mut participation = [0.0; ENDS];
            places.iter().zip(g).for_each(|(place, g)| participation[*place] = *g);
            let mut motions = drive.map_or_else(Vec::new, |drive| drive.in_mode(of, index));
            motions.truncate(self.still.len());
            let on_drum_side = (0.0, 0.0);
            self.modes.push(TwoEndedMode {
                family: of,
                index,
                pole: *pole,
                participation,
                on_drum_side,
                drive: motions,
            });
        }

        if let Some((first, rows)) = still {
            for (row, still) in self.still[first..].iter_mut().zip(rows) {
                places.iter().zip(&still[0]).for_each(|(place, psi)| row[*place] += psi);
            }
        }
    }

    /// Adds the motion along the drum side.
    fn add_drum_side(&mut self, end: &CatenaryDynamicEnd, from_ground: bool) {
        let Some((chain, drive)) = end.chain().zip(end.cable.drive.as_ref()) else { return };
        // A motion of the entry point, where the stretch is that at the drum, as one of the end of the drum side.
        let ratio = end.drum_side_ratio();
        let work = |motion: usize| match chain.drum_side.get(motion) {
            Some(side) if from_ground => (ratio * side.stiffness, ratio * side.mass),
            Some(side) => (0.0, side.carried_mass),
            None => (0.0, 0.0),
        };
        let (k, m): (Vec<f64>, Vec<f64>) = (0..self.still.len()).map(work).unzip();
        let own = if from_ground {
            chain
                .drum_side
                .first()
                .map_or((0.0, 0.0), |side| (ratio * ratio * side.stiffness, ratio * ratio * side.mass))
        } else {
            (0.0, chain.drum_side_mass)
        };

        // Static motion of the drive, and the work of the clamped modes.
        let flexibility: &DMat = &drive.flexibility;
        let still: Vec<f64> =
            (0..k.len()).map(|i| -(0..k.len()).map(|j| flexibility[(i, j)] * k[j]).sum::<f64>()).collect();
        for mode in &mut self.modes {
            let along = |work: &[f64]| mode.drive.iter().zip(work).map(|(phi, work)| phi * work).sum::<f64>();
            mode.on_drum_side = (along(&k), along(&m));
            mode.participation[ALONG] = mode.on_drum_side.1 - mode.on_drum_side.0 / mode.pole;
        }

        // Static stiffness and mass with that motion.
        for i in 0..ALONG {
            let by_end = |work: &[f64]| self.still.iter().zip(work).map(|(row, work)| row[i] * work).sum::<f64>();
            let of_modes: f64 =
                self.modes.iter().map(|mode| mode.on_drum_side.0 / mode.pole * mode.participation[i]).sum();
            let (stiffness, mass) = (by_end(&k), by_end(&m) - of_modes);
            (self.stiffness[i][ALONG], self.stiffness[ALONG][i]) = (stiffness, stiffness);
            (self.mass[i][ALONG], self.mass[ALONG][i]) = (mass, mass);
        }
        let along = |work: &[f64]| still.iter().zip(work).map(|(still, work)| still * work).sum::<f64>();
        let of_modes: f64 = self.modes.iter().map(|mode| (mode.on_drum_side.0 / mode.pole).powi(2)).sum();
        self.stiffness[ALONG][ALONG] = own.0 + along(&k);
        self.mass[ALONG][ALONG] = own.1 + 2.0 * along(&m) + of_modes;
        self.still.iter_mut().zip(still).for_each(|(row, still)| row[ALONG] = still);

        // A drum side from the ground stretches with it at the wheel.
        if from_ground {
            let (first, along) = end.motions_along();
            let rows = &mut self.still[first + end.cable.stretch.moments..along];
            rows.iter_mut().zip(&chain.stretches).for_each(|(row, of)| row[ALONG] += of.by([0.0, ratio]));
        }
    }

    /// Modes with the poles that are not `left_out`.
    fn counted<'a>(&'a self, left_out: &'a NearRanges) -> impl Iterator<Item = &'a TwoEndedMode> {
        self.modes.iter().filter(|mode| !left_out.of(mode.family).contains(&mode.index))
    }

    /// Stiffness at x = ω_c² [N/m].
    pub(crate) fn value_at(&self, x: Complex) -> [[Complex; ENDS]; ENDS] {
        let mut value = [[Complex::new(0.0, 0.0); ENDS]; ENDS];
        for (i, j) in (0..ENDS).flat_map(|i| (i..ENDS).map(move |j| (i, j))) {
            value[i][j] = self.stiffness[i][j] - x * self.mass[i][j];
        }
        for mode in &self.modes {
            let by_value = x * x * (mode.pole - x).inv();
            for (i, a) in mode.participation.iter().enumerate() {
                for (j, b) in mode.participation.iter().enumerate().skip(i) {
                    value[i][j] -= by_value * (a * b);
                }
            }
        }
        for (i, j) in (0..ENDS).flat_map(|i| (0..i).map(move |j| (i, j))) {
            value[i][j] = value[j][i];
        }
        value
    }

    /// Stiffness at x = ω_c² without the poles `left_out` [N/m], and its derivative by x [kg].
    pub(crate) fn at(&self, x: Complex, left_out: &NearRanges) -> EndMatrix {
        let mut value = [[Complex::new(0.0, 0.0); ENDS]; ENDS];
        let mut slope = value;
        for (i, j) in (0..ENDS).flat_map(|i| (0..ENDS).map(move |j| (i, j))) {
            value[i][j] = self.stiffness[i][j] - x * self.mass[i][j];
            slope[i][j] = (-self.mass[i][j]).into();
        }
        for mode in self.counted(left_out) {
            let factor = (mode.pole - x).inv();
            let (by_value, by_slope) = (x * x * factor, x * factor * factor * (2.0 * mode.pole - x));
            for (i, a) in mode.participation.iter().enumerate() {
                for (j, b) in mode.participation.iter().enumerate() {
                    value[i][j] -= by_value * (a * b);
                    slope[i][j] -= by_slope * (a * b);
                }
            }
        }
        (value, slope)
    }

    /// Motions of the drive per motion of the ends at x = ω_c² without the poles `left_out`, and their derivatives by
    /// x.
    pub(crate) fn drive(&self, x: Complex, left_out: &NearRanges) -> Vec<([Complex; ENDS], [Complex; ENDS])> {
        self.motions(&(0..self.still.len()).collect::<Vec<usize>>(), x, left_out)
    }

    /// The given motions of the drive, as by [`drive`](Self::drive).
    pub(crate) fn motions(
        &self,
        motions: &[usize],
        x: Complex,
        left_out: &NearRanges,
    ) -> Vec<([Complex; ENDS], [Complex; ENDS])> {
        let mut rows: Vec<([Complex; ENDS], [Complex; ENDS])> =
            motions.iter().map(|of| (self.still[*of].map(Complex::from), [Complex::new(0.0, 0.0); ENDS])).collect();
        for mode in self.counted(left_out) {
            let factor = (mode.pole - x).inv();
            let (by_end, by_end_slope) = (x * factor, mode.pole * factor * factor);
            for (row, of) in rows.iter_mut().zip(motions) {
                let phi = mode.drive[*of];
                for (i, g) in mode.participation.iter().enumerate() {
                    row.0[i] += by_end * (phi * g);
                    row.1[i] += by_end_slope * (phi * g);
                }
            }
        }
        rows
    }

    /// Motions of the drive for a motion of the ends at x = ω² without the poles `left_out`.
    pub(crate) fn drive_by(&self, x: f64, left_out: &NearRanges, ends: &[f64; ENDS]) -> Vec<f64> {
        let rows = self.drive(x.into(), left_out);
        rows.into_iter().map(|(row, _)| row.iter().zip(ends).map(|(transfer, u)| transfer.re * u).sum()).collect()
    }

    /// Static stiffness [N/m] and mass [kg] over the motions of the ends.
    pub(crate) fn still_parts(&self) -> [&[[f64; ENDS]; ENDS]; 2] {
        [&self.stiffness, &self.mass]
    }

    /// Clamped modes, in plane and then out of plane: participation of the ends [√kg], pole [rad²/s²], and true for a
    /// mode out of plane.
    pub(crate) fn clamped_modes(&self) -> impl Iterator<Item = (&[f64; ENDS], f64, bool)> {
        self.modes.iter().map(|mode| (&mode.participation, mode.pole, mode.family == Family::OutOfPlane))
    }

    /// Static amplitude of each clamped mode per motion of the entry point along the drum side, `−κ/ω_k²` [√kg].
    pub(crate) fn static_amplitudes(&self) -> impl Iterator<Item = f64> {
        self.modes.iter().map(|mode| -mode.on_drum_side.0 / mode.pole)
    }

    /// Participation of the motion along the drum side in the clamped modes of a family, and their static amplitudes
    /// per such motion [√kg].
    pub(crate) fn along_drum_side(&self, family: Family) -> Vec<(f64, f64)> {
        let modes = self.modes.iter().filter(|mode| mode.family == family);
        modes.map(|mode| (mode.participation[ALONG], -mode.on_drum_side.0 / mode.pole)).collect()
    }

    /// Static motion of each part of the drive per motion along the drum side.
    pub(crate) fn still_along_drum_side(&self) -> Vec<f64> {
        self.still.iter().map(|row| row[ALONG]).collect()
    }

    /// Participation of the ends in a clamped mode [√kg].
    pub(crate) fn participation(&self, family: Family, index: usize) -> [f64; ENDS] {
        let found = self.modes.iter().find(|mode| mode.family == family && mode.index == index);
        found.map_or([0.0; ENDS], |mode| mode.participation)
    }
}

impl InternalMotion {
    /// Adds the motion by a support, which moves the far end, to one that follows from the platform end alone. `ends`
    /// is the motion of the ends by the support, at x = ω_c².
    pub(crate) fn add_carrier(&mut self, cable: &CatenaryDynamic, both: &TwoEnded, ends: [Complex; ENDS], x: Complex) {
        let [_, _, _, e, n, b, along] = ends;
        let still = Complex::new(0.0, 0.0);
        let by_end = Self::between(cable, [still; 3], [e, n, b], x);
        for (sum, moved) in self.in_plane_ends.iter_mut().zip(by_end.in_plane_ends) {
            *sum += moved;
        }

        for (sum, moved) in self.out_of_plane_ends.iter_mut().zip(by_end.out_of_plane_ends) {
            *sum += moved;
        }

        let families = [
            (&mut self.in_plane, by_end.in_plane, Family::InPlane),
            (&mut self.out_of_plane, by_end.out_of_plane, Family::OutOfPlane),
            (&mut self.coupled, by_end.coupled, Family::Coupled),
        ];
        for (amplitudes, by_end, family) in families {
            amplitudes.iter_mut().zip(by_end).for_each(|(sum, moved)| *sum += moved);
            // The forces of the drum side on the drive.
            for mode in both.modes.iter().filter(|mode| mode.family == family) {
                let (stiff, heavy) = mode.on_drum_side;
                amplitudes[mode.index] += (x * heavy - stiff) / (mode.pole - x) * along;
            }
        }
    }
}

impl NearRanges {
    /// Indices in one family.
    fn of(&self, family: Family) -> &std::ops::Range<usize> {
        match family {
            Family::InPlane => &self.in_plane,
            Family::OutOfPlane => &self.out_of_plane,
            Family::Coupled => &self.coupled,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cable::{CableModel, DynamicCable, EndStiffness};
    use crate::robot::{Control, DrumSide, Robot, Servo, WinchMode};
    use crate::statics::{self, StaticModel};

    /// Cable over a pulley with an inclined axis (`skew`) to a winch with a servo and a drum side with mass.
    fn driven(skew: f64, side: DrumSide) -> CatenaryDynamicEnd {
        let text = format!(
            "name = \"one\"\n[platform]\nmass_kg = 20.0\nmotion = \"point-mass\"\n[materials.rope]\n\
             axial_stiffness_n = 2e5\nmass_kg_per_m = 0.1\n[pulleys.wheel]\nradius_m = 0.1\ninertia_kg_m2 = 2e-3\n\
             swivel_inertia_kg_m2 = 4e-3\nentry_direction = [{skew}, 0.1, 1]\n[winches.drum]\ndrum_side_length_m = \
             2.0\n\
             stiffness_n_per_m = 1e6\n[[cables]]\nname = \"1\"\nmaterial = \"rope\"\npulley = \"wheel\"\nwinch = \
             \"drum\"\n\
             anchor_m = [0, 0, 3]\nunstrained_length_m = 6.0\n[loads]\nforce_n = [80, 0, -60]\n"
        );
        let mut robot = Robot::from_toml(&text).unwrap();
        let winch = robot.cables[0].anchor.winch.as_mut().unwrap();
        winch.drum_side = side;
        winch.motor_mass = 15.0;
        winch.control = Control::Position(Servo::of_bandwidth(15.0, 6.0, 0.7, true, 0.0));
        let rest = statics::solve(&robot, StaticModel::Catenary, None).unwrap().equilibrium;
        let (model, state) = (CableModel::CatenaryDynamic, &rest.cables[0]);
        match EndStiffness::new(&robot, 0, state, model, false, WinchMode::AsGiven, 400.0).unwrap() {
            EndStiffness::Dynamic(DynamicCable::CatenaryDynamic(form)) => *form,
            _ => panic!("a cable with mass"),
        }
    }

    /// The motion along the drum side acts on the drive by the forces `−(k − x m)`. So its entries follow from the
    /// motions of the drive: `T (k − x m)` to the ends, and `k₀ − x m₀ − (k − x m)ᵀ R (k − x m)` to itself.
    #[test]
    fn the_drum_side_acts_through_the_drive() {
        let cases = [(0.0, DrumSide::Massless), (0.0, DrumSide::Rod), (0.6, DrumSide::Rod)];
        for (form, from_ground) in
            cases.iter().flat_map(|(skew, side)| [true, false].map(|from_ground| (driven(*skew, *side), from_ground)))
        {
            let both = TwoEnded::new(&form, from_ground);
            let chain = form.chain().unwrap();
            let ratio = chain.drum_end.as_ref().unwrap().ratio;
            for x in [Complex::new(0.0, 0.0), Complex::new(900.0, 0.0), Complex::new(8e3, -150.0)] {
                let all = NearRanges::default();
                let ((value, _), motions) = (both.at(x, &all), form.drive_at(x, &all).unwrap());
                let mut work: Vec<Complex> = vec![0.0.into(); both.still.len()];
                for (work, side) in work.iter_mut().zip(&chain.drum_side) {
                    *work = if from_ground { ratio * (side.stiffness - x * side.mass) } else { -x * side.carried_mass };
                }

                // The platform end, and the motion itself.
                let size = value[ALONG][ALONG].norm() + value[0][0].norm();
                for (s, entry) in value[ALONG][..3].iter().enumerate() {
                    let through: Complex = motions.transfer.iter().zip(&work).map(|(row, work)| row[s] * work).sum();
                    assert!((entry - through).norm() < 1e-9 * size, "{x}: {entry} {through}");
                }
                let side = &chain.drum_side[0];
                let held = ratio * ratio * (side.stiffness - x * side.mass);
                let own = if from_ground { held } else { -x * chain.drum_side_mass };
                let through: Complex = (0..work.len())
                    .flat_map(|i| (0..work.len()).map(move |j| (i, j)))
                    .map(|(i, j)| work[i] * motions.receptance[(i, j)] * work[j])
                    .sum();
                let exact = own - through;
                assert!((value[ALONG][ALONG] - exact).norm() < 1e-9 * size, "{x}: {} {exact}", value[ALONG][ALONG]);

                // The platform end alone is that of the cable.
                let plain = form.undamped(x.re.sqrt());
                if x.im == 0.0 {
                    assert!((value[0][0].re - plain.axial).abs() < 1e-12 * size);
                    assert!((value[2][2].re - plain.out_of_plane).abs() < 1e-12 * size);
                }

                // Motions of the drive.
                for ((row, _), transfer) in both.drive(x, &all).iter().zip(&motions.transfer) {
                    assert!((0..3).all(|s| (row[s] - transfer[s]).norm() < 1e-12));
                }
            }
        }
    }

    /// The derivative by x is that of differences, and amplitudes by a motion along the drum side lead to its
    /// stiffness.
    #[test]
    fn slopes_are_those_of_differences() {
        let form = driven(0.6, DrumSide::Rod);
        for from_ground in [true, false] {
            let both = TwoEnded::new(&form, from_ground);
            let (x, step, all) = (Complex::new(5e3, 0.0), 1.0, NearRanges::default());
            let [ahead, behind] = [x + step, x - step].map(|x| both.at(x, &all).0);
            let slope = both.at(x, &all).1;
            let size = slope.iter().flatten().map(|entry| entry.norm()).fold(0.0, f64::max);
            for i in 0..ENDS {
                for j in 0..ENDS {
                    let difference = (ahead[i][j] - behind[i][j]) / (2.0 * step);
                    assert!((slope[i][j] - difference).norm() < 1e-5 * size, "{i} {j}: {} {difference}", slope[i][j]);
                }
            }
        }
    }
}
