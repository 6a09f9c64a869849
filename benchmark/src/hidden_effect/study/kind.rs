//! The kinds of trials, by what is hidden.

/// What is hidden in a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HiddenKind {
    One,
    None,
    Outside,
    Two,
    Three,
    /// One detectable effect of the three-dimensional model: an evaluation is too expensive for undetectable ones.
    Spatial,
}

impl HiddenKind {
    pub const ALL: [HiddenKind; 6] = [
        HiddenKind::One,
        HiddenKind::None,
        HiddenKind::Outside,
        HiddenKind::Two,
        HiddenKind::Three,
        HiddenKind::Spatial,
    ];

    pub fn name(self) -> &'static str {
        match self {
            HiddenKind::One => "one",
            HiddenKind::None => "none",
            HiddenKind::Outside => "outside",
            HiddenKind::Two => "two",
            HiddenKind::Three => "three",
            HiddenKind::Spatial => "scm",
        }
    }
}
