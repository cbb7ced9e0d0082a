//! `settle`: text.

use crate::output::Printed;
use crate::table::{Table, counted, decimals, significant};
use funicular_study::analyses::settle::{Commanded, Held, Settled, SettlingMode, Shaping, after};
use std::fmt::Write as _;

/// Modes that the table shows.
const SHOWN: usize = 12;

impl Printed for Settled {
    fn text(&self) -> String {
        let table = Table::of(&SettlingMode::columns(&self.modes), self.modes.iter().take(SHOWN));
        let ends = self.modes.iter().filter_map(|mode| Some((mode, mode.settled_s?)));
        let last = ends.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, time)| *time > 0.0);
        let last = last.filter(|_| self.never_settles.is_none()).map_or_else(String::new, |(mode, _)| {
            format!("; the mode at {} Hz lasts longest", decimals(mode.frequency_hz, 4))
        });
        let (what, before) = match (&self.commanded, &self.held) {
            (Some(commanded), _) => (format!("a {}", commanded.command_kind), of_command(commanded)),
            (None, Some(held)) => ("a release".to_owned(), of_release(held)),
            (None, None) => (String::new(), String::new()),
        };
        let shaping = self.commanded.as_ref().and_then(|commanded| commanded.shaping.as_ref());
        format!(
            "{}: decay after {what}, modes below {} Hz\n{}\n\n{before}\n{}{last}.\n{}\n{table}\n{} of {} shown.{}\n",
            self.robot,
            self.below_hz,
            self.models.line(),
            self.when_settled(),
            match (&self.held, &self.commanded) {
                (Some(held), _) => of_omitted(held),
                (None, Some(commanded)) => {
                    let shaper = shaping.map_or_else(String::new, |shaping| of_shaper(shaping, self.tolerance_m));
                    of_omitted_by_command(commanded) + &shaper
                }
                (None, None) => String::new(),
            },
            self.modes.len().min(SHOWN),
            counted(self.modes.len(), "mode"),
            if self.damped_certified { "" } else { " NOT certified: no count proves the list of damped modes." },
        )
    }
}

/// Bounds of the modes above the limit after a command; nothing if none are known.
fn of_omitted_by_command(of: &Commanded) -> String {
    let Some(distance) = of.omitted_m else { return String::new() };
    let tension = of.omitted_tension_n.map_or_else(String::new, |tension| {
        format!(", and change the mean tension of a cable by at most {} N", significant(tension, 3))
    });
    format!(
        "All modes above the limit together move the point by at most {} mm after the {}{tension}.\n",
        significant(1e3 * distance, 3),
        of.command_kind
    )
}

fn of_omitted(held: &Held) -> String {
    format!(
        "All modes above the limit together move the point by at most {} mm at the release.\n",
        significant(1e3 * held.omitted_m, 3)
    )
}

/// Displacement before a release.
fn of_release(held: &Held) -> String {
    let [x, y, z] = held.held_m.map(|part| significant(1e3 * part, 4));
    let lowest = &held.lowest_tension;
    format!(
        "Displacement before the release, linear: {x}, {y}, {z} mm. The lowest tension is {} N, in cable \"{}\" {} s \
         after it.",
        significant(lowest.tension_n, 4),
        lowest.cable,
        significant(lowest.t_s, 3),
    )
}

/// Duration and lowest tension of a command.
fn of_command(of: &Commanded) -> String {
    let lowest = &of.lowest_tension;
    let mut text = format!(
        "The {} takes {} s; times are counted from its end. The lowest tension is {} N, in cable \"{}\" {} s after its \
         start.",
        of.command_kind,
        significant(of.duration_s, 4),
        significant(lowest.tension_n, 4),
        lowest.cable,
        significant(lowest.t_s, 3),
    );
    for row in &of.payloads {
        let without = row
            .without_m
            .map_or_else(String::new, |size| format!(", without the shaper {} mm", significant(1e3 * size, 3)));
        let _ = write!(
            text,
            "\nWith a payload of {} kg: sum of the amplitudes {} mm{without}, most of it at {} Hz; within the \
             tolerance for good {}.",
            row.payload_kg,
            significant(1e3 * row.amplitude_m, 3),
            decimals(row.frequency_hz, 4),
            after(row.settled_s),
        );
    }
    text
}

/// Shaper, its impulses, and what it leaves.
fn of_shaper(of: &Shaping, tolerance: f64) -> String {
    if of.modes_hz.is_empty() {
        return format!("Shaper {}: not needed, the sum of all amplitudes is within the tolerance.\n", of.shaper);
    }
    let modes: Vec<String> = of.modes_hz.iter().map(|frequency| decimals(*frequency, 4)).collect();
    let impulses: Vec<String> = (of.impulses.iter())
        .map(|impulse| format!("{} at {} s", decimals(impulse.part, 4), decimals(impulse.t_s, 4)))
        .collect();
    let mut text = format!(
        "Shaper {} for {} Hz, {} s longer: {}.\nWithout it: within {} mm for good {} an end that is {} s \
         earlier.\n",
        of.shaper,
        modes.join(", "),
        significant(of.longer_s, 4),
        impulses.join(", "),
        significant(1e3 * tolerance, 3),
        of.settled_without_s
            .map_or_else(|| "never after".to_owned(), |time| format!("{} s after", significant(time, 4))),
        significant(of.longer_s, 4),
    );
    for row in &of.robustness {
        let _ = writeln!(
            text,
            "All frequencies {:+.0} %: sum of the amplitudes {} mm, without the shaper {} mm.",
            100.0 * (row.frequency_factor - 1.0),
            significant(1e3 * row.amplitude_m, 3),
            significant(1e3 * row.without_m, 3),
        );
    }
    text
}
