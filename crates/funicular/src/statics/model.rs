//! Models of how a cable carries its static load.

/// How a cable carries its static load.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum StaticModel {
    /// Straight, massless, rigid in length; pulls as equilibrium asks, and has none where it would have to push.
    Ideal,
    /// Straight, massless, elastic; no force when slack.
    Spring,
    /// Elastic catenary under its own weight.
    #[default]
    Catenary,
}

impl StaticModel {
    /// All of them, simplest first.
    pub const ALL: [Self; 3] = [Self::Ideal, Self::Spring, Self::Catenary];

    /// Its name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ideal => "ideal",
            Self::Spring => "spring",
            Self::Catenary => "catenary",
        }
    }
}
