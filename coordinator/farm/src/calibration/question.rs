//! The question of an evaluation: variant, parameters, subchain.

use statistics::Subchain;

/// The question that a lease asks.
#[derive(Debug, Clone, Copy)]
pub struct Question<'a> {
    /// Hash of the variant.
    pub variant: &'a str,
    /// The parameters of the model; for a subchain, all parameters.
    pub theta: &'a [f64],
    /// The subchain that starts there.
    pub subchain: Option<Subchain>,
}
