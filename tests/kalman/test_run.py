"""A value set is simulated once for its outputs and for its trajectory."""

from collections import Counter

import numpy as np
import pytest
from discovery_cases import OPTIONS, nominal_model, record, slider, wander
from test_extend_point import log, plant

from identification.innovations.fit import fit_with_effects
from identification.kalman import trajectory as run_file
from identification.kalman.trajectory import Run
from identification.logs.joined import join_logs
from identification.model.predictor import Predictor


@pytest.mark.parametrize("hold", ["zoh", "foh"])
def test_its_outputs_are_those_that_are_predicted(hold):
    joined = join_logs([log(1, hold), log(2, hold)])
    predictor, values = Predictor(plant(), joined, ("damping",)), np.array([1.7])
    run = Run(predictor, values)
    np.testing.assert_array_equal(run.outputs, predictor.predict(values)[0])
    for along, own in zip(run.along, (joined.outputs[:40], joined.outputs[40:]), strict=True):
        assert len(along.states["qpos"]) == len(own)


def test_a_fit_simulates_no_value_set_twice(monkeypatch):
    asked, predict, follow = Counter(), Predictor.predict, run_file.follow_records

    def predicted(self, values, samples=None):
        asked.update(row.tobytes() for row in np.atleast_2d(values))
        return predict(self, values, samples)

    def followed(predictor, values, *points):
        asked[values.tobytes()] += 1
        return follow(predictor, values, *points)

    monkeypatch.setattr(Predictor, "predict", predicted)
    monkeypatch.setattr(run_file, "follow_records", followed)
    seen = record(slider(mass=2.4, damping=2.6), 200, 1, error=wander(200, 0.05, 0.1, seed=1))
    end = fit_with_effects(nominal_model(), seen, (), {}, OPTIONS)
    assert end.steps > 1
    assert set(asked.values()) == {1}
