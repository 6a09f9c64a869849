//! The kinds of trials, by what is hidden.

/// The kind of a trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HiddenKind {
    One,
    None,
    Outside,
    Two,
    Triple,
    /// One effect of the three-dimensional model, which must be detectable because an evaluation is expensive.
    Spatial,
    /// A law outside the library beside an effect.
    Outlib,
    /// A law outside the library that depends on two variables.
    Twovar,
    /// A dimension of the wheel or of the rig that is stated wrongly.
    Geometry,
    /// One effect in eight runs.
    Sparse,
    /// One effect, with noise that has heavy tails.
    Heavy,
    /// Sessions with an offset of a channel or of the stiffness. In every second experiment there is no effect, in the others one.
    Session,
}

impl HiddenKind {
    /// All kinds in the order of the variants, which determines the numbers of their truths.
    pub const ALL: [HiddenKind; 12] = [
        HiddenKind::One,
        HiddenKind::None,
        HiddenKind::Outside,
        HiddenKind::Two,
        HiddenKind::Triple,
        HiddenKind::Spatial,
        HiddenKind::Outlib,
        HiddenKind::Twovar,
        HiddenKind::Geometry,
        HiddenKind::Sparse,
        HiddenKind::Heavy,
        HiddenKind::Session,
    ];

    pub fn name(self) -> &'static str {
        match self {
            HiddenKind::One => "one",
            HiddenKind::None => "none",
            HiddenKind::Outside => "outside",
            HiddenKind::Two => "two",
            HiddenKind::Triple => "triple",
            HiddenKind::Spatial => "scm",
            HiddenKind::Outlib => "outlib",
            HiddenKind::Twovar => "twovar",
            HiddenKind::Geometry => "geometry",
            HiddenKind::Sparse => "sparse",
            HiddenKind::Heavy => "heavy",
            HiddenKind::Session => "session",
        }
    }
}
