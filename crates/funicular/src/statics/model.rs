//! Models of how a cable carries its static load.

/// Static model of a cable.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum StaticModel {
    /// Straight, massless, rigid in length. Its tension follows from equilibrium; there is no equilibrium if the
    /// tension would be negative.
    Ideal,
    /// Straight, massless, elastic; no force when slack.
    Spring,
    /// Elastic catenary under its own weight.
    #[default]
    Catenary,
}

impl StaticModel {
    /// All models, simplest first.
    pub const ALL: [Self; 3] = [Self::Ideal, Self::Spring, Self::Catenary];

    /// Name in commands and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ideal => "ideal",
            Self::Spring => "spring",
            Self::Catenary => "catenary",
        }
    }
}
