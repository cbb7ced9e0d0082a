//! Robot in gusts solved at one frequency: its clamped modes are eliminated cable by cable.

use super::cable::GustyCable;
use crate::math::{CDLu, CDMat, CDVec, Complex, DMat};

/// Output as a row: over the coordinates of the ends, which are the platform's and then those of the supports, and over
/// the amplitudes of the clamped modes of one cable.
#[derive(Debug, Clone)]
pub(super) struct OutputRow {
    pub(super) ends: CDVec,
    pub(super) modes: Option<(usize, CDMat)>,
}

impl OutputRow {
    /// Row over the ends alone.
    pub(super) fn of_ends(ends: &[f64]) -> Self {
        Self { ends: CDVec::from_iterator(ends.len(), ends.iter().map(|entry| Complex::from(*entry))), modes: None }
    }

    /// Row over the coordinates of a cable, given by its index, with this number of coordinates of the ends.
    pub(super) fn of_cable(index: usize, cable: &GustyCable, row: &[Complex], ends: usize) -> Self {
        let ends = CDVec::from_fn(ends, |i, _| row[cable.end(i)]);
        let modes = CDMat::from_fn(cable.mode_count(), 1, |k, _| row[cable.mode(k)]);
        Self { ends, modes: Some((index, modes)) }
    }
}

/// Cable whose clamped modes follow the ends; it may have none.
struct Eliminated {
    /// Factors of the block of the modes.
    modes: CDLu,
    /// Amplitudes per motion of the ends, less their sign.
    by_ends: CDMat,
}

/// Dynamic stiffness of the robot at one frequency, factorised.
pub(super) struct Solved {
    cables: Vec<Eliminated>,
    ends: CDLu,
}

impl Solved {
    /// Factorises the dynamic stiffness from that of the ends alone and those of the cables. `None` if it is singular
    /// or not finite.
    pub(super) fn new(ends_alone: CDMat, cables: &[GustyCable], stiffness: &[CDMat]) -> Option<Self> {
        let mut total = ends_alone;
        let count = total.nrows();
        let mut eliminated = Vec::with_capacity(cables.len());
        for (cable, whole) in cables.iter().zip(stiffness) {
            let modes = cable.mode_count();
            let block = CDMat::from_fn(modes, modes, |k, l| whole[(cable.mode(k), cable.mode(l))]);
            let coupling = CDMat::from_fn(modes, count, |k, j| whole[(cable.mode(k), cable.end(j))]);
            let factors = block.lu();
            let by_ends = solution(&factors, &coupling)?;
            total += CDMat::from_fn(count, count, |i, j| whole[(cable.end(i), cable.end(j))]);
            total -= coupling.transpose() * &by_ends;
            eliminated.push(Eliminated { modes: factors, by_ends });
        }
        if !total.iter().all(|entry| entry.re.is_finite() && entry.im.is_finite()) {
            return None;
        }
        Some(Self { cables: eliminated, ends: total.lu() })
    }

    /// Output per force on every coordinate, by reciprocity the response of all coordinates to the row as a load: that
    /// of the ends, and that of the clamped modes of each cable. `None` if it is not finite.
    pub(super) fn response(&self, row: &OutputRow) -> Option<(CDVec, Vec<CDVec>)> {
        let mut load = row.ends.clone();
        let mut direct = None;
        if let Some((index, of_modes)) = &row.modes {
            let cable = &self.cables[*index];
            load -= (cable.by_ends.transpose() * of_modes).column(0);
            direct = Some((*index, solution(&cable.modes, of_modes)?));
        }
        let ends = self.ends.solve(&load)?;

        let of_cable = |(index, cable): (usize, &Eliminated)| {
            let amplitudes = -(&cable.by_ends * &ends);
            match &direct {
                Some((of, direct)) if *of == index => amplitudes + direct.column(0),
                _ => amplitudes,
            }
        };
        let modes: Vec<CDVec> = self.cables.iter().enumerate().map(of_cable).collect();
        let is_finite = |vector: &CDVec| vector.iter().all(|entry| entry.re.is_finite() && entry.im.is_finite());
        (is_finite(&ends) && modes.iter().all(is_finite)).then_some((ends, modes))
    }
}

/// Solution of a system that may have no unknowns; `None` if it is singular.
fn solution(factors: &CDLu, right: &CDMat) -> Option<CDMat> {
    if right.nrows() == 0 { Some(right.clone()) } else { factors.solve(right) }
}

/// Products of the load columns with a response of the coordinates on which they act.
pub(super) fn products(loads: &DMat, response: impl Fn(usize) -> Complex) -> Vec<Complex> {
    let response: Vec<Complex> = (0..loads.nrows()).map(response).collect();
    loads.column_iter().map(|column| column.iter().zip(&response).map(|(load, of)| of * *load).sum()).collect()
}
