//! `live`: the page on which one can drag the platform, with a robot in it.
//!
//! The page is built by `scripts/web`. It is part of this crate if the variable `FUNICULAR_PAGE` names its file when
//! the crate is built, as `scripts/release` does.

use anyhow::{Result, bail};
use funicular_study::names::TensionRuleName;
use funicular_study::request::{LiveRequest, Pose, RobotText, keys_of};
use serde_json::{Value, json};

/// Page of this build; empty if it was built without the page.
const PAGE: &str = include_str!(concat!(env!("OUT_DIR"), "/live.html"));

/// Place in the page for the robot and its state.
const START: &str = "<script id=\"start\" type=\"application/json\">null</script>";

/// True if this build contains the page.
pub fn is_built() -> bool {
    !PAGE.is_empty()
}

/// Makes the page of a robot. The page computes itself; the robot file is only read and checked here.
///
/// # Errors
/// A build without the page, or a robot file or state that has to change.
pub fn live(request: &LiveRequest) -> Result<String> {
    page_with(PAGE, request)
}

/// Puts a robot into a page.
fn page_with(page: &str, request: &LiveRequest) -> Result<String> {
    if page.is_empty() {
        bail!(
            "this build does not contain the page: in the sources of funicular, `scripts/install` installs the program \
             with it, and `scripts/install --python` the Python package; or `scripts/web --no-test` makes \
             target/web/funicular.html: open it in a browser and load the robot there"
        );
    }
    let LiveRequest { robot, state, tensions, .. } = request;
    let file = robot.read()?;
    funicular_study::at_rest::with_limits(&funicular_study::at_rest::with_state(file.robot, state)?, tensions)?;

    // `<` cannot begin a tag inside a script if it is written as an escape of JSON.
    let start = start(request)?.to_string().replace('<', "\\u003c");
    let Some((before, after)) = page.split_once(START) else {
        bail!("the page of this build has no place for a robot")
    };
    Ok(format!("{before}{}{after}", START.replace("null", &start)))
}

/// State with which the page starts, in the form of its links.
fn start(request: &LiveRequest) -> Result<Value> {
    let LiveRequest { robot: RobotText { name, text, set }, state, tensions, model } = request;
    let (hold, pose) = match state.pose {
        None if state.lengths_m.is_some() => ("lengths", None),
        None => ("file", None),
        Some(Pose::Angles(numbers)) => ("pose", Some(json!(numbers))),
        Some(Pose::Quaternion(..)) => bail!("⟪pose⟫ of a page is given as position and roll, pitch, yaw"),
    };

    // Everything besides pose, lengths and rule goes into each request of the page.
    let mut more = keys_of(state)?;
    more.extend(keys_of(tensions)?);
    for key in ["pose", "lengths_m", "tension_rule"] {
        more.remove(key);
    }
    let rule = match tensions.tension_rule {
        None => "",
        Some(TensionRuleName::Lowest) => "lowest",
        Some(TensionRuleName::Middle) => "middle",
        Some(TensionRuleName::Centre) => "centre",
        Some(TensionRuleName::Stiffest) => "stiffest",
        Some(TensionRuleName::Closest) => "closest",
    };
    Ok(json!({
        "version": 1,
        "robot": { "name": name, "text": text, "set": set },
        "hold": hold,
        "pose": pose,
        "lengths": state.lengths_m,
        "rule": rule,
        "more": more,
        "model": model,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use funicular_study::Request;

    fn value(more: &Value) -> Value {
        let mut value = json!({ "command": "live", "robot": { "name": "a.toml", "text": funicular_robots::COGIRO } });
        value.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        value
    }

    fn request(more: &Value) -> LiveRequest {
        let Request::Live(request) = Request::from_value(value(more)).unwrap() else { panic!("live was requested") };
        request
    }

    #[test]
    fn the_robot_and_its_state_are_in_the_page_as_json() {
        let page = format!("<body>{START}</body>");
        let set = json!([{ "path": "name", "value": "</script><b>" }]);
        let text = funicular_robots::COGIRO;
        let of = request(&json!({
            "robot": { "name": "a.toml", "text": text, "set": set }, "pose": [1.0, 2.0, 1.5],
            "wind_m_s": [5.0, 0.0, 0.0],
            "tension_rule": "middle", "cable_model": "spring",
        }));
        let made = page_with(&page, &of).unwrap();
        let json = made.strip_prefix("<body><script id=\"start\" type=\"application/json\">").unwrap();
        let json = json.strip_suffix("</script></body>").unwrap();
        assert!(!json.contains('<'));
        let start: Value = serde_json::from_str(json).unwrap();
        assert_eq!(start["robot"]["text"], text);
        assert_eq!(start["robot"]["set"], set);
        assert_eq!(start["pose"], json!([1.0, 2.0, 1.5, 0.0, 0.0, 0.0]));
        assert_eq!((&start["hold"], &start["rule"]), (&json!("pose"), &json!("middle")));
        assert_eq!(start["more"]["wind_m_s"], json!([5.0, 0.0, 0.0]));
        assert_eq!(start["model"]["cable_model"], "spring");
    }

    #[test]
    fn what_the_page_cannot_show_is_refused() {
        for (page, more, message) in [
            ("", json!({}), "this build does not contain the page: in the sources of funicular, `scripts/install`"),
            (START, json!({ "mass_kg": -1.0 }), "`mass_kg`: -1 is not positive"),
            (START, json!({ "pose": [0.0, 0.0, 1.0], "lengths_m": [1.0] }), "not both"),
        ] {
            // Ranges are refused where the request is read, before there is a page.
            let read = Request::from_value(value(&more)).map(|read| match read {
                Request::Live(request) => page_with(page, &request),
                _ => panic!("live was requested"),
            });
            let error = read.map_or_else(|error| error.to_string(), |page| page.unwrap_err().to_string());
            assert!(error.contains(message), "{error}");
        }
    }

    #[test]
    fn a_page_that_was_built_in_has_a_place_for_a_robot() {
        assert!(!is_built() || live(&request(&json!({}))).unwrap().contains("CoGiRo, LIRMM"));
    }
}
