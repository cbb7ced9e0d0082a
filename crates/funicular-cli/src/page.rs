//! Pages in HTML that open offline: one file with its figures, its numbers and the library that draws them.
//!
//! A page is a template of prose ([`report`], [`paper`]) into which [`figure::Figure`]s and [`table::Table`]s are set.
//! Nothing on it depends on the time, on chance or on the network: two runs write the same bytes.

pub(crate) mod figure;
pub(crate) mod paper;
pub(crate) mod report;
pub(crate) mod table;

use plotly::Plot;

/// What every page has around its own content.
pub(crate) struct Shell {
    /// Title of the page.
    pub(crate) title: String,
    /// (id, name) of the sections, for the list of contents.
    pub(crate) contents: &'static [(&'static str, &'static str)],
    version: &'static str,
    style: &'static str,
    script: &'static str,
    bundle: String,
}

impl Shell {
    /// Of a page with this title and these sections.
    pub(crate) fn new(title: String, contents: &'static [(&'static str, &'static str)]) -> Self {
        Self {
            title,
            contents,
            version: env!("CARGO_PKG_VERSION"),
            style: include_str!("../templates/page.css"),
            script: include_str!("../templates/page.js"),
            bundle: plotly_script(),
        }
    }
}

/// The `<script>` that holds plotly.js.
///
/// The crate hands out plotly.js and `MathJax` together; formulas here are plain text, so the second, of 2 MB, stays out.
fn plotly_script() -> String {
    const END: &str = "</script>";
    let mut sources = Plot::offline_js_sources();
    let end = sources.find(END).map_or(sources.len(), |at| at + END.len());
    sources.truncate(end);
    sources
}

#[cfg(test)]
mod tests {
    use super::paper::paper;
    use super::plotly_script;
    use super::report::{ReportInput, report};
    use crate::state::AtRest;
    use funicular::cable::CableModel;
    use funicular::dynamics::Linearisation;
    use funicular::math::Vec3;
    use funicular::response::{Direction, Quantity};
    use funicular::robot::{Robot, State};
    use funicular::statics::{Equilibrium, StaticModel, forward};

    const YUAN: &str = include_str!("../../../robots/yuan2014-4mm.toml");
    const COGIRO: &str = include_str!("../../../robots/cogiro.toml");
    const POINT_MASS: &str = include_str!("../../../robots/sap2000-8-cable-point-mass.toml");

    fn rest(robot: &Robot, model: StaticModel) -> Equilibrium {
        let State::Lengths(lengths) = &robot.state else { panic!("the file gives lengths") };
        forward(robot, lengths, model, None).unwrap()
    }

    fn page_of(text: &str, model: StaticModel) -> String {
        page_with(text, model, Linearisation { cable_model: CableModel::ClosedForm, ..Default::default() })
    }

    fn page_with(text: &str, model: StaticModel, linearisation: Linearisation) -> String {
        let robot = Robot::from_toml(text).unwrap();
        let equilibrium = rest(&robot, model);
        let up = Direction::Along { direction_w: Vec3::z(), point_p: Vec3::zeros() };
        let u = up.vector(&equilibrium.pose);
        report(&ReportInput {
            at_rest: &AtRest { robot, equilibrium, instead_of: None },
            file_label: "robot.toml",
            robot_text: text,
            linearisation,
            below_hz: 20.0,
            frf_input: ("a vertical force".to_owned(), u),
            frf_output: ("the vertical acceleration".to_owned(), u, Quantity::Acceleration),
            frf_unit: "(m/s²)/N",
            command_line: "funicular report robot.toml".to_owned(),
        })
        .unwrap()
        .html
    }

    /// The page without plotly.js, after a check that it is there once.
    fn own_part(page: &str) -> String {
        let bundle = plotly_script();
        let parts: Vec<&str> = page.split(bundle.as_str()).collect();
        assert_eq!(parts.len(), 2, "plotly.js is on the page once");
        assert_eq!(page.matches("plotly.js v").count(), 1);
        parts.concat()
    }

