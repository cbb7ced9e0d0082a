//! Figures as files: what their SVG and PDF contain.

use super::drawing::{Drawing, Item};
use super::{
    Figure, FigureContent, Size, of_clearance, of_compare, of_decay, of_frf, of_gust, of_loads, of_modes, of_payload,
    of_speeds, of_statics, of_trajectory, of_winches, style::Type, width_mm,
};
use funicular::robot::Robot;
use funicular_study::{Request, Results, Silent, run};
use serde_json::json;

mod measured;

fn request_of(request: serde_json::Value) -> Request {
    request_about(funicular_robots::YUAN2014_4MM, request)
}

fn request_about(robot: &str, mut request: serde_json::Value) -> Request {
    request["robot"] = json!({"name": "robot.toml", "text": robot});
    Request::from_json(&request.to_string()).unwrap()
}

fn made(request: serde_json::Value, mode: Option<usize>) -> Figure {
    match &request_of(request) {
        Request::Statics(of) => of_statics(of).unwrap(),
        Request::Modes(of) => of_modes(of, mode).unwrap().figure,
        Request::Frf(of) => of_frf(of, &mut Silent).unwrap().figure,
        request => of_results(request, funicular_robots::YUAN2014_4MM).unwrap(),
    }
}

/// Figure of the results of a command.
fn of_results(request: &Request, robot: &str) -> anyhow::Result<Figure> {
    Ok(match run(request, &mut Silent).unwrap() {
        Results::Compare(found) => of_compare(&found),
        Results::Winches(found) => {
            let Request::Winches(asked) = request else { panic!("the request is of winches") };
            of_winches(&found, asked.offers.as_deref().unwrap_or_default())
        }
        Results::Speeds(found) => of_speeds(&found),
        Results::Payload(found) => of_payload(&found)?,
        Results::Loads(found) => of_loads(&found)?,
        Results::Clearance(found) => of_clearance(&found)?,
        Results::Trajectory(found) => of_trajectory(&Robot::from_toml(robot).unwrap(), &found),
        Results::Settle(found) => of_decay(&found),
        Results::Gust(found) => of_gust(&found),
        _ => panic!("a command without a figure here"),
    })
}

/// Figures of the robot with winches, which has eight cables.
fn of_winch_robot(command: &str) -> Figure {
    let mut request = match command {
        "winches" => json!({
            "required_velocity_m_s": [1.0, 1.0, 0.5], "required_acceleration_m_s2": [2.0, 2.0, 1.0],
            "offers": [
                {"name": "small", "tension_n": 500.0, "speed_m_s": 3.0, "power_w": 900.0},
                {"name": "far too large", "tension_n": 1e6},
            ],
        }),
        "speeds" => json!({"required_velocity_m_s": [1.0, 1.0, 0.5]}),
        "loads" => json!({"required_force_n": [150.0, 150.0, 150.0], "required_moment_n_m": [30.0, 30.0, 30.0]}),
        "trajectory" => json!({"move_to": [2.0, 1.0, 1.5], "speed_m_s": 1.0, "acceleration_m_s2": 1.0}),
        _ => json!({}),
    };
    request["command"] = json!(command);
    request["pose"] = json!([1.0, 1.0, 1.5]);
    let robot = funicular_robots::COGIRO_WINCHES;
    of_results(&request_about(robot, request), robot).unwrap()
}

fn response() -> Figure {
    let request = json!({
        "command": "frf", "from_hz": 0.1, "to_hz": 10.0, "points": 1200, "input": "fz", "output": "az",
    });
    made(request, None)
}

fn all() -> Vec<(&'static str, Figure)> {
    vec![
        ("statics", made(json!({"command": "statics"}), None)),
        ("modes", made(json!({"command": "modes", "below_hz": 6.0}), None)),
        ("shape", made(json!({"command": "modes", "below_hz": 2.0}), Some(2))),
        ("frf", response()),
        ("compare", made(json!({"command": "compare", "below_hz": 3.0}), None)),
        ("winches", of_winch_robot("winches")),
        ("speeds", of_winch_robot("speeds")),
        ("loads", of_winch_robot("loads")),
        ("payload", of_winch_robot("payload")),
        ("clearance", of_winch_robot("clearance")),
        ("trajectory", of_winch_robot("trajectory")),
        ("settle", made(json!({"command": "settle", "release_n": [0.0, 0.0, -20.0], "below_hz": 5.0}), None)),
    ]
}

fn size(width_mm: f64, font_size_pt: f64) -> Size {
    Size::new(Some(width_mm), Some(font_size_pt)).unwrap()
}

