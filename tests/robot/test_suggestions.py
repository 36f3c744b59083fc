"""The torques of joints suggest effects to a search over windows, which judges them."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from records_cases import listed, nominal_model, records
from torque_cases import TOML, planar_record, planar_robot

from identification.discovery.candidates import list_common
from identification.discovery.options import DiscoveryOptions
from identification.prediction.discovery import discover_records
from identification.prediction.selection import selection
from identification.robot.second_opinion import ask_torques
from identification.robot.suggestions import suggest

HIDDEN = {
    "hardening.k_3@hinge": 0.1, "gravity_force.alpha@hinge": 0.3, "quadratic_friction.c@hinge": 0.02
}  # fmt: skip


@pytest.fixture(scope="module")
def loaded(tmp_path_factory):
    """A planar arm that carries what its model lacks, with more friction at both joints."""
    folder = tmp_path_factory.mktemp("loaded")
    first, second = (planar_record(k, 0.7, name=f"r{k}", f=1.6) for k in (11, 12))
    return planar_robot(folder, first, confirm=[second])


@pytest.fixture(scope="module")
def evidence(loaded):
    return ask_torques(loaded)


def test_a_payload_and_frictions_at_several_joints_are_suggested(loaded, evidence):
    found = suggest(evidence, loaded)
    assert [c.key for c in found] == [
        ("payload", "body fore"), ("coulomb_friction", "joint shoulder and joint elbow"),
    ]  # fmt: skip
    assert found[1].sizes == ("coulomb_friction.f_c@shoulder", "coulomb_friction.f_c@elbow")


def test_a_friction_that_is_fitted_is_not_suggested(loaded, tmp_path):
    free = TOML.replace("free = [", 'free = ["joint/shoulder.frictionloss", ')
    free += '[parameters."joint/shoulder.frictionloss"]\nknown = 0.5\n'
    robot = planar_robot(tmp_path, loaded.log, toml=free, confirm=[*loaded.records])
    keys = [c.key for c in suggest(ask_torques(robot), robot)]
    assert ("coulomb_friction", "joint elbow") in keys


def test_a_load_at_any_place_is_a_payload_and_a_name_without_a_candidate_is_left_out(
    loaded, evidence
):
    load = next(s for s in evidence.scores if s.missing.name == "load")
    gain = next(s for s in evidence.scores if s.missing.name == "gain")
    asked = SimpleNamespace(added=(load, gain), friction=(), final=evidence.final)
    where = load.missing.where
    assert [c.key for c in suggest(asked, loaded)] == [("payload", where), ("load", where)]


def test_a_level_that_changes_is_suggested_with_the_level(loaded, evidence):
    """Along a way that does not pass zero, a level that grows along it is hard to tell from one."""
    elbow = "joint elbow"
    grows = SimpleNamespace(name="position_dependent_friction", where=elbow, shape=())
    asked = SimpleNamespace(
        added=(SimpleNamespace(missing=grows),), friction=(), final=evidence.final
    )
    assert [c.key for c in suggest(asked, loaded)] == [
        ("position_dependent_friction", elbow), ("coulomb_friction", elbow)
    ]  # fmt: skip


def search(hidden, suggested, *without):
    """What is found in two records to fit and two that confirm, with some effects suggested."""
    logs = records(4, hidden, samples=240)
    known = [e.partition(".")[0] for e in HIDDEN]
    laws = listed(*known)
    told = [c for c in list_common(laws) if c.effect.name in suggested]
    return discover_records(
        nominal_model(), logs[:2], logs[2:], laws, None, DiscoveryOptions(without=without), told
    )  # fmt: skip


def test_a_suggested_effect_is_refitted_whatever_its_score_is(monkeypatch):
    monkeypatch.setattr(selection, "list_contenders", lambda *_: [])
    hidden = {"hardening.k_3@hinge": 0.1}
    rest = ("add_set", "add_curve", "add_yielding_friction")
    (named,) = search(hidden, ["hardening"], *rest).named
    assert named.name == "hardening"
    assert search(hidden, ["hardening"], *rest, "suggested_effects").named == ()


def test_what_changes_a_level_is_not_refitted_without_one(monkeypatch):
    """Else it takes the level's place: f_q q is nearly a level where q is far from zero."""
    monkeypatch.setattr(selection, "list_contenders", lambda *_: [])
    logs = records(4, {"coulomb_friction.f_c@hinge": 0.3}, samples=240)
    changes = listed("asymmetric_friction")
    options = DiscoveryOptions(without=("add_set", "add_curve", "add_yielding_friction"))
    found = discover_records(
        nominal_model(), logs[:2], logs[2:], changes, None, options, list_common(changes)
    )
    assert (found.named, found.rejected) == ((), ())


def test_a_suggestion_that_is_not_there_is_not_named():
    assert search({}, ["hardening", "gravity_force"]).named == ()
