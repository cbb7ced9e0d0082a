//! Cables of a pencil, side by side in groups: as matrices condensed about one frequency, and with all unknowns.

use super::batched_cable::{CableGroup, IN_PLANE, KeptStiffness, MAX_DEGREES, OUT_OF_PLANE, place};
use crate::math::simd::{LANES, Lane};
use std::array::from_fn;

/// Groups of cables, condensed onto their kept unknowns.
pub(super) trait Cables {
    /// Matrices K − xM of the kept unknowns of each group.
    fn kept(&mut self, x: f64, into: &mut Vec<KeptStiffness>);

    /// Products `aᵀ M b` per cable of a group for all pairs of motions of its kept unknowns, lower triangle by rows, at
    /// the x of the last call of `kept`.
    fn mass(&self, group: usize, motions: &[KeptMotion]) -> Vec<Lane>;

    /// Refines the discretisation; called when the search comes near its result.
    fn refine(&mut self) {}
}

/// Motion of a group's kept unknowns, in plane and out of plane.
pub(super) type KeptMotion = ([Lane; IN_PLANE], [Lane; OUT_OF_PLANE]);

/// Stiffness and mass of each group with the eliminated unknowns following the kept ones as at one frequency, first at
/// x = 0.
pub(super) struct Reduced {
    pub(super) stiffness: Vec<KeptStiffness>,
    pub(super) mass: Vec<KeptStiffness>,
}

/// Cables with all unknowns. The degrees rise when the search comes near its result, so that its last step also checks
/// the discretisation.
pub(super) struct AllUnknowns<'a> {
    pub(super) groups: &'a mut [CableGroup],
    pub(super) degrees: Vec<usize>,
}

/// Degree at the start of a search. It gives two digits for half a wave, and more degrees are needed where C varies;
/// three additional degrees give nine digits. If a cable is divided, an element has only a fraction of the wave.
pub(super) fn degree_of_start(group: &CableGroup) -> usize {
    if group.is_divided() { 5 } else { 4 + group.terms() / 8 }
}

impl Reduced {
    /// Matrices condensed at x = 0.
    pub(super) fn of(groups: &mut [CableGroup]) -> Self {
        let (stiffness, mass) = groups.iter_mut().map(|group| tangent(group, 0.0)).unzip();
        Self { stiffness, mass }
    }

    /// Condenses the groups of divided cables at x. If x is above a natural frequency of their eliminated unknowns, the
    /// matrices stay as they were and the result is false.
    pub(super) fn follow(&mut self, groups: &mut [CableGroup], x: f64) -> bool {
        let divided = groups.iter_mut().enumerate().filter(|(_, group)| group.is_divided());
        let tangents: Vec<_> = divided.map(|(i, group)| (i, tangent(group, x))).collect();
        let below = tangents.iter().all(|(_, (stiffness, _))| stiffness.min_pivot.iter().all(|pivot| *pivot > 0.0));
        if below {
            for (i, (stiffness, mass)) in tangents {
                (self.stiffness[i], self.mass[i]) = (stiffness, mass);
            }
        }
        below
    }
}

/// Stiffness and mass of a group's kept unknowns such that K − xM and its derivative are correct at x.
fn tangent(group: &mut CableGroup, x: f64) -> (KeptStiffness, KeptStiffness) {
    let mut stiffness = group.kept(x, degree_of_start(group));

    // Mass of the motions that follow a unit motion of each kept unknown.
    let unit = |k: usize| {
        let one = |j: usize| if j == k { [1.0; LANES] } else { [0.0; LANES] };
        group.moved(from_fn(one), from_fn(one))
    };
    let units = [unit(0), unit(1), unit(2)];

    let mut masses = KeptStiffness::default();
    for (row, motion) in units.iter().enumerate() {
        for (column, other) in units[..=row].iter().enumerate() {
            let [in_plane, out_of_plane] = group.mass(motion, other);
            masses.in_plane[place(row, column)] = in_plane;
            if row < OUT_OF_PLANE {
                masses.out_of_plane[place(row, column)] = out_of_plane;
            }
        }
    }

    // K is the matrix at x plus x M.
    for (k, m) in stiffness
        .in_plane
        .iter_mut()
        .zip(&masses.in_plane)
        .chain(stiffness.out_of_plane.iter_mut().zip(&masses.out_of_plane))
    {
        for i in 0..LANES {
            k[i] += x * m[i];
        }
    }
    (stiffness, masses)
}

impl Cables for Reduced {
    fn kept(&mut self, x: f64, into: &mut Vec<KeptStiffness>) {
        into.clear();
        into.extend(self.stiffness.iter().zip(&self.mass).map(|(k, m)| KeptStiffness {
            in_plane: from_fn(|entry| from_fn(|i| k.in_plane[entry][i] - x * m.in_plane[entry][i])),
            out_of_plane: from_fn(|entry| from_fn(|i| k.out_of_plane[entry][i] - x * m.out_of_plane[entry][i])),
            min_pivot: k.min_pivot,
        }));
    }

    fn mass(&self, group: usize, motions: &[KeptMotion]) -> Vec<Lane> {
        let m = &self.mass[group];
        pairs(motions, |(in_plane, out_of_plane), (other_in_plane, other_out_of_plane)| {
            let mut sums = [0.0; LANES];
            let mut add = |entry: &Lane, a: &Lane, b: &Lane| {
                for i in 0..LANES {
                    sums[i] += entry[i] * a[i] * b[i];
                }
            };
            for row in 0..IN_PLANE {
                for column in 0..IN_PLANE {
                    let at = place(row.max(column), row.min(column));
                    add(&m.in_plane[at], &in_plane[row], &other_in_plane[column]);
                    if row.max(column) < OUT_OF_PLANE {
                        add(&m.out_of_plane[at], &out_of_plane[row], &other_out_of_plane[column]);
                    }
                }
            }
            sums
        })
    }
}

/// Values of a form over all pairs: lower triangle by rows.
fn pairs<T>(all: &[T], form: impl Fn(&T, &T) -> Lane) -> Vec<Lane> {
    (0..all.len()).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|(i, j)| form(&all[i], &all[j])).collect()
}

impl AllUnknowns<'_> {
    /// Mass of the drive of each cable of a group in a motion, at the x of the last call of `kept`.
    pub(super) fn drive_mass(&self, group: usize, (in_plane, out_of_plane): KeptMotion) -> Lane {
        let group = &self.groups[group];
        group.drive_mass(&group.moved(in_plane, out_of_plane))
    }
}

impl Cables for AllUnknowns<'_> {
    fn kept(&mut self, x: f64, into: &mut Vec<KeptStiffness>) {
        into.clear();
        into.extend(self.groups.iter_mut().zip(&self.degrees).map(|(group, degree)| group.kept(x, *degree)));
    }

    fn mass(&self, group: usize, motions: &[KeptMotion]) -> Vec<Lane> {
        let group = &self.groups[group];
        let all: Vec<_> =
            motions.iter().map(|(in_plane, out_of_plane)| group.moved(*in_plane, *out_of_plane)).collect();
        pairs(&all, |a, b| {
            let [in_plane, out_of_plane] = group.mass(a, b);
            from_fn(|i| in_plane[i] + out_of_plane[i])
        })
    }

    fn refine(&mut self) {
        for degree in &mut self.degrees {
            *degree = (*degree + 2).min(MAX_DEGREES);
        }
    }
}
