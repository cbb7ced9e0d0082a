//! Short forms of the results of `validate`: a report for build servers, and a badge.

use super::Validated;
use std::fmt::Write;

/// Report in the format of JUnit, which build servers read: one suite per section, one test per comparison and per
/// negative control.
pub fn junit(found: &Validated) -> String {
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let missed = found.controls.iter().filter(|control| !control.caught).count();
    let (tests, failures) = (found.comparisons + found.controls.len(), found.comparisons - found.passed + missed);
    let _ = writeln!(text, "<testsuites name=\"funicular validate\" tests=\"{tests}\" failures=\"{failures}\">");
    for section in &found.sections {
        let failed = section.rows.iter().filter(|row| !row.pass).count();
        let tests = section.rows.iter().map(|row| {
            let bound: &str = row.bounded_by.into();
            let told =
                format!("difference {:e}, tolerance {:e} ({bound}); {}", row.difference, row.tolerance, row.source);
            (format!("{}, {}", row.case, row.quantity), row.id.as_str(), (!row.pass).then_some(told))
        });
        suite(&mut text, section.title, failed, &tests.collect::<Vec<_>>());
    }
    if !found.controls.is_empty() {
        let tests = found.controls.iter().map(|control| {
            let told = (!control.caught).then(|| "all comparisons pass with the wrong input".to_owned());
            (control.wrong.to_owned(), control.id.as_str(), told)
        });
        suite(&mut text, "Negative controls", missed, &tests.collect::<Vec<_>>());
    }
    text.push_str("</testsuites>\n");
    text
}

/// Suite of tests: name, ID and failure of each.
fn suite(text: &mut String, title: &str, failed: usize, tests: &[(String, &str, Option<String>)]) {
    let (title, count) = (escaped(title), tests.len());
    let _ = writeln!(text, "  <testsuite name=\"{title}\" tests=\"{count}\" failures=\"{failed}\">");
    for (name, id, failure) in tests {
        let (name, id) = (escaped(name), escaped(id));
        let _ = match failure {
            None => writeln!(text, "    <testcase classname=\"{id}\" name=\"{name}\"/>"),
            Some(told) => writeln!(
                text,
                "    <testcase classname=\"{id}\" name=\"{name}\"><failure message=\"{}\"/></testcase>",
                escaped(told)
            ),
        };
    }
    text.push_str("  </testsuite>\n");
}

/// Text of an attribute in XML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Badge for pages: one line as SVG, green if everything passes.
pub fn badge(found: &Validated) -> String {
    let (label, value) = ("validation", format!("{} of {} pass", found.passed, found.comparisons));
    // Letters of this size are 6.5 wide on average.
    let width = |text: &str| 10.0 + 6.5 * text.chars().count() as f64;
    let (left, right) = (width(label), width(&value));
    let (all, colour) = (left + right, if found.verdict().is_ok() { "#2e7d32" } else { "#c62828" });
    let (first, second) = (0.5 * left, left + 0.5 * right);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{all}\" height=\"20\" role=\"img\" \
         aria-label=\"{label}: {value}\">\n<title>{label}: {value}</title>\n\
         <rect width=\"{left}\" height=\"20\" fill=\"#555\"/>\n\
         <rect x=\"{left}\" width=\"{right}\" height=\"20\" fill=\"{colour}\"/>\n\
         <g fill=\"#fff\" text-anchor=\"middle\" font-family=\"Verdana,DejaVu Sans,sans-serif\" font-size=\"11\">\n\
         <text x=\"{first}\" y=\"14\">{label}</text>\n<text x=\"{second}\" y=\"14\">{value}</text>\n</g>\n</svg>\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verdict::run;
    use funicular_study::request::ValidateRequest;

    #[test]
    fn a_failure_is_a_failed_test_of_the_report_and_a_red_badge() {
        let request = ValidateRequest { only: vec!["catenary/michalos-1962".to_owned()], ..ValidateRequest::default() };
        let mut found = run(&request).unwrap();
        let report = junit(&found);
        assert!(report.contains("tests=\"3\" failures=\"0\""), "{report}");
        assert!(report.contains("<testcase classname=\"catenary/michalos-1962/node\" name=\"node under a load, node"));
        assert!(badge(&found).contains("3 of 3 pass") && badge(&found).contains("#2e7d32"));

        found.sections[0].rows[0].pass = false;
        found.sections[0].rows[0].source = "a < b & \"c\"".to_owned();
        found.passed -= 1;
        let report = junit(&found);
        assert!(report.contains("failures=\"1\"") && report.contains("a &lt; b &amp; &quot;c&quot;"), "{report}");
        assert!(badge(&found).contains("2 of 3 pass") && badge(&found).contains("#c62828"));
    }
}
