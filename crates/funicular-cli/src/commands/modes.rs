//! `modes`: text and CSV.

use crate::output::Printed;
use crate::table::{self, Table, counted, decimals, short, significant};
use funicular_study::analyses::modes::{Modes, Participation, RIGID, strongest};
use funicular_study::analyses::shared::ModeRow;
use funicular_study::uff_writing::modes_file;

impl Printed for Modes {
    fn text(&self) -> String {
        let peak = self.participation.as_ref().map(|of| format!("peak [{}]", of.peak_unit));
        let decay = self.decay_percent.map(|percent| format!("to {} % [s]", short(percent, 4)));
        let stretches = self.modes.iter().any(|mode| !mode.stretching_share.is_empty());
        let mut heads = vec!["f [Hz]", "damping [%]"];
        heads.extend(decay.as_deref());
        heads.extend(stretches.then_some("stretch [%]"));
        heads.extend(peak.as_deref());
        heads.extend(["platform [%]", "x", "y", "z", "rx [1/m]", "ry [1/m]", "rz [1/m]", "kind", "cables"]);
        let mut table = Table::new(&heads).text_columns(&[heads.len() - 2, heads.len() - 1]);

        for mode in &self.modes {
            let mut row = vec![decimals(mode.frequency_hz, 4), significant(100.0 * mode.damping_ratio, 3)];
            if decay.is_some() {
                row.push(mode.decay_time_s.map_or(table::NONE.to_owned(), |time| significant(time, 3)));
            }
            if stretches {
                row.push(decimals(100.0 * mode.stretching_share.iter().sum::<f64>(), 1));
            }
            if self.participation.is_some() {
                row.push(mode.peak.map_or(table::NONE.to_owned(), |peak| significant(peak, 3)));
            }
            row.push(decimals(100.0 * mode.platform_energy_fraction, 1));
            row.extend(mode.shape.iter().map(|x| decimals(*x, 2)));
            row.extend([mode.kind.to_owned(), strongest_cables(self, mode)]);
            table.row(row);
        }

        let pair = match &self.participation {
            None => String::new(),
            Some(Participation { input, output, .. }) => {
                format!(
                    "peak: contribution of each mode alone to the response of {output} to {input} at its frequency\n"
                )
            }
        };

        format!(
            "{}: natural frequencies below {} Hz{}\n{}\n{pair}\n{}{}\n{}\n",
            self.robot,
            self.below_hz,
            if self.is_default_limit { ", the lowest ones; --below-hz sets another limit" } else { "" },
            self.models.line(),
            if self.modes.is_empty() { String::new() } else { format!("{table}\n") },
            certificate(self),
            first_platform(self)
        )
    }

    fn csv(&self, out: &mut csv::Writer<Vec<u8>>) -> csv::Result<()> {
        let fixed = [
            "frequency_hz",
            "multiplicity",
            "damping_ratio",
            "kind",
            "platform_energy_fraction",
            "shape_x",
            "shape_y",
            "shape_z",
            "shape_rx_per_m",
            "shape_ry_per_m",
            "shape_rz_per_m",
            "residual",
            "modal_mass_kg",
            "residue_per_kg",
            "peak",
            "decay_time_s",
        ];
        let cables = self.cable_names.iter().map(|name| format!("energy_fraction_cable_{name}"));
        let drives_move = self.modes.iter().any(|mode| !mode.drive_energy_fractions.is_empty());
        let drives =
            self.cable_names.iter().filter(|_| drives_move).map(|name| format!("energy_fraction_drive_{name}"));
        let supports = self.support_names.iter().map(|name| format!("energy_fraction_support_{name}"));
        let stretches = self.modes.iter().any(|mode| !mode.stretching_share.is_empty());
        let stretch =
            self.cable_names.iter().filter(|_| stretches).map(|name| format!("stretching_share_cable_{name}"));
        let fixed = fixed.into_iter().map(str::to_owned);
        out.write_record(fixed.chain(cables).chain(drives).chain(supports).chain(stretch))?;

        for mode in &self.modes {
            out.serialize((
                (mode.frequency_hz, mode.multiplicity, mode.damping_ratio, mode.kind, mode.platform_energy_fraction),
                mode.shape,
                (mode.residual, mode.modal_mass_kg, mode.residue_per_kg, mode.peak, mode.decay_time_s),
                &mode.cable_energy_fractions,
                &mode.drive_energy_fractions,
                &mode.support_energy_fractions,
                &mode.stretching_share,
            ))?;
        }

        Ok(())
    }

    fn uff(&self) -> anyhow::Result<Vec<u8>> {
        Ok(modes_file(self))
    }
}

/// Sentence on the list: certified, or the reason why not.
fn certificate(found: &Modes) -> String {
    let listed = counted(found.modes.len(), "mode");
    let unstable = match found.unstable_directions {
        0 => String::new(),
        n if found.is_indifferent => format!(" and {} without a frequency", counted(n, "indifferent direction")),
        n => format!(" and {} without a frequency", counted(n, "unstable direction")),
    };
    let Modes { count_below, below_hz, .. } = found;

    if found.models.cable_model == RIGID && found.certified {
        return format!(
            "Complete: rigid cables leave the platform {count_below} of its motions below {below_hz} Hz, the list has \
             {listed}{unstable}."
        );
    }
    if found.certified {
        format!(
            "Certified: the Wittrick–Williams count below {below_hz} Hz is {count_below}, the list has {listed}\
             {unstable}; none is missing."
        )
    } else {
        format!(
            "NOT certified: the Wittrick–Williams count below {below_hz} Hz is {count_below}, the list has {listed}\
             {unstable}."
        )
    }
}

/// Sentence on the first mode of the platform.
fn first_platform(found: &Modes) -> String {
    let percent = short(100.0 * found.platform_share, 4);
    match &found.first_platform_mode {
        Some(first) => format!(
            "First mode with at least {percent} % of its kinetic energy in the platform: {} Hz (no. {}, {} %).",
            decimals(first.frequency_hz, 4),
            first.index + 1,
            decimals(100.0 * first.platform_energy_fraction, 1)
        ),
        None => format!(
            "No mode below {} Hz has at least {percent} % of its kinetic energy in the platform: raise --below-hz or lower \
             --platform-share.",
            found.below_hz
        ),
    }
}

/// Cables with the most energy, with their fractions of it.
fn strongest_cables(found: &Modes, mode: &ModeRow) -> String {
    let supports = (&found.support_names[..], &mode.support_energy_fractions[..]);
    let of_cables = (&mode.cable_energy_fractions, &mode.drive_energy_fractions);
    let shown: Vec<String> = strongest(&found.cable_names, of_cables.0, of_cables.1, supports)
        .iter()
        .map(|(name, share)| format!("{name} {}%", decimals(100.0 * share, 0)))
        .collect();
    if shown.is_empty() { table::NONE.to_owned() } else { shown.join(", ") }
}
