//! A system of `ODEBench`: its terms, its parameters, and two initial states.
//!
//! # Source
//! Equations, values and initial states are those of `ODEBench` (d'Ascoli, Becker et al. 2024, "`ODEFormer`: Symbolic Regression of
//! Dynamical Systems with Transformers"), file `odebench/strogatz_equations.py` of the repository sdascoli/odeformer, MIT License,
//! copyright 2023 Stéphane d'Ascoli. Its systems are after S. Strogatz, "Nonlinear Dynamics and Chaos". Products of sums are multiplied
//! out here, so that each equation is a sum of terms. The span is 10, as there, but for the systems of Lorenz, Rössler, and Chen and Lee,
//! whose measurements would be too sparse or, where they are chaotic, would not determine the parameters.

use super::super::dynamic_system::State;

/// A summand of the rate of a state.
#[derive(Debug, Clone, Copy)]
pub struct Term {
    /// The state whose rate it is a part of.
    pub equation: usize,
    /// Constants of its form, beside its factor.
    pub constants: usize,
    /// The term as it is written in the table: `x` are the states, `c` the parameters.
    pub text: &'static str,
    /// By the states and the parameters.
    pub rate: fn(&State, &[f64]) -> f64,
}

/// Writes terms as `equation (constants beside the factor) => rate`.
macro_rules! terms {
    (|$x:ident, $c:ident| $($equation:literal $(($constants:literal))? => $rate:expr),*) => {
        &[$(Term {
            equation: $equation,
            constants: 0 $(+ $constants)?,
            text: stringify!($rate),
            rate: |$x, $c| {
                let _ = ($x, $c);
                $rate
            },
        }),*]
    };
}
pub(super) use terms;

/// A system of one to four states.
#[derive(Debug, Clone, Copy)]
pub struct OdeSystem {
    /// Its number in `ODEBench`, from 1.
    pub number: usize,
    pub parameters: &'static [f64],
    /// The initial states of its two trajectories.
    pub starts: [&'static [f64]; 2],
    /// The time over which it is measured, from 0.
    pub span: f64,
    pub terms: &'static [Term],
}

impl OdeSystem {
    /// Returns the number of states.
    pub fn dimension(&self) -> usize {
        self.starts[0].len()
    }

    /// Returns the indices of the terms that may be left out: all but a rate that is another state by definition, such as a speed.
    pub fn removable(&self) -> Vec<usize> {
        let is_removable = |index: &usize| {
            let term = &self.terms[*index];
            let is_single = self.terms.iter().filter(|t| t.equation == term.equation).count() == 1;
            !(is_single && matches!(term.text, "x[0]" | "x[1]" | "x[2]" | "x[3]"))
        };
        (0..self.terms.len()).filter(is_removable).collect()
    }

    /// Returns the rates of the states without a term.
    pub fn rates(&self, removed: Option<usize>, state: &State, parameters: &[f64]) -> State {
        let mut rates = State::default();
        for (index, term) in self.terms.iter().enumerate() {
            if removed != Some(index) {
                rates[term.equation] += (term.rate)(state, parameters);
            }
        }
        rates
    }

    /// Returns parameters by the logarithms of their magnitudes.
    pub fn signed(&self, logarithms: &[f64]) -> Vec<f64> {
        let pairs = self.parameters.iter().zip(logarithms);
        pairs.map(|(value, x)| value.signum() * libm::exp(*x)).collect()
    }

    /// Returns the initial states.
    pub fn initial(&self) -> [State; 2] {
        self.starts
            .map(|start| std::array::from_fn(|k| start.get(k).copied().unwrap_or(0.0)))
    }
}
