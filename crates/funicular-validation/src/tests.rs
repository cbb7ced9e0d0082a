//! Tests of each section: every comparison passes and has a source.

use super::*;
use crate::reference::{self, damped, drives, exact, independent, published};

/// Fails with the rows that do not pass, in the form of docs/validation.md.
fn check(section: Result<Section>) {
    let section = section.unwrap();
    let failed: Vec<String> = section.rows.iter().filter(|row| !row.pass).map(markdown::line).collect();
    assert!(failed.is_empty(), "{}:\n{}", section.title, failed.join("\n"));

    // A section needs rows, and every number needs a source that can be looked up.
    assert!(!section.rows.is_empty(), "{}", section.title);
    for row in &section.rows {
        assert!(row.source.len() > 20, "{}, {}: {:?} is not a source", row.case, row.quantity, row.source);
        assert!(!row.theirs.is_empty() && row.tolerance >= 0.0, "{}, {}", row.case, row.quantity);
    }
}

#[test]
fn one_hanging_cable_has_the_forces_and_the_stiffness_of_others() {
    check(catenary::section(&published().unwrap()));
}

#[test]
fn the_papers_robot_rests_where_moorpy_finds_it() {
    check(robots::section(&published().unwrap()));
}

#[test]
fn fourteen_robots_are_those_of_the_independent_program() {
    check(independent::section(&independent().unwrap()));
}

#[test]
fn exact_cables_vibrate_as_those_of_the_independent_program() {
    check(exact::section(&published().unwrap(), &exact().unwrap(), &independent().unwrap()));
}

#[test]
fn damped_modes_shapes_and_points_on_cables_are_those_of_the_independent_program() {
    check(damped::section(&damped().unwrap(), &independent().unwrap()));
}

#[test]
fn the_loss_of_the_stretch_is_that_of_the_independent_program() {
    check(super::stretch_loss::section(&reference::stretch_loss().unwrap()));
}

#[test]
fn large_motion_is_that_of_two_methods() {
    check(super::simulations::section(&reference::histories().unwrap()));
}

#[test]
fn distances_are_those_of_the_independent_program() {
    check(super::distances::section(&reference::distances().unwrap()));
}

#[test]
fn workspaces_are_those_of_others() {
    check(super::workspaces::section(&reference::workspaces().unwrap()));
}

#[test]
fn load_factors_and_closure_are_those_of_the_independent_program() {
    check(super::load_factors::section(&reference::load_factors().unwrap()));
}

#[test]
fn centres_of_tensions_are_those_of_the_independent_program() {
    check(super::centres::section(&reference::centres().unwrap()));
}

#[test]
fn the_sway_after_commands_is_that_of_the_independent_program() {
    check(super::sway::section(&reference::sway().unwrap()));
}

#[test]
fn gradients_are_those_of_a_complex_step_through_a_separate_program() {
    check(gradients::section(&reference::gradients().unwrap()));
}

#[test]
fn the_closed_form_has_the_stiffness_and_the_frequencies_of_others() {
    check(Ok(dynamics::section(&published().unwrap())));
}

#[test]
fn a_point_mass_on_eight_strings_has_every_published_frequency_with_its_multiplicity() {
    check(cube::section(&published().unwrap()));
}

#[test]
fn what_the_paper_prints_of_itself_follows_where_it_can() {
    check(paper::section(&published().unwrap()));
}

#[test]
fn cables_over_pulleys_and_on_winches_rest_as_in_other_programs() {
    let drives = drives().unwrap();
    check(super::drives::section(&drives, super::driven::comparisons(&drives).unwrap()));
}

#[test]
fn a_robot_with_few_cables_swings_as_its_makers_computed_and_measured() {
    check(super::measured::section(&crate::reference::measured().unwrap().grab));
}

#[test]
fn values_are_identified_as_the_measurements_have_them_and_as_others_did() {
    let poses = crate::reference::measured().unwrap().grab;
    check(identification::section(&reference::identification().unwrap(), &poses));
}

#[test]
fn linear_deviations_are_those_of_sampled_robots() {
    check(super::uncertainty::section());
}
