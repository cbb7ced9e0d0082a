//! HTML pages that work offline: one file with figures, numbers and the library that draws the figures.
//!
//! A page is a text template ([`report`], [`paper`], [`plot`]) with figures and tables, or the page of scripts/web with
//! a robot in it ([`live`]). It does not depend on the time, on random numbers or on the network: two runs write the
//! same bytes.

pub mod calibrate;
pub mod design;
pub mod estimate;
pub(crate) mod figure;
pub mod identify;
pub mod live;
pub mod paper;
pub mod plot;
pub mod prove;
pub mod report;
pub mod settle;
pub mod simulate;
pub mod summary;
pub(crate) mod table;
pub mod trajectory;
pub mod uncertainty;
pub mod winches;
pub mod workspace;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use flate2::Compression;
use flate2::write::GzEncoder;
use std::borrow::Cow;
use std::io::Write as _;

/// plotly.js, [`packed`] at build time.
const PLOTLY: &str = include_str!(concat!(env!("OUT_DIR"), "/plotly.js.gz.base64"));

/// Common parts of every page around its own content.
pub(crate) struct Shell {
    /// Title of the page.
    pub(crate) title: String,
    /// Sections (id, name) for the list of contents.
    pub(crate) contents: Cow<'static, [(&'static str, &'static str)]>,
    version: &'static str,
    style: &'static str,
    script: &'static str,
    plotly: &'static str,
}

impl Shell {
    /// Shell of a page with this title and these sections.
    pub(crate) fn new(title: String, contents: impl Into<Cow<'static, [(&'static str, &'static str)]>>) -> Self {
        Self {
            title,
            contents: contents.into(),
            version: env!("CARGO_PKG_VERSION"),
            style: include_str!("../templates/page.css"),
            script: concat!(include_str!("../templates/space.js"), include_str!("../templates/page.js")),
            plotly: PLOTLY,
        }
    }
}

/// Packs bytes for the page's script: gzip in base64. Base64 text cannot end an element of the page.
pub(crate) fn packed(bytes: &[u8]) -> String {
    const INTO_MEMORY: &str = "writing to memory cannot fail";
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes).expect(INTO_MEMORY);
    BASE64.encode(encoder.finish().expect(INTO_MEMORY))
}

/// The inverse of [`packed`].
#[cfg(test)]
pub(crate) fn unpacked(text: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    let packed = BASE64.decode(text.trim()).unwrap();
    std::io::Read::read_to_end(&mut flate2::read::GzDecoder::new(packed.as_slice()), &mut bytes).unwrap();
    bytes
}

#[cfg(test)]
mod tests {
    use super::figure::shapes::Shapes;
    use super::paper::paper;
    use super::report::{ReportInput, report};
    use super::{PLOTLY, unpacked};
    use funicular::cable::CableModel;
    use funicular::dynamics::{Dynamics, Linearisation};
    use funicular::math::Vec3;
    use funicular::modes;
    use funicular::response::{self, Quantity};
    use funicular::robot::{Robot, State};
    use funicular::statics::{Equilibrium, StaticModel, forward};
    use funicular_study::at_rest::AtRest;

    const YUAN: &str = funicular_robots::YUAN2014_4MM;
    const COGIRO: &str = funicular_robots::COGIRO;
    const POINT_MASS: &str = funicular_robots::SAP2000_8_CABLE_POINT_MASS;

    fn rest(robot: &Robot, model: StaticModel) -> Equilibrium {
        let State::Lengths(lengths) = &robot.state else { panic!("the file gives lengths") };
        forward(robot, lengths, model, None).unwrap()
    }

    fn page_of(text: &str, model: StaticModel) -> String {
        page_with(text, model, Linearisation { cable_model: CableModel::ShallowDynamic, ..Default::default() })
    }

