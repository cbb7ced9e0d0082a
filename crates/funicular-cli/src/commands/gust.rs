//! `gust`: text.

use crate::output::Printed;
use crate::table::{Table, counted, significant};
use funicular_study::analyses::gust::{AirDamping, GustRow, Gusty};

/// Modes that the table shows.
const SHOWN: usize = 8;

impl Printed for Gusty {
    fn text(&self) -> String {
        let outputs = Table::of(&GustRow::columns(), &self.outputs);
        let modes = Table::of(&AirDamping::columns(), self.modes.iter().take(SHOWN));
        let [x, y, z] = self.mean_wind_m_s.map(|part| significant(part, 4));
        let turbulence = &self.turbulence;
        let three = |of: [f64; 3]| of.map(|part| significant(part, 3)).join(", ");
        let scales =
            turbulence.length_scale_m.map_or_else(String::new, |of| format!(" length scales {} m,", three(of)));
        format!(
            "{}: response to gusts below {} Hz\n{}\nMean wind {x}, {y}, {z} m/s, `{}` gusts along, lateral, up: \
             intensity {},{scales} decay of coherence {}.\n\n{outputs}\n{}\n\n{modes}\n{} of {} shown.\n",
            self.robot,
            significant(self.below_hz, 4),
            self.models.line(),
            turbulence.spectrum,
            three(turbulence.intensity),
            three(turbulence.coherence_decay),
            about_extremes(self),
            self.modes.len().min(SHOWN),
            counted(self.modes.len(), "mode"),
        )
    }
}

/// Sentences about the columns of extremes.
fn about_extremes(found: &Gusty) -> String {
    let duration = significant(found.duration_s, 4);
    let columns = format!(
        "Motions are about the equilibrium in the mean wind. Smallest and largest: expected values within {duration} \
         s; slack: probability that the tension falls to zero in that time."
    );
    let dash = (found.outputs.iter().any(|row| row.peak.is_none())).then(|| {
        format!("A dash: fewer than ten crossings of the mean are expected in {duration} s; a longer time has a peak.")
    });
    let tensions = found.outputs.iter().filter(|row| row.is_tension());
    let weakest = tensions.filter_map(|row| Some((row, row.smallest()?))).min_by(|a, b| a.1.total_cmp(&b.1));
    let weakest = weakest
        .map(|(row, smallest)| format!("Smallest expected tension: {} N ({}).", significant(smallest, 4), row.output));
    [Some(columns), dash, weakest].into_iter().flatten().collect::<Vec<_>>().join("\n")
}
