"""The input that tells look-alikes apart: laws of its distance."""

from dataclasses import replace

import pytest
from fake_discovery import LATE, MISMATCH, STRIBECK, found

from inca_mj.workflows.discovery_model import _distance


@pytest.fixture(scope="module")
def at():
    return found(one_of=True).final.point


def test_an_effect_imitates_itself(at):
    other = _distance(at, at.log, STRIBECK, LATE, 1e-3)
    own = _distance(at, at.log, STRIBECK, STRIBECK, 1e-3)
    assert own < 1e-6 * other


def test_half_the_noise_is_twice_the_distance(at):
    one, two = (_distance(at, at.log, STRIBECK, MISMATCH, s) for s in (1e-3, 5e-4))
    assert two == pytest.approx(2 * one)


def test_a_longer_record_tells_more(at):
    log = at.log
    half = replace(
        log, time=log.time[:50], inputs=log.inputs[:50], outputs=log.outputs[:50], extras={}
    )
    assert _distance(at, half, STRIBECK, MISMATCH, 1e-3) < _distance(
        at, log, STRIBECK, MISMATCH, 1e-3
    )
