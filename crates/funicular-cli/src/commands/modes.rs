//! `modes`: text and CSV.

use crate::output::Printed;
use crate::table::{Table, counted, decimals, short};
use funicular_study::analyses::modes::{FirstPlatformMode, Modes, Participation, RIGID};

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
    let shared = shared(found);
    match &found.first_platform_mode {
        Some(first) => format!(
            "First mode with at least {percent} % of its kinetic energy in the platform: {} Hz (no. {}, {} %).{shared}",
            decimals(first.frequency_hz, 4),
            first.index + 1,
            decimals(100.0 * first.platform_energy_fraction, 1)
        ),
        None => format!(
            "No mode below {} Hz has at least {percent} % of its kinetic energy in the platform: raise --below-hz or \
             lower --platform-share.{shared}",
            found.below_hz
        ),
    }
}

/// Sentence on modes below the first one of the platform that move it, too; empty without.
fn shared(found: &Modes) -> String {
    let list = |texts: Vec<String>| match texts.as_slice() {
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
        [] => String::new(),
    };
    let of = |text: &dyn Fn(&FirstPlatformMode) -> String| list(found.share_platform.iter().map(text).collect());
    match found.share_platform.len() {
        0 => String::new(),
        count => format!(
            "\n{} Hz {} the platform, too: {}; cables share their motion.",
            of(&|mode| decimals(mode.frequency_hz, 4)),
            if count == 1 { "moves" } else { "move" },
            of(&|mode| format!("{} %", decimals(100.0 * mode.platform_energy_fraction, 0)))
        ),
    }
}
