"""Fits multiply matrices in one thread, and leave the process as they found it."""

import numpy as np
import pytest
from estimation_plants import record, slider
from threadpoolctl import threadpool_info, threadpool_limits

from identification.estimation.estimation import estimate
from identification.pool import one_blas_thread


def threads():
    return {each["num_threads"] for each in threadpool_info() if each["user_api"] == "blas"}


def test_one_thread_inside_and_as_many_as_before_after_it():
    with threadpool_limits(2, "blas"):
        with one_blas_thread():
            assert threads() == {1}
            with one_blas_thread():
                assert threads() == {1}
            assert threads() == {1}
        assert threads() == {2}


def test_an_error_inside_leaves_as_many_as_before():
    with threadpool_limits(2, "blas"):
        with pytest.raises(ValueError, match="inside"), one_blas_thread():
            raise ValueError("inside")
        assert threads() == {2}


def test_a_fit_has_one_thread_and_finds_the_truth():
    log, seen = record(slider(), ("position",), n=80), []
    with threadpool_limits(2, "blas"):
        found = estimate(
            slider(damping=2.3), log, ("damping",), progress=lambda _: seen.append(threads())
        )
        assert threads() == {2}
    assert len(seen) > 0
    assert all(each == {1} for each in seen)
    np.testing.assert_allclose(
        found.values["damping"], slider().parameters.values()["damping"], rtol=1e-5
    )
