//! `modes`: text and CSV.

use crate::output::Printed;
use crate::table::{Table, counted, decimals, short};
use funicular_formats::uff_writing::modes_file;
use funicular_study::analyses::modes::{Modes, Participation, RIGID};

impl Printed for Modes {
    fn text(&self) -> String {
        let table = Table::of(&self.columns(), &self.modes);
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