    fn page_with(text: &str, model: StaticModel, linearisation: Linearisation) -> String {
        let robot = Robot::from_toml(text).unwrap();
        let equilibrium = rest(&robot, model);
        let u = response::along(&Vec3::z(), &Vec3::zeros(), &equilibrium.pose);
        report(&ReportInput {
            platform_share: funicular::modes::PLATFORM_SHARE,
            at_rest: &AtRest { robot, equilibrium, requested_pose: None, rule: None, held_pose: None },
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

    /// Page without plotly.js, after a check that plotly.js is there exactly once.
    fn own_part(page: &str) -> String {
        let parts: Vec<&str> = page.split(PLOTLY).collect();
        assert_eq!(parts.len(), 2, "plotly.js is on the page once");
        parts.concat()
    }

    #[test]
    fn plotly_is_packed_completely_and_without_anything_else() {
        let script = String::from_utf8(unpacked(PLOTLY)).unwrap();
        assert!(script.trim_start().starts_with("/**\n* plotly.js v"), "{}", &script[..80]);
        assert!(script.contains("scatter3d") && !script.contains("MathJax = {"));
        assert!(PLOTLY.len() < 2_000_000, "{}", PLOTLY.len());
    }

    fn loads_nothing(own: &str) {
        for banned in ["<script src", "<link", "@import", "url(", "<img", "<iframe", "src=\"", "href=\"http"] {
            assert!(!own.contains(banned), "{banned}");
        }
    }

    #[test]
    fn a_report_is_self_contained_and_has_every_section() {
        for text in [YUAN, COGIRO, POINT_MASS] {
            let page = page_of(text, StaticModel::Catenary);
            assert!(page.len() < 5_000_000, "{}", page.len());
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
    fn the_paper_is_self_contained_and_has_every_section() {
        let page = paper("funicular paper".to_owned()).unwrap();
        assert!(page.len() < 5_000_000, "{}", page.len());
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
        // Every script element is closed by its own end tag.
        assert_eq!(own.matches("<script").count(), own.matches("</script>").count());
    }

    #[test]
    fn every_model_has_a_report() {
        let page = page_of(YUAN, StaticModel::Spring);
        assert!(own_part(&page).contains("straight elastic cables"));
        for cable_model in CableModel::ALL {
            let linearisation = Linearisation { cable_model, in_plane_only: true, ..Linearisation::default() };
            let page = page_with(YUAN, StaticModel::Catenary, linearisation);
            assert!(own_part(&page).contains("cables with in-plane stiffness only"), "{cable_model}");
        }
        // The model shallow-dynamic has no motion along the cables; the page names a model that has.
        let shallow_dynamic = own_part(&page_of(YUAN, StaticModel::Catenary));
        assert!(
            shallow_dynamic.contains("Mode shapes are not shown")
                && shallow_dynamic.contains("--cable-model catenary-dynamic</code>")
        );
        assert!(!shallow_dynamic.contains("id=\"shapes-data\""));
        // Ideal cables have no stiffness of their own; of the models for modes only spring works with them.
        let linearisation = Linearisation { cable_model: CableModel::Spring, ..Linearisation::default() };
        let page = page_with(YUAN, StaticModel::Ideal, linearisation);
        assert!(own_part(&page).contains("Ideal cables are inextensible"));
    }

    #[test]
    fn a_page_with_many_modes_limits_its_size_and_reports_it() {
        let robot = Robot::from_toml(YUAN).unwrap();
        let equilibrium = rest(&robot, StaticModel::Catenary);
        let dynamics = Dynamics::about(&robot, &equilibrium, Linearisation::default(), 150.0).unwrap();
        let found = modes::below(&dynamics, 150.0);
        let shapes = Shapes::new(&robot, &equilibrium, &dynamics, &found).unwrap().unwrap().to_string();
        assert!(shapes.len() < 2_000_000, "{}", shapes.len());
        let note = shapes.split_once("shows the shapes of the lowest ").unwrap().1;
        let shown: usize = note.split(' ').next().unwrap().parse().unwrap();
        assert!(shown > 200 && shown < found.modes.len(), "{shown} of {}", found.modes.len());
        assert!(note.starts_with(&format!("{shown} of {} modes, to limit its size.", found.modes.len())));
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
