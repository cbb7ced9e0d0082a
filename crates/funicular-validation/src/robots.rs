//! Equilibria of the paper's robot.

use super::reference::{Published, library};
use super::{Bound, Case, Section};
use anyhow::Result;
use funicular::statics::{self, StaticModel};

pub(super) fn section(published: &Published) -> Result<Section> {
    let table = &published.paper_robot_equilibria;
    let mut rows = Vec::new();
    for row in &table.rows {
        let (robot, lengths) = library(&row.robot)?;
        let rest = statics::forward(&robot.with_mass(row.mass_kg), &lengths, StaticModel::Catenary, None)?;
        let case = Case { name: format!("{}, {} kg", row.robot, row.mass_kg), source: &table.source };
        let position: [f64; 3] = rest.pose.position_w.into();
        let digits = Bound::Digits("five decimals");
        rows.push(case.absolute("position [m]", &row.position_m, &position, 6e-6, digits));
        let tensions: Vec<f64> = rest.cables.iter().map(|cable| cable.tension_platform).collect();
        let digits = Bound::Digits("two decimals and MoorPy's tolerance");
        rows.push(case.absolute("tensions at the platform [N]", &row.tension_platform_n, &tensions, 8e-3, digits));
    }
    Ok(Section {
        title: "Equilibria of the paper's robot",
        note: "Six catenaries and a platform, without a given start. The printed digits bound the differences.",
        rows,
    })
}
