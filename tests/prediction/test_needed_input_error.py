"""How much the inputs would have to err to make what a fitted model leaves."""

from dataclasses import replace

import numpy as np
import pytest
from records_cases import HORIZON, NOISE, STEP, nominal_model, pendulum, record

from identification.model.predictor import Predictor
from identification.prediction.input_error import needed_input_error
from identification.prediction.nominal_fit import fit_nominal
from identification.prediction.records import as_records


def disturbed(seed, share):
    """A record whose input errs by a constant over each window, which the log does not have."""
    log, rng = record(seed, samples=300), np.random.default_rng(100 + seed)
    length = round(HORIZON / STEP)
    size = share * np.sqrt(np.mean(log.inputs**2))
    error = np.repeat(size * rng.standard_normal(len(log) // length + 1), length)[: len(log), None]
    y = Predictor(pendulum(), replace(log, inputs=log.inputs + error), ()).predict(np.zeros((1, 0)))
    return replace(log, outputs=y[0] + NOISE * rng.standard_normal(y[0].shape))


@pytest.mark.parametrize("share", [0.0, 0.1])
def test_an_error_of_the_inputs_is_found_as_large_as_it_is(share):
    logs = [disturbed(k, share) for k in range(1, 4)]
    found = fit_nominal(nominal_model(), as_records(logs[:2], logs[2:]))
    error = needed_input_error(found.fit, found.unseen.floor)
    if share:
        assert error == pytest.approx(share, rel=0.3)
    else:
        assert error < 0.005
