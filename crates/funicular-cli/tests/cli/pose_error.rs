//! `pose-error`: the threshold mass.

use super::{close, json, number};

#[test]
fn pose_error_names_the_threshold_mass() {
    let value = json(&["pose-error", "ROBOT", "--mass-kg", "10.55:86.35:20", "--tolerance-mm", "5"]);
    let points = value["points"].as_array().unwrap();
    assert_eq!(points.len(), 20);
    assert!(close(number(&points[19]["mass_kg"]), 86.35, 0.0));
    let distance = |i: usize| number(&points[i]["spring_from_catenary"]["distance_m"]);
    let mass = number(&value["threshold"]["from_mass_kg"]);
    for (i, point) in points.iter().enumerate() {
        assert_eq!(number(&point["mass_kg"]) >= mass, distance(i) <= 0.005, "{i}");
    }
}
