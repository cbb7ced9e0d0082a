//! Columns of the list of modes.

use super::{Modes, strongest};
use crate::analyses::fields::AXES;
use crate::analyses::shared::ModeRow;
use crate::columns::{Columns, Field, ResultTable, Style, Tabled, any, column, only_read, parts};
use crate::table::Column;
use crate::text::{NONE, short};

/// Headings of the components of a shape.
const MOTIONS: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

impl Modes {
    /// Columns of the table of modes.
    pub fn columns(&self) -> Columns<ModeRow> {
        let drives_move = self.modes.iter().any(|mode| !mode.drive_energy_fractions.is_empty());
        let drives = if drives_move { &self.cable_names[..] } else { &[] };
        let stretches = self.modes.iter().any(|mode| !mode.stretching_share.is_empty());
        ModeRow::columns(&NamedParts {
            cables: &self.cable_names,
            drives,
            supports: &self.support_names,
            stretching: if stretches { &self.cable_names[..] } else { &[] },
            peak_unit: self.participation.as_ref().map(|of| &of.peak_unit[..]),
            decay_percent: self.decay_percent,
        })
    }
}

/// Names of the parts of the robot, and requested numbers, for which a table of modes has columns.
struct NamedParts<'a> {
    cables: &'a [String],
    /// Cables whose drives move.
    drives: &'a [String],
    supports: &'a [String],
    /// Cables whose share of stretch is known.
    stretching: &'a [String],
    peak_unit: Option<&'a str>,
    decay_percent: Option<f64>,
}

impl ModeRow {
    fn columns(parts_of: &NamedParts<'_>) -> Columns<Self> {
        let NamedParts { cables, supports, stretching, peak_unit, decay_percent, .. } = *parts_of;
        let names = (cables.to_vec(), supports.to_vec());
        let strongest = move |mode: &Self, style: Style| {
            let of_supports = (&names.1[..], &mode.support_energy_fractions[..]);
            let (of_cables, of_drives) = (&mode.cable_energy_fractions, &mode.drive_energy_fractions);
            let shown: Vec<String> = strongest(&names.0, of_cables, of_drives, of_supports)
                .iter()
                .map(|(name, share)| format!("{name} {}%", style.decimals(100.0 * share, 0)))
                .collect();
            if shown.is_empty() { NONE.to_owned() } else { shown.join(", ") }
        };
        let shape = (0..6).map(|i| {
            let unit = ["", "1/m"][i / 3];
            only_read()
                .shown(MOTIONS[i], unit, move |mode: &Self, style| style.decimals(mode.shape[i], 2))
                .aligned(false)
        });

        let first = [
            column("frequency_hz", "Hz", "undamped natural frequency", |mode: &Self| mode.frequency_hz)
                .decimals("f", 4),
            column("multiplicity", "1", "number of modes with this frequency", |mode: &Self| mode.multiplicity),
            column("damping_ratio", "1", "damping ratio", |mode: &Self| mode.damping_ratio).shown(
                "damping",
                "%",
                |mode, style| style.significant(100.0 * mode.damping_ratio, 3),
            ),
            only_read()
                .shown(format!("to {} %", short(decay_percent.unwrap_or_default(), 4)), "s", |mode: &Self, style| {
                    style.significant(mode.decay_time_s, 3)
                })
                .aligned(false)
                .only_if(decay_percent.is_some()),
            only_read()
                .shown("stretch", "%", |mode: &Self, style| {
                    style.decimals(100.0 * mode.stretching_share.iter().sum::<f64>(), 1)
                })
                .aligned(false)
                .only_if(!stretching.is_empty()),
            only_read()
                .shown("peak", "", |mode: &Self, style| style.significant(mode.peak, 3))
                .with_unit(peak_unit.unwrap_or_default().to_owned())
                .aligned(false)
                .only_if(peak_unit.is_some()),
            column(
                "kind",
                "",
                "where most of the kinetic energy is: platform, cable, drive or mixed",
                |mode: &Self| mode.kind,
            ),
            column("platform_energy_fraction", "1", "share of the platform in the kinetic energy", |mode: &Self| {
                mode.platform_energy_fraction
            })
            .shown("platform", "%", |mode, style| style.decimals(100.0 * mode.platform_energy_fraction, 1)),
        ];
        let in_files = [
            parts("shape_{}", AXES, "m", "motion of the platform origin along {}, world axes", |mode: &Self| {
                [mode.shape[0], mode.shape[1], mode.shape[2]]
            }),
            parts(
                "shape_{}_per_m",
                ["rx", "ry", "rz"],
                "1/m",
                "rotation of the platform, {}, in the same scale",
                |mode: &Self| [mode.shape[3], mode.shape[4], mode.shape[5]],
            ),
            column("residual", "1", "residual of the eigenvalue problem", |mode: &Self| mode.residual),
            column("modal_mass_kg", "kg", "modal mass of the shape", |mode: &Self| mode.modal_mass_kg),
            column(
                "residue_per_kg",
                "1/kg",
                "product of the shape at input and output, over the modal mass",
                |mode: &Self| mode.residue_per_kg,
            ),
            column("peak", "", "contribution of the mode alone to the response at its frequency", |mode: &Self| {
                mode.peak
            }),
            column(
                "decay_time_s",
                "s",
                "time in which the amplitude falls to the percentage of the request",
                |mode: &Self| mode.decay_time_s,
            ),
            only_read().shown("kind", "", |mode: &Self, _| mode.kind.to_owned()),
            only_read().shown("cables", "", strongest),
        ];
        Columns::new(first.into_iter().chain(shape).chain(in_files).chain(Self::shares(parts_of)))
    }

    /// Columns of the shares of the parts in the energy of a mode.
    fn shares(parts_of: &NamedParts<'_>) -> [Field<Self>; 4] {
        let NamedParts { cables, drives, supports, stretching, .. } = *parts_of;
        [
            parts("energy_fraction_cable_{}", cables, "1", "share of cable {} in the kinetic energy", |mode: &Self| {
                mode.cable_energy_fractions.clone()
            }),
            parts("energy_fraction_drive_{}", drives, "1", "share of the drive of cable {}", |mode: &Self| {
                mode.drive_energy_fractions.clone()
            }),
            parts("energy_fraction_support_{}", supports, "1", "share of the flexible support {}", |mode: &Self| {
                mode.support_energy_fractions.clone()
            }),
            parts(
                "stretching_share_cable_{}",
                stretching,
                "1",
                "share of the stretch of cable {} in the potential energy",
                |mode: &Self| mode.stretching_share.clone(),
            ),
        ]
    }
}

impl Tabled for Modes {
    fn tables() -> Vec<(&'static str, Vec<Column>)> {
        let names = any();
        let all = NamedParts {
            cables: &names,
            drives: &names,
            supports: &names,
            stretching: &names,
            peak_unit: None,
            decay_percent: None,
        };
        vec![("", ModeRow::columns(&all).described())]
    }

    fn table(&self) -> ResultTable<'_> {
        ResultTable::new(self.columns(), &self.modes)
    }
}
