//! What an evaluation is leased with.

use statistics::Subchain;

/// What an evaluation is leased with.
#[derive(Debug, Clone, Copy)]
pub struct Question<'a> {
    /// Hash of the variant.
    pub variant: &'a str,
    /// The parameters: those of the model, of a subchain all.
    pub theta: &'a [f64],
    /// The subchain that starts there.
    pub subchain: Option<Subchain>,
}