/// Box of every text on the page: left, top, right, bottom, and the text.
fn boxes(drawing: &Drawing) -> Vec<([f64; 4], String)> {
    let texts = drawing.items.iter().filter_map(|item| match item {
        Item::Text(text) => Some(text),
        Item::Path(_) | Item::Moving(_) => None,
    });
    texts
        .map(|text| {
            let (sin, cos) = text.angle.to_radians().sin_cos();
            let width = drawing.width_of(&text.label, text.size);
            let height = drawing.font.capital_height() * text.size;
            let corner =
                |along: f64, up: f64| [text.at[0] + along * cos - up * sin, text.at[1] - along * sin - up * cos];
            let corners = [corner(0.0, 0.0), corner(width, 0.0), corner(0.0, height), corner(width, height)];
            let low = |k: usize| corners.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min);
            let high = |k: usize| corners.iter().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max);
            let words = text.label.0.iter().map(|run| run.0.as_str()).collect();
            ([low(0), low(1), high(0), high(1)], words)
        })
        .collect()
}

#[test]
fn charts_have_no_overlapping_texts_and_none_beyond_the_page() {
    for (name, figure) in all() {
        let FigureContent::Chart(chart) = &figure.0 else { continue };
        for (width, font) in [(40.0, 6.0), (84.0, 8.0), (88.0, 8.0), (88.0, 10.0), (181.0, 8.0), (190.0, 10.0)] {
            let points = width * super::POINTS;
            let drawing = chart.draw(points, &Type::new(font));
            let texts = boxes(&drawing);
            assert!(texts.len() > 8, "{name}");
            for (i, (a, one)) in texts.iter().enumerate() {
                let inside = a[0] > -0.5 && a[1] > -0.5 && a[2] < points + 0.5 && a[3] < drawing.height + 0.5;
                assert!(inside, "{name} at {width} mm, {font} pt: \"{one}\" at {a:?} leaves the page");
                for (b, other) in &texts[..i] {
                    let apart = a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1];
                    assert!(apart, "{name} at {width} mm, {font} pt: \"{one}\" {a:?} covers \"{other}\" {b:?}");
                }
            }
        }
    }
}

#[test]
fn an_svg_has_its_size_and_its_texts_and_is_xml() {
    for (name, figure) in all() {
        let svg = figure.svg(size(88.0, 8.0));
        let tree = roxmltree::Document::parse(&svg).unwrap_or_else(|error| panic!("{name}: {error}"));
        let root = tree.root_element();
        assert_eq!(root.attribute("width"), Some("88mm"), "{name}");
        let of = |tag: &str| root.descendants().filter(|node| node.has_tag_name(tag)).count();
        assert!(of("path") > 3 && of("text") > 8, "{name}");
        assert_eq!(of("image"), 0, "{name}: only lines and texts");
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}");
        assert_eq!(svg, figure.svg(size(88.0, 8.0)), "the same bytes again");
    }
    let text = response().svg(size(88.0, 8.0));
    for part in ["frequency [Hz]", "magnitude [(m/s²)/N]", "phase [°]", "az / fz", "cable mode"] {
        assert!(text.contains(&format!(">{part}</text>")), "{part}");
    }
}

#[test]
fn the_drawn_response_has_the_peak_where_the_result_has_it() {
    let figure = response();
    let FigureContent::Chart(chart) = &figure.0 else { panic!("a chart") };
    let drawing = chart.draw(250.0, &Type::new(8.0));
    // The highest peak has a number: 9.37 Hz, as in the table of `frf`. It stands above the top of the curve.
    let texts = boxes(&drawing);
    let (label, _) = texts.iter().find(|(_, text)| text == "9.37").expect("the number of the highest peak");
    let curve = drawing.items.iter().filter_map(|item| match item {
        Item::Path(path) if path.stroke.as_ref() == Some(&super::style::curve(0)) => Some(&path.lines),
        _ => None,
    });
    // The second path is the curve; the first is the sample in the legend.
    let top = curve.skip(1).flatten().flatten().copied().min_by(|a, b| a[1].total_cmp(&b[1])).unwrap();
    let middle = 0.5 * (label[0] + label[2]);
    assert!((middle - top[0]).abs() < 0.5, "the number at {middle} stands over the peak at {}", top[0]);
    assert!(label[3] < top[1], "above the peak");
}

#[test]
fn a_pdf_is_one_page_with_an_embedded_font() {
    for (name, figure) in all() {
        let pdf = figure.pdf(size(88.9, 8.0));
        let text = String::from_utf8_lossy(&pdf);
        assert!(text.starts_with("%PDF-1.7") && text.trim_end().ends_with("%%EOF"), "{name}");
        for part in ["/FontFile2", "/Identity-H", "/ToUnicode", "+NotoSans", "/Count 1"] {
            assert!(text.contains(part), "{name}: {part}");
        }
        assert!(text.contains("/MediaBox [0 0 252 "), "{name}: 88.9 mm are 252 pt");
        assert!(pdf.len() < 60_000, "{name}: {} bytes", pdf.len());
        assert_eq!(pdf, figure.pdf(size(88.9, 8.0)), "the same bytes again");
    }
}

