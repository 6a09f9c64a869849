//! Addresses in the memory of a block.

use crate::evaluation::arithmetic::LANES;
use crate::variable::Variable;

/// The maximum number of points of a block.
pub const BLOCK: usize = 128;

/// Count of the numbers in the columns of variables, which precede the registers of programs.
pub(crate) const COLUMNS: usize = Variable::LOCAL * BLOCK;

/// Address of an argument or a result in the memory of a block: the address of the first group of points, and the step
/// from one group to the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Address {
    first: u32,
    step: u32,
}

impl Address {
    /// Returns the column of a variable.
    pub(crate) fn column(variable: Variable) -> Self {
        Self {
            first: (variable as usize * BLOCK) as u32,
            step: LANES as u32,
        }
    }

    /// Returns a register of a program, which holds a value for every point.
    pub(crate) fn register(register: usize) -> Self {
        Self {
            first: (COLUMNS + register * BLOCK) as u32,
            step: LANES as u32,
        }
    }

    /// Returns the address of a value that all points share; constants follow the registers.
    pub(crate) fn constant(registers: usize, constant: usize) -> Self {
        Self {
            first: Self::register(registers).first + (constant * LANES) as u32,
            step: 0,
        }
    }

    /// Returns the position of a group's first value.
    #[inline]
    pub(crate) fn at(self, group: usize) -> usize {
        self.first as usize + group * self.step as usize
    }
}
