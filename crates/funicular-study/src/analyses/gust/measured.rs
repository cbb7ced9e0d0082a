//! Measured spectra of the gusts.

use super::refuse_calm;
use crate::request::{NumberColumns, TurbulenceOptions};
use crate::table_fault::TableFault;
use crate::text::significant;
use anyhow::{Result, bail};
use funicular::robot::{MeasuredSpectrum, MeasuredSpectrumError, Robot, Turbulence, TurbulenceSpectrum};

/// Key of the table.
const KEY: &str = "spectrum";

/// Columns: frequency, and the densities along the mean wind, lateral and up.
const FREQUENCY: &str = "frequency_hz";
const DENSITIES: [&str; 3] = ["along_m2_s", "lateral_m2_s", "up_m2_s"];

/// Largest part by which the integral of a measured spectrum may differ from the variance of a given intensity: a
/// spectrum of Kaimal has a tenth of its variance above n = f L/U = 5, which few sensors reach.
const MAX_GAP: f64 = 0.1;

/// Checks the table of measured spectra.
///
/// # Errors
/// The first fault: a column that is missing or unknown, fewer than two rows, frequencies that do not rise, or a
/// negative density.
pub fn check(columns: &NumberColumns) -> Result<(), TableFault> {
    read(columns).map(drop)
}

fn read(columns: &NumberColumns) -> Result<MeasuredSpectrum, TableFault> {
    let names: Vec<String> = [FREQUENCY].iter().chain(&DENSITIES).map(|name| (*name).to_owned()).collect();
    TableFault::refuse_unknown(KEY, columns, &names, &format!("measured spectra have {}", names.join(", ")))?;
    if let Some(missing) = names.iter().find(|name| !columns.contains_key(*name)) {
        let text = format!("there is no column `{missing}`: a component that was not measured has zeros");
        return Err(TableFault::of_table(KEY, text));
    }
    TableFault::refuse_uneven(KEY, columns)?;

    let frequencies = &columns[FREQUENCY];
    let densities = (0..frequencies.len()).map(|row| DENSITIES.map(|name| columns[name][row])).collect();
    MeasuredSpectrum::new(frequencies.clone(), densities).map_err(|error| {
        let row = match error {
            MeasuredSpectrumError::Rows { .. } => None,
            MeasuredSpectrumError::Falling { row, .. } | MeasuredSpectrumError::Density { row, .. } => Some(row),
        };
        TableFault { key: KEY, row, text: error.to_string() }
    })
}

/// Turbulence with measured spectra: their integrals are its intensities.
///
/// # Errors
/// A [`TableFault`], an option of another spectrum, or an intensity that is not that of the spectra.
pub(super) fn turbulence(robot: &Robot, columns: &NumberColumns, options: &TurbulenceOptions) -> Result<Turbulence> {
    let measured = read(columns)?;
    refuse_calm(robot)?;
    for (name, given) in
        [("turbulence", options.turbulence.is_some()), ("length_scale_m", options.length_scale_m.is_some())]
    {
        if given {
            bail!("give ⟪{name}⟫ or ⟪spectrum⟫, not both: measured spectra have their shape and their scales");
        }
    }
    let speed = robot.wind.velocity_w.norm();
    let intensity = [0, 1, 2].map(|component| measured.variance(component).sqrt() / speed);
    for (component, (own, given)) in intensity.iter().zip(options.intensity.unwrap_or(intensity)).enumerate() {
        if (own * own - given * given).abs() > MAX_GAP * given * given {
            bail!(
                "⟪intensity⟫ {} of the gusts of `{}` and their spectrum differ: it integrates to the intensity {} at \
                 {} m/s; check its unit, m²/s² per Hz and one-sided, and the mean wind, or leave ⟪intensity⟫ out",
                significant(given, 3),
                DENSITIES[component],
                significant(*own, 3),
                significant(speed, 4)
            );
        }
    }
    if intensity.iter().any(|part| *part >= Turbulence::MAX_INTENSITY) {
        bail!(
            "⟪spectrum⟫ integrates to the intensities {} at {} m/s, and each must be below {}: the wind would turn \
             round now and then; check its unit and the mean wind",
            intensity.map(|part| significant(part, 3)).join(", "),
            significant(speed, 4),
            Turbulence::MAX_INTENSITY
        );
    }
    let of_file = robot.turbulence.as_ref();
    let decay = of_file.map_or(Turbulence::COHERENCE_DECAY, |of| of.coherence_decay);
    Ok(Turbulence {
        // Shape and scales are not used.
        spectrum: TurbulenceSpectrum::Kaimal,
        length_scale: [0.0; 3],
        intensity,
        coherence_decay: options.coherence_decay.unwrap_or(decay),
        is_frozen: of_file.is_none_or(|of| of.is_frozen),
        measured: Some(measured),
    })
}

/// Warning if the measured spectra end below the limit of the frequencies [Hz].
pub(super) fn caveat(robot: &Robot, limit: f64) -> Option<String> {
    let last = *robot.turbulence.as_ref()?.measured.as_ref()?.frequencies_hz().last()?;
    (last < limit).then(|| {
        format!(
            "the measured spectra end at {} Hz, below the limit {} Hz of the frequencies: the response to faster gusts \
             is left out",
            significant(last, 4),
            significant(limit, 4)
        )
    })
}
