//! `frf`: text.

use crate::output::Printed;
use crate::table::{Table, counted, decimals, significant, vector};
use funicular_study::analyses::frf::{Frf, PairRow, PlaceRow};

impl Printed for Frf {
    fn text(&self) -> String {
        let points = self.frequency_hz.len();
        let (first, last) = (self.frequency_hz[0], self.frequency_hz[points - 1]);
        let chosen = if self.adaptive { ", chosen so that every peak has its height" } else { "" };
        let range = format!("{points} frequencies from {first} to {last} Hz{chosen}");
        let (robot, models) = (&self.robot, self.models.line());

        if let [one] = &self.responses[..] {
            return format!(
                "{robot}: {}\n{models}\n\n{range}; {}\n\n{} The whole curve: --format csv or --format json.\n",
                heading(one),
                largest(&self.frequency_hz, one),
                peaks(one, self.prominence_db)
            );
        }

        let mut several = String::new();
        for pair in &self.responses {
            let (largest, peaks) = (largest(&self.frequency_hz, pair), peaks(pair, self.prominence_db));
            several += &[&heading(pair), "; ", &largest, "\n\n", &peaks, "\n\n"].concat();
        }
        let count = counted(self.responses.len(), "response");
        format!("{robot}: {count}\n{models}\n\n{range}\n\n{several}The whole curves: --format csv or --format json.\n")
    }
}

/// Signals of a response and their places.
fn heading(pair: &PairRow) -> String {
    let (output_place, input_place) = (place_text(&pair.output_place), place_text(&pair.input_place));
    format!("response of {}{output_place} to {}{input_place}", pair.output, pair.input)
}

/// Sentence on the largest magnitude of a response.
fn largest(frequencies_hz: &[f64], pair: &PairRow) -> String {
    let magnitude = |i: usize| pair.real[i].hypot(pair.imag[i]);
    let at = (0..frequencies_hz.len()).max_by(|&i, &j| magnitude(i).total_cmp(&magnitude(j))).unwrap_or(0);
    let (height, hz) = (significant(magnitude(at), 5), significant(frequencies_hz[at], 6));
    format!("largest magnitude {height} {} at {hz} Hz", pair.unit)
}

/// Table of the peaks of a response and their number.
fn peaks(pair: &PairRow, prominence_db: f64) -> String {
    let mut table = Table::new(&["peak [Hz]", "prominence [dB]", &format!("magnitude [{}]", pair.unit)]);
    for peak in &pair.peaks {
        table.row(vec![
            decimals(peak.frequency_hz, 4),
            decimals(peak.prominence_db, 2),
            significant(peak.magnitude, 5),
        ]);
    }
    let table = if pair.peaks.is_empty() { String::new() } else { format!("{table}\n") };

    let undamped: Vec<String> = pair.undamped_hz.iter().map(|hz| decimals(*hz, 4)).collect();
    let undamped = match undamped.len() {
        0 => String::new(),
        count => format!(
            " {} at {} Hz, where the magnitude has no bound.",
            counted(count, "undamped resonance"),
            undamped.join(", ")
        ),
    };
    format!("{table}{} of at least {prominence_db} dB.{undamped}", counted(pair.peaks.len(), "peak"))
}

/// Text for the place of the input or output of a response; empty for a signal of a drive.
fn place_text<const IS_INPUT: bool>(place: &PlaceRow<IS_INPUT>) -> String {
    let world = if place.on_cable { " of the world" } else { "" };
    place.point_m.map_or_else(String::new, |point| format!(" at ({}) m{world}", vector(&point, 3)))
}
