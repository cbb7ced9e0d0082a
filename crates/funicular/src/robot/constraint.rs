//! Number of cables against the degrees of freedom of the platform.

use super::Robot;
use std::cmp::Ordering;

/// Constraint of a platform by its cables, by their number alone. Cables whose directions are dependent, as
/// those that all end at one point of the platform, constrain less than their number says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Constraint {
    /// Under-constrained, with the number of missing cables: for given lengths the platform still moves.
    Under(usize),
    /// Fully constrained: as many cables as degrees of freedom. One set of tensions holds a pose.
    Fully,
    /// Redundantly constrained, with the number of redundant cables: many sets of tensions hold a pose.
    Redundantly(usize),
}

impl Constraint {
    /// Constraint by a number of cables of a platform with these degrees of freedom.
    pub fn new(cables: usize, degrees_of_freedom: usize) -> Self {
        match cables.cmp(&degrees_of_freedom) {
            Ordering::Less => Self::Under(degrees_of_freedom - cables),
            Ordering::Equal => Self::Fully,
            Ordering::Greater => Self::Redundantly(cables - degrees_of_freedom),
        }
    }

    /// True if there are fewer cables than degrees of freedom.
    pub fn is_under(self) -> bool {
        matches!(self, Self::Under(_))
    }

    /// True if there are more cables than degrees of freedom.
    pub fn is_redundant(self) -> bool {
        matches!(self, Self::Redundantly(_))
    }
}

impl Robot {
    /// Number of cables against the degrees of freedom of the platform. Cables of one rope over sheaves count as one:
    /// they have one tension to choose.
    pub fn constraint(&self) -> Constraint {
        Constraint::new(self.rope_count(), self.platform.motion.count())
    }
}

#[cfg(test)]
mod tests {
    use super::{Constraint, Robot};

    #[test]
    fn cables_are_counted_against_degrees_of_freedom() {
        let mut robot = Robot::from_toml(funicular_robots::YUAN2014_4MM).unwrap();
        assert_eq!(robot.constraint(), Constraint::Fully);

        robot.cables.push(robot.cables[0].clone());
        assert_eq!(robot.constraint(), Constraint::Redundantly(1));
        assert!(robot.constraint().is_redundant() && !robot.constraint().is_under());

        robot.cables.truncate(4);
        assert_eq!(robot.constraint(), Constraint::Under(2));
        assert!(robot.constraint().is_under() && !robot.constraint().is_redundant());
    }
}
