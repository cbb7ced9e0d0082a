//! Derivatives of the first frequencies by the numbers of the robot file, as bars: what moves them.

use crate::pages::figure::{PageFigure, axis, colour, plain, rounded};
use funicular::dynamics::Dynamics;
use funicular::gradient::{Gradients, Hold};
use funicular::modes::Modes;
use funicular_study::analyses::gradient::{GradientColumns, meaning};
use funicular_study::at_rest::AtRest;
use funicular_study::text::short;
use serde_json::json;

/// Number of frequencies and of numbers in the figure.
const FREQUENCIES: usize = 4;
const NUMBERS: usize = 14;

/// Colours of the frequencies, the first one darkest.
const COLOURS: [&str; FREQUENCIES] = [colour::BLACK, colour::BLUE, colour::SKY, colour::ORANGE];

/// Bars of the changes of the first frequencies over the tolerance of each number, or the reason why there are none.
pub(super) fn first_frequencies(
    at_rest: &AtRest,
    robot_text: &str,
    dynamics: &Dynamics,
    found: &Modes,
) -> Result<PageFigure, String> {
    let columns = GradientColumns::of(at_rest, robot_text, &[], &[]).map_err(|error| error.to_string())?;
    let gradients = Gradients::new(&at_rest.robot, &at_rest.equilibrium, Hold::Lengths).map_err(|e| e.to_string())?;
    let vibration = gradients.vibration(dynamics).map_err(|error| error.to_string())?;

    // Frequencies that modes share have no single derivative.
    let simple = found.modes.iter().filter(|mode| mode.multiplicity == 1).take(FREQUENCIES);
    let mut effects: Vec<(f64, Vec<f64>)> = Vec::new();
    for mode in simple {
        let gradient = vibration.frequency(mode).map_err(|error| error.to_string())?;
        let of_number = columns.changes.iter().zip(&columns.parameters);
        effects.push((
            mode.frequency_hz,
            of_number.map(|(change, number)| gradient.dot(change) * number.tolerance).collect(),
        ));
    }
    if effects.is_empty() {
        return Err("no frequency below the limit belongs to one mode alone".to_owned());
    }

    // Numbers by their largest effect; plotly counts rows from below.
    let largest = |k: usize| effects.iter().fold(0.0_f64, |largest, (_, of)| largest.max(of[k].abs()));
    let mut order: Vec<(f64, usize)> = (0..columns.parameters.len()).map(|k| (largest(k), k)).collect();
    order.sort_by(|a, b| b.0.total_cmp(&a.0));
    order.truncate(NUMBERS);
    order.reverse();
    let label = |k: usize| {
        let number = &columns.parameters[k];
        plain(&format!("{} (±{} {})", number.path, short(number.tolerance, 3), number.unit))
    };
    let labels: Vec<String> = order.iter().map(|(_, k)| label(*k)).collect();

    let bars: Vec<_> = (effects.iter().zip(COLOURS))
        .map(|((hz, of), colour)| {
            let values: Vec<f64> = order.iter().map(|(_, k)| 1e3 * of[*k]).collect();
            json!({
                "type": "bar", "orientation": "h", "name": format!("{} Hz", short(*hz, 4)), "x": rounded(&values),
                "y": labels,
                "marker": {"color": colour},
            })
        })
        .collect();
    let caption = format!(
        "What moves the first frequencies: their changes, if one number changes by its tolerance. The numbers with the \
         largest changes are shown. \
         Positions and lengths have a tolerance of 1 mm, angles 0.1°, other values 1 %; {}. `funicular gradient` gives \
         all derivatives.",
        meaning(at_rest, Hold::Lengths)
    );
    let layout = json!({
        "barmode": "group",
        "xaxis": axis("change of the frequency [mHz]", json!({"zeroline": true, "zerolinecolor": "#444444"})),
        "yaxis": axis("", json!({"automargin": true})),
    });
    Ok(PageFigure::new("figure-gradients", 560, caption.replace('`', ""), &bars, layout))
}
