//! The kinds of trials, by what is hidden.

/// The kind of a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HiddenKind {
    One,
    None,
    Outside,
    Two,
    Three,
    /// One effect of the three-dimensional model, which must be detectable because an evaluation is expensive.
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
