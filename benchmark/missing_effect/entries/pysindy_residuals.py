#!/usr/bin/env python3
"""pysindy (sparse regression over a library of terms) on the residuals of the base model: polynomials of degree 3, sequential thresholding."""
import residual
from answer import main


def search(x, y):
    import pysindy
    library, optimizer = pysindy.PolynomialLibrary(degree=3), pysindy.STLSQ(threshold=0.5, alpha=0.1)
    terms = library.fit_transform(x)
    optimizer.fit(terms, y[:, None])
    names = library.get_feature_names(["x0", "x1", "x2"])
    parts = [f"({float(c)!r}) * {name.replace('^', '**').replace(' ', '*')}" for name, c in zip(names, optimizer.coef_[0]) if c]
    return " + ".join(parts) or "0.0"


if __name__ == "__main__":
    main(residual.entry(search))
