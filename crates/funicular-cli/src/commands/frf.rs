//! `frf`: text and CSV.

use crate::output::Printed;
use crate::table::{Table, counted, decimals, significant, vector};
use funicular_study::analyses::frf::{Frf, PlaceRow};

impl Printed for Frf {
    fn text(&self) -> String {
        let mut peaks = Table::new(&["peak [Hz]", "prominence [dB]", &format!("magnitude [{}]", self.unit)]);
        for peak in &self.peaks {
            peaks.row(vec![
                decimals(peak.frequency_hz, 4),
                decimals(peak.prominence_db, 2),
                significant(peak.magnitude, 5),
            ]);
        }

        let points = self.frequency_hz.len();
        let magnitude = |i: usize| significant(self.real[i].hypot(self.imag[i]), 5);
        let largest = (0..points)
            .max_by(|&i, &j| self.real[i].hypot(self.imag[i]).total_cmp(&self.real[j].hypot(self.imag[j])))
            .unwrap_or(0);

        format!(
            "{}: response of {} at {} to {} at {}\n{}\n\n\
             {points} frequencies from {} to {} Hz; largest magnitude {} {} at {} Hz\n\n{}\
             {} of at least {} dB. The whole curve: --format csv or --format json.\n",
            self.robot,
            self.output,
            place_text(&self.output_place),
            self.input,
            place_text(&self.input_place),
            self.models.line(),
            self.frequency_hz[0],
            self.frequency_hz[points - 1],
            magnitude(largest),
            self.unit,
            significant(self.frequency_hz[largest], 6),
            if self.peaks.is_empty() { String::new() } else { format!("{peaks}\n") },
            counted(self.peaks.len(), "peak"),
            self.prominence_db,
        )
    }

    fn csv(&self, out: &mut csv::Writer<Vec<u8>>) -> csv::Result<()> {
        out.write_record(["frequency_hz", "real", "imag", "magnitude", "phase_deg"])?;
        for ((frequency, re), im) in self.frequency_hz.iter().zip(&self.real).zip(&self.imag) {
            out.serialize((frequency, re, im, re.hypot(*im), im.atan2(*re).to_degrees()))?;
        }
        Ok(())
    }
}

/// Text for the place of the input or output of a response.
fn place_text(place: &PlaceRow) -> String {
    format!("({}) m{}", vector(&place.point_m, 3), if place.on_cable { " of the world" } else { "" })
}
