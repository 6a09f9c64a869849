#!/usr/bin/env python3
"""The Bayesian machine scientist (autora-theorist-bms) on the residuals of the base model."""
import residual
from answer import main

EPOCHS = 60


def search(x, y):
    from autora.theorist.bms import BMSRegressor
    model = BMSRegressor(epochs=EPOCHS)
    model.fit(x, y[:, None])
    text, values = str(model.model_), next(iter(model.model_.par_values.values()))
    for name, value in values.items():
        text = text.replace(name, f"({float(value)!r})")
    return text.replace("X0", "x0").replace("X1", "x1").replace("X2", "x2")


if __name__ == "__main__":
    main(residual.entry(search))
