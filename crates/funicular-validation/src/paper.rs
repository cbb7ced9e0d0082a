//! Numbers that the paper prints and that can be checked.

use super::dynamics::fig2_sag;
use super::reference::{Published, library};
use super::section::WRONG;
use super::{Bound, Case, Comparison, Declared, Level, NegativeControl, reference};
use anyhow::Result;
use funicular::statics::{self, CableState, StaticModel};

const TABLES: &str = "Yuan, Courteille, Deblaise 2014, Tables I and II";

pub(super) const SECTION: Declared = Declared {
    id: "paper",
    title: "The paper",
    note: "Numbers of Yuan, Courteille and Deblaise can be checked if they depend on printed input alone. λ² of \
           Fig. 2 does not follow from the mass per length of Table II; with 0.06904 kg/m all three numbers of the \
           figure do. The lengths of Tables I and II determine one pose of ideal cables, which was solved for \
           separately.",
    rows: || rows(&reference::published()?),
    controls: &[NegativeControl {
        id: "mass",
        wrong: "mass per length of the cable 1 % too large",
        proves: "the definitions of λ² and ε",
        rows: || {
            let mut published = reference::published()?;
            published.fig2_cable.mass_kg_per_m *= WRONG;
            rows(&published)
        },
    }],
};

fn rows(published: &Published) -> Result<Vec<Comparison>> {
    let cable = &published.fig2_cable;
    let sag = fig2_sag(cable, cable.mass_kg_per_m);
    let heavier = fig2_sag(cable, cable.mass_of_published_lambda2_kg_per_m);
    let (printed, defined) = (&cable.published, &cable.from_table_ii);

    let case =
        Case::new(Level::Exact, &defined.source, "definitions", &format!("Fig. 2, {} kg/m", cable.mass_kg_per_m));
    let mut rows = vec![
        case.of("lambda2", "λ²").absolute(&[defined.lambda2], &[sag.lambda2], 1e-12, Bound::Rounding),
        case.of("epsilon", "ε").absolute(&[defined.epsilon], &[sag.epsilon], 1e-15, Bound::Rounding),
    ];
    let case = case.with(Level::Published, &cable.source);
    let conflict = Bound::Model("the paper's conflict: its λ² needs 0.06904 kg/m, Table II has 0.067");
    let length = |sag: &funicular::cable::Sag| sag.effective_length / sag.chord;
    let four = Bound::Digits("four decimals");
    rows.extend([
        // λ² grows with the square of the mass, and ε with the mass: 6 % and 3 %, plus half a unit of the last digit.
        case.of("lambda2-printed", "λ²").relative(&[printed.lambda2], &[sag.lambda2], 0.06, conflict),
        case.of("epsilon-printed", "ε").relative(&[printed.epsilon], &[sag.epsilon], 0.03, conflict),
        case.of("length", "L_e/l").absolute(&[printed.effective_length_over_chord], &[length(&sag)], 5e-5, four),
    ]);
    let heavy = funicular_study::text::significant(cable.mass_of_published_lambda2_kg_per_m, 4);
    let case = Case::new(Level::Published, &cable.source, "heavier", &format!("Fig. 2, {heavy} kg/m"));
    let three = Bound::Digits("three decimals");
    rows.extend([
        case.of("lambda2", "λ²").absolute(&[printed.lambda2], &[heavier.lambda2], 1e-12, Bound::Rounding),
        case.of("epsilon", "ε").absolute(&[printed.epsilon], &[heavier.epsilon], 5e-4, three),
        case.of("length", "L_e/l").absolute(&[printed.effective_length_over_chord], &[length(&heavier)], 5e-5, four),
    ]);

    let table = &published.paper_robot_ideal_poses;
    let mut lengths_rows = Vec::new();
    for row in &table.rows {
        let (robot, lengths) = library(&row.robot)?;
        let rest = statics::forward(&robot, &lengths, StaticModel::Ideal, None)?;
        let case = Case::new(
            Level::Program,
            &table.source,
            &format!("ideal-pose/{}", row.robot),
            &format!("{}, ideal cables", row.robot),
        );
        let position: [f64; 3] = rest.pose.position_w.into();
        rows.push(case.of("position", "position [m]").absolute(&row.position_m, &position, 5.1e-5, four));
        let turn: [f64; 3] = rest.pose.rot_wp.scaled_axis().map(f64::to_degrees).into();
        rows.push(case.of("rotation", "rotation vector [°]").absolute(&row.rotation_vector_deg, &turn, 5.1e-4, three));
        let chords: Vec<f64> = rest.cables.iter().map(CableState::chord).collect();
        let case = case.with(Level::Published, TABLES);
        lengths_rows.push(case.of("lengths", "lengths of the cables [m]").absolute(
            &lengths,
            &chords,
            1e-12,
            Bound::Rounding,
        ));
    }
    rows.extend(lengths_rows);
    Ok(rows)
}
