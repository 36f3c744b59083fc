"""A signal that moves within a simulation step, as one number a step.

    m_k = (1/h) ∫ i dt,    D_k = (1/h²) ∫ (t - t_mid) i dt          over step k
    i_k = m_k - D_k + D_(k-1)

The mean keeps the impulse of the step; passing D on to the next one keeps its moment too, so that
what is lost is of third order in h.
"""

import numpy as np


def stepwise(mean: np.ndarray, moment: np.ndarray) -> np.ndarray:
    """Values of the steps [A] from m and D of each, shape (steps,)."""
    return mean - moment + np.concatenate([[0.0], moment[:-1]])
