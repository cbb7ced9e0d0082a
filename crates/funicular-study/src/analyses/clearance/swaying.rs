//! Excursions of cables and platform in gusts, which enlarge the required distances.

use super::ClearanceRow;
use crate::at_rest::{self, AtRest, expected_peak, moments_in_gusts};
use crate::error::NoSolution;
use crate::request::{GUST_DURATION, Model};
use anyhow::Result;
use funicular::clearance::{ClearanceKind, Surroundings};
use funicular::math::Vec3;
use funicular::response::Signal;
use funicular::robot::PlatformMotion;
use std::collections::BTreeMap;

/// Number of parts of a cable between whose ends its motion is sampled. The modes that count in gusts have a few half
/// waves.
const PARTS: usize = 12;

/// Axes of the world.
const AXES_W: [Vec3; 3] = [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)];

/// Expected largest excursions from the mean place [m].
pub(super) struct Excursions {
    /// Largest along each cable, by its name.
    cables: BTreeMap<String, f64>,
    /// Bound for every point of the platform's bodies.
    platform: f64,
}

impl Excursions {
    /// Excursions at an equilibrium in the gusts of its robot.
    ///
    /// The peaks along the three axes count as simultaneous, and those of a rotation at the farthest point: the bound
    /// is on the safe side.
    ///
    /// # Errors
    /// A robot without gusts, a slack cable, or motions that cross their mean too seldom for a peak.
    pub(super) fn of(at_rest: &AtRest, around: &Surroundings) -> Result<Self> {
        let robot = &at_rest.robot;
        let translations = AXES_W.map(|direction_w| Signal::Along { direction_w, point_p: Vec3::zeros() });
        let rotations = match robot.platform.motion {
            PlatformMotion::PointMass => Vec::new(),
            PlatformMotion::Rigid | PlatformMotion::Planar(_) => AXES_W.map(|axis_w| Signal::About { axis_w }).to_vec(),
        };
        let on_cables = (0..robot.cables.len()).flat_map(|cable| {
            (0..PARTS).flat_map(move |k| {
                let fraction = k as f64 / PARTS as f64;
                AXES_W.map(|direction_w| Signal::OnCable { cable, fraction, direction_w })
            })
        });
        let signals: Vec<Signal> = translations.into_iter().chain(rotations.iter().copied()).chain(on_cables).collect();

        let linearisation = at_rest::linearisation(&Model::default(), at_rest.equilibrium.model);
        let moments = moments_in_gusts(at_rest, linearisation, &signals)?;
        let peaks: Option<Vec<f64>> = moments.iter().map(|of| expected_peak(of, GUST_DURATION)).collect();
        let Some(peaks) = peaks else {
            let message = format!(
                "a motion crosses its mean too seldom within {GUST_DURATION} s for an expected peak: look at `gust`"
            );
            return Err(NoSolution(message).into());
        };

        let norm = |of: &[f64]| of.iter().map(|peak| peak * peak).sum::<f64>().sqrt();
        let (of_platform, of_cables) = peaks.split_at(AXES_W.len() + rotations.len());
        let (moved, turned) = of_platform.split_at(AXES_W.len());
        let largest = |points: &[f64]| points.chunks(AXES_W.len()).map(norm).fold(0.0, f64::max);
        let per_cable = of_cables.chunks(PARTS * AXES_W.len()).map(largest);
        Ok(Self {
            cables: robot.cables.iter().map(|cable| cable.name.clone()).zip(per_cable).collect(),
            platform: norm(moved) + norm(turned) * around.platform_reach(),
        })
    }

    /// Enlarges the required distances of pairs by the excursions of both; obstacles do not move.
    pub(super) fn enlarge(&self, pairs: &mut [ClearanceRow]) {
        let cable = |name: &String| self.cables.get(name).copied().unwrap_or_default();
        for pair in pairs {
            let added = match pair.kind {
                kind if kind == ClearanceKind::Cables.name() => cable(&pair.first) + cable(&pair.second),
                kind if kind == ClearanceKind::Platform.name() => cable(&pair.first) + self.platform,
                // The first of a pair with an obstacle is a cable or a body of the platform.
                _ => self.cables.get(&pair.first).copied().unwrap_or(self.platform),
            };
            pair.vibration_m = Some(added);
            pair.required_m += added;
            pair.margin_m -= added;
        }
    }
}
