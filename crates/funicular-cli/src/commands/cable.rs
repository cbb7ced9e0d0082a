//! `cable`: text and CSV.

use crate::output::Printed;
use crate::table::{Table, counted, decimals, significant};
use funicular_study::analyses::cable::{CableResult, ComplexValues, Local};

fn line(label: &str, text: &str) -> String {
    format!("  {label:<24} {text}\n")
}

impl Printed for CableResult {
    fn text(&self) -> String {
        let mut out = format!(
            "{}: cable \"{}\", stiffness of its platform end\n{} statics, {} model{}{}\n\n",
            self.robot,
            self.name,
            self.static_model,
            self.cable_model,
            if self.in_plane_only { ", in plane only" } else { "" },
            self.origin.phrase()
        );
        let mut say = |label: &str, text: String| out.push_str(&line(label, &text));
        say("chord", format!("{} m", decimals(self.chord_m, 4)));
        say("tension along the chord", format!("{} N", significant(self.parallel_tension_n, 6)));

        if let (Some(ratio), Some(lambda2)) = (self.sag.sag_ratio, self.sag.lambda2) {
            say("sag/chord", decimals(ratio, 5));
            say("λ²", significant(lambda2, 5));
        }
        if let Some(string) = self.sag.string_frequency_hz {
            say("taut string", format!("{} Hz", significant(string, 5)));
        }

        if let Some(clamped) = &self.clamped_frequencies_hz {
            const SHOWN: usize = 12;
            let shown: Vec<String> = clamped.iter().take(SHOWN).map(|f| decimals(*f, 4)).collect();
            let more = if clamped.len() > SHOWN { ", …" } else { "" };
            let count = counted(clamped.len(), "clamped frequency");
            say(
                &count,
                format!("{}{more}{}", shown.join(", "), if clamped.is_empty() { "in the range" } else { " Hz" }),
            );
        }

        let mut table = Table::new(&["f [Hz]", "|k_a| [N/m]", "|k_b| [N/m]", "|k_c| [N/m]", "|k_o| [N/m]"]);
        let Local { k_a, k_b, k_c, k_o } = &self.local;
        let last = self.frequency_hz.len() - 1;
        const ROWS: usize = 10;
        let mut places: Vec<usize> = (0..=ROWS).map(|row| row * last / ROWS).collect();

        places.dedup();
        for i in places {
            let size = |curve: &ComplexValues| significant(curve.real[i].hypot(curve.imag[i]), 5);
            table.row(vec![significant(self.frequency_hz[i], 5), size(k_a), size(k_b), size(k_c), size(k_o)]);
        }

        format!(
            "{out}\nAlong the chord (a), coupling (b), normal in plane (c), out of plane (o)\n{table}\n\
             All {} frequencies, complex and in world axes: --format csv or --format json.\n",
            self.frequency_hz.len()
        )
    }
}