#[test]
fn columns_of_journals_have_names_and_sizes_have_limits() {
    assert_eq!(width_mm("ieee-single"), Ok(88.9));
    assert_eq!(width_mm(" 120.5"), Ok(120.5));
    assert!(width_mm("ieee").unwrap_err().contains("ieee-single (88.9)"));
    assert!(width_mm("NaN").is_err());
    for (width, font, says) in [
        (Some(30.0), None, "40 to 1000 mm"),
        (Some(f64::NAN), None, "figure_width_mm"),
        (Some(-3.0), None, "not positive"),
        (None, Some(2.0), "4 to 40 pt"),
        (Some(88.0), Some(30.0), "at most 15 pt"),
    ] {
        let said = Size::new(width, font).unwrap_err().to_string();
        assert!(said.contains(says), "{said}");
    }
}

#[test]
fn a_mode_that_is_not_in_the_list_is_refused() {
    let Request::Modes(request) = request_of(json!({"command": "modes", "below_hz": 2.0})) else {
        panic!("the request is of modes")
    };
    for mode in [0, 99] {
        let said = of_modes(&request, Some(mode)).err().unwrap();
        assert!(said.to_string().contains("give 1 to 8"), "{said}");
    }
}

/// Corners of the areas of a panel.
fn areas(figure: &Figure, panel: usize) -> Vec<Vec<(f64, f64)>> {
    let FigureContent::Chart(chart) = &figure.0 else { panic!("a chart") };
    let layers = chart.panels[panel].layers.iter().filter_map(|layer| match layer {
        super::chart::Layer::Areas { areas, .. } => Some(areas.clone()),
        _ => None,
    });
    layers.flatten().collect()
}

#[test]
fn bars_have_the_heights_of_the_results_and_far_offers_do_not_flatten_them() {
    let robot = funicular_robots::COGIRO_WINCHES;
    let request = request_about(robot, json!({"command": "winches", "pose": [1.0, 1.0, 1.5]}));
    let Results::Winches(found) = run(&request, &mut Silent).unwrap() else { panic!("winches") };
    let figure = of_winches(&found, &[]);
    let bars = areas(&figure, 0);
    assert_eq!(bars.len(), 8);
    for (bar, row) in bars.iter().zip(&found.winches[1..]) {
        let top = bar.iter().map(|corner| corner.1).fold(0.0, f64::max);
        assert!((top - row.tension_n).abs() < 1e-12 * row.tension_n);
    }
    // Without required velocities no winch needs a speed, an acceleration or power: tension, torque at rest and rope.
    let FigureContent::Chart(chart) = &figure.0 else { panic!("a chart") };
    let titles: Vec<&str> = chart.panels.iter().map(|panel| panel.y.title.as_str()).collect();
    assert_eq!(titles, ["tension [N]", "torque [N m]"]);

    let with_offers = of_winch_robot("winches");
    let FigureContent::Chart(chart) = &with_offers.0 else { panic!("a chart") };
    let high = areas(&with_offers, 0).iter().flatten().map(|corner| corner.1).fold(0.0, f64::max);
    assert!(chart.panels[0].y.high < 3.0 * high, "the bars are seen");
    let legend: Vec<&str> = chart.legend.iter().map(|entry| entry.text.as_str()).collect();
    assert_eq!(legend, ["needed", "offer small"], "an offer that no panel shows has no entry");
}

#[test]
fn swings_too_close_for_lines_are_an_area_below_their_crests() {
    let about = |below_hz: f64| {
        request_of(json!({
            "command": "settle", "release_n": [0.0, 0.0, -20.0], "below_hz": below_hz, "tolerance_m": 1e-4,
        }))
    };
    let Results::Settle(found) = run(&about(10.0), &mut Silent).unwrap() else { panic!("settle") };
    let figure = of_decay(&found);
    let area = areas(&figure, 0);
    let distances = found.history.iter().map(|row| 1e3 * row.x_m.hypot(row.y_m).hypot(row.z_m));
    let most = distances.fold(0.0, f64::max);
    assert_eq!(area.len(), 1, "{} rows", found.history.len());
    let top = area[0].iter().map(|corner| corner.1).fold(0.0, f64::max);
    assert!((top - most).abs() < 1e-12 * most, "the highest crest is kept");
    // Far fewer points than rows.
    assert!(area[0].len() <= 122 && found.history.len() > 1000, "{} {}", area[0].len(), found.history.len());
}

#[test]
fn results_without_anything_to_draw_are_refused_with_the_way_out() {
    let text = funicular_robots::YUAN2014_4MM;
    for (command, says) in [("loads", "nothing is required"), ("payload", "no tension limit bounds the payload")] {
        let said = of_results(&request_about(text, json!({"command": command})), text).err().unwrap().to_string();
        assert!(said.contains(says), "{said}");
    }
}
