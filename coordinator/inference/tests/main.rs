//! Check priors, likelihood and sampler against known answers.

mod problems;
