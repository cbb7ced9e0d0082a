//! Equilibria of the paper's robot.

use super::reference::{Published, library};
use super::section::WRONG;
use super::{Bound, Case, Comparison, Declared, Level, NegativeControl, reference};
use anyhow::Result;
use funicular::statics::{self, StaticModel};

pub(super) const SECTION: Declared = Declared {
    id: "paper-robot",
    title: "Equilibria of the paper's robot",
    note: "Six catenaries and a platform, without a given start. The printed digits bound the differences.",
    rows: || rows(&reference::published()?),
    controls: &[NegativeControl {
        id: "mass",
        wrong: "mass of the platform 1 % too large",
        proves: "the weight of the platform in its equilibrium",
        rows: || {
            let mut published = reference::published()?;
            published.paper_robot_equilibria.rows.iter_mut().for_each(|of| of.mass_kg *= WRONG);
            rows(&published)
        },
    }],
};

fn rows(published: &Published) -> Result<Vec<Comparison>> {
    let table = &published.paper_robot_equilibria;
    let mut rows = Vec::new();
    for row in &table.rows {
        let (robot, lengths) = library(&row.robot)?;
        let rest = statics::forward(&robot.with_mass(row.mass_kg), &lengths, StaticModel::Catenary, None)?;
        let case = Case::new(
            Level::Program,
            &table.source,
            &format!("{}/{}kg", row.robot, row.mass_kg),
            &format!("{}, {} kg", row.robot, row.mass_kg),
        );
        let position: [f64; 3] = rest.pose.position_w.into();
        let digits = Bound::Digits("five decimals");
        rows.push(case.of("position", "position [m]").absolute(&row.position_m, &position, 6e-6, digits));
        let tensions: Vec<f64> = rest.cables.iter().map(|cable| cable.tension_platform).collect();
        let digits = Bound::Digits("two decimals and MoorPy's tolerance");
        rows.push(case.of("tensions", "tensions at the platform [N]").absolute(
            &row.tension_platform_n,
            &tensions,
            8e-3,
            digits,
        ));
    }
    Ok(rows)
}
