"""A value that a fit moved far from what was known is told, in std of what was known."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from records_cases import FREE, KNOWN, pendulum, record

from identification.discovery.nominal_model import NominalModel
from identification.prediction.fits.nominal_fit import fit_nominal
from identification.report.words.values import FAR, departure_sentences
from identification.windows.records import as_records

moved = st.dictionaries(
    st.sampled_from(["body/arm.mass", "joint/hinge.damping", "J", "K@3"]), st.floats(-9.0, 9.0)
)


@given(departures=moved)
def test_a_value_is_told_where_it_left_what_was_known(departures):
    (said,) = departure_sentences(SimpleNamespace(departures=departures)) or [""]
    for name, by in departures.items():
        assert (f" {name} by" in said) == (abs(by) > FAR and name != "K@3")


@pytest.mark.parametrize("wrong", [1.0, 5.0])
def test_it_is_the_logarithm_of_the_change_over_the_std_of_what_was_known(wrong):
    plant = pendulum().with_values({"J": 2e-3 / wrong})
    logs = [record(seed=k, plant=pendulum(), samples=200) for k in range(2)]
    model = NominalModel(plant, FREE, KNOWN, 0.2)
    fitted = fit_nominal(model, as_records(logs))
    (std,) = {*KNOWN}
    expected = np.log(fitted.values["J"] / (2e-3 / wrong)) / std
    assert fitted.departures["J"] == pytest.approx(expected)
    assert bool(departure_sentences(fitted)) == (wrong > 1)