    fn loads_nothing(own: &str) {
        for banned in ["<script src", "<link", "@import", "url(", "<img", "<iframe", "src=\"", "href=\"http"] {
            assert!(!own.contains(banned), "{banned}");
        }
    }

    #[test]
    fn a_report_carries_all_it_needs_and_has_every_section() {
        for text in [YUAN, COGIRO, POINT_MASS] {
            let page = page_of(text, StaticModel::Catenary);
            assert!(page.len() < 6_000_000, "{}", page.len());
            let own = own_part(&page);
            loads_nothing(&own);
            for (id, _) in super::report::CONTENTS {
                assert!(own.contains(&format!("<section id=\"{id}\">")), "{id}");
            }
            for id in
                ["figure-robot", "figure-platform", "figure-tensions", "figure-sag", "figure-modes", "figure-response"]
            {
                assert!(own.contains(&format!("id=\"{id}-plot\"")), "{id}");
            }
        }
    }

    #[test]
    fn the_paper_carries_all_it_needs_and_has_every_section() {
        let page = paper("funicular paper".to_owned()).unwrap();
        assert!(page.len() < 6_000_000, "{}", page.len());
        let own = own_part(&page);
        loads_nothing(&own);
        for (id, _) in super::paper::CONTENTS {
            assert!(own.contains(&format!("<section id=\"{id}\">")), "{id}");
        }
        assert!(own.contains("identified by us"));
    }

    #[test]
    fn two_runs_write_the_same_bytes() {
        assert_eq!(page_of(YUAN, StaticModel::Catenary), page_of(YUAN, StaticModel::Catenary));
        assert_eq!(paper("funicular paper".to_owned()).unwrap(), paper("funicular paper".to_owned()).unwrap());
    }

    #[test]
    fn names_from_the_robot_file_stay_text() {
        let text = YUAN
            .replace("INSA Rennes", "</script><script>alert(1)</script>")
            .replace("name = \"1\"", "name = \"</script><b>&\"");
        let own = own_part(&page_of(&text, StaticModel::Catenary));
        assert!(!own.contains("<script>alert") && !own.contains("<b>"));
        assert!(own.contains("&#60;script&#62;alert(1)"));
        // Every element that a figure's description opens is closed by its own end tag.
        assert_eq!(own.matches("<script").count(), own.matches("</script>").count());
    }

    #[test]
    fn every_model_has_a_report() {
        let page = page_of(YUAN, StaticModel::Spring);
        assert!(own_part(&page).contains("straight elastic cables"));
        for cable_model in CableModel::ALL {
            let linearisation = Linearisation { cable_model, in_plane_only: true, ..Linearisation::default() };
            let page = page_with(YUAN, StaticModel::Catenary, linearisation);
            assert!(own_part(&page).contains("cables stiff in their planes only"), "{cable_model}");
        }
        // Ideal cables may push; then only the model that asks for no tension is left.
        let linearisation = Linearisation { cable_model: CableModel::Spring, ..Linearisation::default() };
        let page = page_with(YUAN, StaticModel::Ideal, linearisation);
        assert!(own_part(&page).contains("Ideal cables are rigid"));
    }

    #[test]
    fn every_figure_is_json_with_traces() {
        for page in [page_of(COGIRO, StaticModel::Catenary), paper("funicular paper".to_owned()).unwrap()] {
            let own = own_part(&page);
            let mut figures = 0;
            for part in own.split("<script type=\"application/json\"").skip(1) {
                let json = part.split_once('>').unwrap().1.split("</script>").next().unwrap();
                let figure: serde_json::Value = serde_json::from_str(json).unwrap();
                assert!(!figure["data"].as_array().unwrap().is_empty());
                figures += 1;
            }
            assert!(figures >= 6);
        }
    }
}
