"""A fit of windows that errs as a test says; each window begins where it errs least."""

from types import SimpleNamespace

import numpy as np

from identification.windows.fit import WindowFit
from identification.windows.shooting import decomposed


def fit_of_errors(errors, columns=None, weight=None):
    """A fit at q = 0 that leaves errors (W, L, ny); columns (W, L, ny, p) are those of its values.

    The states of a window are a level and a slope of each output. The residual has a row of each
    prior of a state behind it, as that of a window has.
    """
    W, L, ny = errors.shape
    columns = np.zeros((W, L, ny, 1)) if columns is None else columns
    p = columns.shape[-1]
    basis = np.stack([np.ones(L), np.linspace(-1, 1, L)], axis=-1)
    X = np.einsum("lx,yz->lyxz", basis, np.eye(ny)).reshape(L * ny, 2 * ny)
    X = np.tile(np.vstack([X, 1e-6 * np.eye(2 * ny)]), (W, 1, 1))
    r = np.hstack([errors.reshape(W, -1), np.zeros((W, 2 * ny))])
    S = np.hstack([columns.reshape(W, L * ny, p), np.zeros((W, 2 * ny, p))])
    part = SimpleNamespace(
        cut=SimpleNamespace(outputs=np.zeros((W, L, ny)), starts=np.arange(W)),
        whitener=np.eye(ny), error=lambda r: r[:, : L * ny].reshape(W, L, ny),
    )  # fmt: skip
    space = SimpleNamespace(slope=np.ones_like, on_bound=lambda q: np.zeros(len(q), bool))
    weight = np.zeros(p) if weight is None else np.asarray(weight)
    problem = SimpleNamespace(parts=(part,), prior=SimpleNamespace(weight=weight, space=space))
    return WindowFit(
        problem=problem, q=np.zeros(p), moves=(np.zeros((W, 2 * ny)),),
        tangents=(decomposed(r, X, S),), cost=float(np.sum(r**2)), converged=True, steps=1,
    )  # fmt: skip
