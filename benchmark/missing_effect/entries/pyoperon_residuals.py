#!/usr/bin/env python3
"""pyoperon (genetic programming with local search) on the residuals of the base model."""
import residual
from answer import main


def search(x, y):
    from pyoperon.sklearn import SymbolicRegressor
    symbols = "add,sub,mul,div,exp,log,tanh,sqrt,square,constant,variable"
    model = SymbolicRegressor(allowed_symbols=symbols, objectives=["r2", "length"], max_length=15, max_evaluations=100_000, uncertainty=[1.0],
                              model_selection_criterion="minimum_description_length", n_threads=1, random_state=1)
    model.fit(x, y)
    text = model.get_model_string(model.model_, precision=12).replace("^", "**")
    return text.replace("X1", "x0").replace("X2", "x1").replace("X3", "x2")


if __name__ == "__main__":
    main(residual.entry(search))
