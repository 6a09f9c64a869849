//! Searches formulas for the rows of standard input, `y,x0,x1,...` each, and prints the Pareto front, `complexity,mean squared error,formula` each.

use ndarray::{Array1, Array2};
use symbolic_regression::prelude::*;

/// The largest number of arguments of an operator.
const ARGUMENTS: usize = 2;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let lines = std::io::stdin().lines().collect::<Result<Vec<_>, _>>()?;
    let rows = lines.iter().map(|line| line.split(',').map(str::parse).collect());
    let rows = rows.collect::<Result<Vec<Vec<f64>>, _>>()?;
    let features = rows.first().ok_or("no rows")?.len() - 1;
    let x = Array2::from_shape_fn((features, rows.len()), |(feature, row)| rows[row][feature + 1]);
    let y = Array1::from_iter(rows.iter().map(|row| row[0]));
    let names = ["+", "sub", "*", "/", "exp", "log", "tanh", "sqrt"];
    let options = Options::<f64, ARGUMENTS> {
        operators: BuiltinOpsF64::from_names(names).map_err(|e| format!("operators: {e:?}"))?,
        maxsize: 15,
        niterations: 20,
        populations: 8,
        deterministic: true,
        progress: false,
        print_precision: 12,
        ..Default::default()
    };
    let result = equation_search::<_, BuiltinOpsF64, ARGUMENTS>(&Dataset::new(x, y), &options);
    for member in result.hall_of_fame.pareto_front() {
        println!("{},{},{}", member.complexity, member.loss, member.expr);
    }
    Ok(())
}
