//! Certificate of the rule `centre` in the results of `statics`.

use crate::at_rest::AtRest;
use crate::rows::rows;
use funicular::statics::{self, CentreCertificate};

rows! {
    /// Proof that the tensions of the rule `centre` are the only ones.
    pub struct CentreRow {
        /// True if no other tensions are a centre.
        pub unique: bool;
        /// Bound of the curvature of the balance over that of the logarithms, and the value below which it is a proof.
        pub curvature: f64;
        pub max_curvature: f64;
        /// Name of the cable with this value.
        pub curvature_cable: String;
        /// Least convexity at sixteen tensions of each cable for which the bound is no proof, positive where it is
        /// convex; absent if the bound is a proof.
        pub convexity_min: Option<f64>;
    }
}

impl CentreRow {
    /// Proof for a robot at equilibrium; `None` for another rule, and where the lengths of another pose are held.
    pub fn of(at_rest: &AtRest) -> Option<Self> {
        let AtRest { robot, equilibrium, rule, held_pose, .. } = at_rest;
        if *rule != Some(statics::TensionRule::Centre) || held_pose.is_some() {
            return None;
        }
        let found = statics::tension_centre(robot, &equilibrium.pose, equilibrium.model, None).ok()?.certificate;
        Some(Self {
            unique: found.is_unique(),
            curvature: found.curvature,
            max_curvature: CentreCertificate::MAX_CURVATURE,
            curvature_cable: robot.cables.get(found.cable)?.name.clone(),
            convexity_min: found.convexity,
        })
    }

    /// Sentence on the proof.
    pub fn text(&self) -> String {
        let bound = format!(
            "curvature at most {:.2e} at cable \"{}\", limit {}",
            self.curvature, self.curvature_cable, self.max_curvature
        );
        match (self.unique, self.convexity_min) {
            (true, None) => format!("proved to be the only centre ({bound})"),
            (true, Some(least)) => format!(
                "the only centre by {least:.2e} of convexity at sixteen tensions of each cable, which is no proof \
                 ({bound})"
            ),
            (false, _) => format!("NOT CERTIFIED to be the only centre: there may be others ({bound})"),
        }
    }
}
