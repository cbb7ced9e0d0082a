//! Figures of `winches` and `speeds`: bars over the cables, with the winches on offer and the limits of the winches.

use super::bars::{self, BarMarks, BarPanel, Bars};
use super::chart::Chart;
use super::drawing::{BLACK, Colour, Stroke};
use super::style::{self, AXIS_WIDTH, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY};
use funicular_study::analyses::speeds::{CableSpeeds, Speeds, WinchInUse};
use funicular_study::analyses::winches::{WinchRow, Winches};
use funicular_study::request::OfferedWinch;

/// Maximum number of winches on offer that are drawn: with more no line is found again.
const MAX_OFFERS: usize = 4;

/// Height of a panel relative to the width of the figure.
const HEIGHT: f64 = 0.22;

/// Quantity of a winch: its title, the number of a row, and that of an offer.
type Quantity = (&'static str, fn(&WinchRow) -> Option<f64>, fn(&OfferedWinch) -> Option<f64>);

const QUANTITIES: [Quantity; 7] = [
    ("tension [N]", |row| Some(row.tension_n), |of| of.tension_n),
    ("speed [m/s]", |row| Some(row.speed_m_s), |of| of.speed_m_s),
    ("acceleration [m/s²]", |row| Some(row.acceleration_m_s2), |of| of.acceleration_m_s2),
    ("torque [N m]", |row| row.torque_n_m, |of| of.torque_n_m),
    ("power [W]", |row| Some(row.power_w), |of| of.power_w),
    ("braking [W]", |row| Some(row.brake_power_w), |of| of.brake_power_w),
    ("rope [m]", |row| Some(row.rope_m), |of| of.rope_m),
];

/// Needs of every winch, and what those on offer give. A quantity that no winch needs has no panel.
pub(super) fn needed(found: &Winches, offers: &[OfferedWinch]) -> Chart {
    // The first row is the winch that serves every cable.
    let cables = &found.winches[1..];
    let names: Vec<String> = cables.iter().map(|row| row.name.clone()).collect();
    let panel = |(title, need, gives): Quantity| {
        let values: Vec<Option<f64>> = cables.iter().map(need).collect();
        values.iter().flatten().any(|value| *value > 0.0).then(|| BarPanel {
            title: title.to_owned(),
            bars: vec![Bars { text: "needed".to_owned(), colour: BLUE, values }],
            marks: offers
                .iter()
                .take(MAX_OFFERS)
                .enumerate()
                .map(|(k, offer)| {
                    let values = vec![gives(offer); cables.len()];
                    BarMarks { text: format!("offer {}", offer.name), stroke: style::curve(k + 1), values }
                })
                .collect(),
        })
    };
    let panels: Vec<BarPanel> = QUANTITIES.into_iter().filter_map(panel).collect();
    bars::chart(format!("{}: winches", found.robot), "winch of cable", &names, &panels, HEIGHT)
}

/// Speeds, powers and used parts of the winches for the required velocities, and the speeds that the limits allow.
pub(super) fn speeds(found: &Speeds) -> Chart {
    let cables = &found.cables;
    let names: Vec<String> = cables.iter().map(|row| row.name.clone()).collect();
    let each = |of: &dyn Fn(&CableSpeeds) -> Option<f64>| -> Vec<Option<f64>> { cables.iter().map(of).collect() };
    let in_use = |of: fn(&WinchInUse) -> Option<f64>| each(&|row| row.required.as_ref().and_then(of));
    let bars = |text: &str, colour: Colour, values| Bars { text: text.to_owned(), colour, values };
    let line = |dashes: Vec<f64>| Stroke { dashes, ..Stroke::solid(BLACK, 2.0 * AXIS_WIDTH) };
    let marks = |text: &str, dashes, values| BarMarks { text: text.to_owned(), stroke: line(dashes), values };
    let asks = found.required.is_some();

    let mut panels = vec![BarPanel {
        title: "rope at the drum [m/s]".to_owned(),
        bars: if asks {
            vec![bars("for the required velocities", BLUE, in_use(|of| Some(of.speed_m_s)))]
        } else {
            Vec::new()
        },
        marks: vec![
            marks("limit winding in", Vec::new(), each(&|row| row.speed_max_in_m_s)),
            marks("limit paying out", vec![3.0, 1.5], each(&|row| row.speed_max_out_m_s)),
        ],
    }];
    if asks {
        panels.push(BarPanel {
            title: "power [W]".to_owned(),
            bars: vec![
                bars("motor drives", ORANGE, in_use(|of| Some(of.driving_power_w))),
                bars("motor brakes", SKY, in_use(|of| Some(of.braking_power_w))),
            ],
            marks: Vec::new(),
        });
        let used = vec![
            bars("of speed", GREEN, in_use(|of| of.used_speed)),
            bars("of torque", PURPLE, in_use(|of| of.used_torque)),
            bars("of power", ORANGE, in_use(|of| of.used_power)),
            bars("of brake", SKY, in_use(|of| of.used_brake_power)),
        ];
        let used: Vec<Bars> = used.into_iter().filter(|bars| bars.values.iter().any(Option::is_some)).collect();
        if !used.is_empty() {
            let whole = marks("whole limit", vec![1.0, 1.5], vec![Some(1.0); cables.len()]);
            panels.push(BarPanel { title: "used part".to_owned(), bars: used, marks: vec![whole] });
        }
    }
    panels.push(BarPanel {
        title: "rope per platform".to_owned(),
        bars: vec![bars(
            "speed of the rope per speed of the platform, at most",
            GREY,
            each(&|row| Some(row.rate_per_velocity.iter().map(|rate| rate * rate).sum::<f64>().sqrt())),
        )],
        marks: Vec::new(),
    });
    let has_values = |panel: &BarPanel| {
        let values = panel.bars.iter().map(|of| &of.values).chain(panel.marks.iter().map(|of| &of.values));
        values.flatten().any(Option::is_some)
    };
    panels.retain(has_values);
    bars::chart(format!("{}: speeds", found.robot), "cable", &names, &panels, HEIGHT)
}
