//! Certificate of a proof: lines of JSON that a second program checks without solving anything.

use super::Proved;
use crate::sweep::digest;
use funicular::math::{Vec3, Vec6};
use funicular::proof::BoxCertificate;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Name and version of the form of the lines.
const FORM: &str = "funicular-certificate/1";

impl Proved {
    /// Certificate: a line with the statement, then one for each box that is proved inside or outside, one with
    /// their numbers and sizes, and at last one with a digest of all lines before. Numbers have every digit.
    pub fn certificate(&self) -> String {
        let mut text = format!("{}\n", self.statement_line());
        let mut counts = [0_usize; 2];
        for of in self.boxes.iter().filter(|of| of.verdict != "undecided") {
            let proof = self.statement.prove(&of.region());
            let mut line = json!({"lower": of.lower_m, "upper": of.upper_m, "verdict": of.verdict});
            match proof.certificate() {
                BoxCertificate::Inside(tensions) => {
                    counts[0] += 1;
                    line["tensions"] = json!(tensions);
                }
                BoxCertificate::Outside(load, direction) => {
                    counts[1] += 1;
                    line["load"] = load.into();
                    line["direction"] = components(&direction).into();
                }
                BoxCertificate::Undecided => continue,
            }
            let _ = writeln!(text, "{line}");
        }
        let end = json!({
            "inside": counts[0], "outside": counts[1], "inside_size": self.inside, "outside_size": self.outside,
        });
        let _ = writeln!(text, "{end}");
        let digest = json!({"sha256": digest::of_text(&text)});
        let _ = writeln!(text, "{digest}");
        text
    }

    fn statement_line(&self) -> Value {
        let point = |of: &Vec3| json!([of.x, of.y, of.z]);
        let of = &self.statement;
        let cables = of.cables().map(|cable| {
            let mut line = json!({
                "name": cable.name, "anchor": point(&cable.anchor_w), "arm": point(&cable.arm_w),
                "least": cable.least[0], "least_per_length": cable.least[1],
                "greatest": cable.greatest.is_finite().then_some(cable.greatest),
            });
            if let Some([weight, stiffness]) = cable.sag {
                line["weight"] = weight.into();
                line["axial_stiffness"] = stiffness.into();
            }
            line
        });
        let [turns, up] = of.turns_and_up();
        json!({
            "form": FORM,
            "robot": self.robot,
            "claim": "at every position of a box with verdict inside and every turn, tensions within the limits \
                      balance every load; at every position of a box with verdict outside they do not balance the \
                      load without a turn",
            "cables": cables.collect::<Vec<_>>(),
            "rows": of.rows().iter().map(components).collect::<Vec<_>>(),
            "loads": of.loads().iter().map(components).collect::<Vec<_>>(),
            "turning": of.turning_forces().iter().map(|[force, arm]| [point(force), point(arm)]).collect::<Vec<_>>(),
            "turns": point(&turns),
            "up": point(&up),
            "lower": point(&self.region.lower),
            "upper": point(&self.region.upper),
        })
    }
}

fn components(of: &Vec6) -> Vec<f64> {
    of.iter().copied().collect()
}
