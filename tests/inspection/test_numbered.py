"""Columns that are numbered through belong to the joints in the order of their numbers."""

from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from identification.inspection.channels import Channel
from identification.inspection.matching import match
from identification.inspection.numbered import numbered_matches
from identification.logs.headers.column_words import role_of


def found(*names):
    """An inspected log with these columns, of the roles that their names tell."""
    columns = tuple(SimpleNamespace(name=n, role=role_of(n)) for n in names)
    return SimpleNamespace(columns=columns, answers=())


def channels(joints, follows=""):
    """A drive and a sensor of each joint."""
    drives = [Channel(f"{j}_torque", j, True, follows=follows) for j in joints]
    return [*drives, *(Channel(j, j, False) for j in joints)]


def columns(joints, log, follows=""):
    return {m.channel.name: m.column for m in match(channels(joints, follows), log)}


def numbered(stem, first, count):
    return [stem.format(first + k) for k in range(count)]


@given(
    stem=st.sampled_from(["q_{}", "Joint{}_Pos", "position[{}]", "arm1.q{}", "obs.state.{}"]),
    force=st.sampled_from(["tau_{}", "Joint{}_Force", "effort[{}]", "i{}"]),
    name=st.sampled_from(["A{}", "joint_{}", "panda_joint{}", "arm2_j{}"]),
    first=st.integers(0, 3), base=st.integers(0, 3), count=st.integers(2, 12),
)  # fmt: skip
def test_a_family_is_that_of_the_joints_wherever_its_numbers_begin(
    stem, force, name, first, base, count
):
    joints = numbered(name, base, count)
    seen, told = numbered(stem, first, count), numbered(force, first, count)
    got = columns(joints, found(*seen, *told))
    assert got == {
        **{f"{j}_torque": c for j, c in zip(joints, told, strict=True)},
        **dict(zip(joints, seen, strict=True)),
    }


def test_the_order_is_that_of_numbers_and_not_of_the_log_or_the_model():
    joints = ["j3", "j1", "j2"]
    assert columns(joints, found("q_12", "q_10", "q_11")) == {
        "j1": "q_10", "j2": "q_11", "j3": "q_12",
        **{f"j{k}_torque": "" for k in (1, 2, 3)},
    }  # fmt: skip


def test_of_two_families_the_one_with_fewer_words_counts_and_of_equals_none():
    joints = ["A1", "A2"]
    got = columns(joints, found("q_0", "q_1", "tau_ext_0", "tau_ext_1", "tau_0", "tau_1"))
    assert (got["A1_torque"], got["A2_torque"]) == ("tau_0", "tau_1")
    drives = channels(joints)
    assert numbered_matches(drives, found("tau_0", "tau_1", "effort_0", "effort_1")) == ()


def test_rates_are_no_positions_and_forces_no_setpoints():
    joints = ["A1", "A2"]
    log = found("dq_0", "dq_1", "q_0", "q_1", "tau_0", "tau_1", "cmd_0", "cmd_1")
    got = columns(joints, log, "position")
    assert (got["A1"], got["A2"]) == ("q_0", "q_1")
    assert (got["A1_torque"], got["A2_torque"]) == ("cmd_0", "cmd_1")


@pytest.mark.parametrize("names", [
    ("q_0", "q_1", "q_3"), ("q_0", "q_1"), ("q_0", "q_1", "q_2", "q_3"), ("q_a", "q_b", "q_c"),
])  # fmt: skip
def test_a_family_with_a_gap_or_of_another_size_is_no_family_of_the_joints(names):
    assert numbered_matches(channels(["A1", "A2", "A3"])[3:], found(*names)) == ()


@pytest.mark.parametrize("more", ["temp_{}", "x_{}", "status{}"])
def test_numbered_columns_that_are_no_motion_and_no_force_are_nobodys(more):
    others = numbered(more, 0, 2)
    assert numbered_matches(channels(["A1", "A2"]), found(*others)) == ()
    seen, told = numbered("joint{}_pos", 1, 2), numbered("joint{}_torque", 1, 2)
    got = columns(["joint1", "joint2"], found(*others, *seen, *told))
    assert [got[c] for c in ("joint1", "joint2")] == seen
    assert [got[f"{c}_torque"] for c in ("joint1", "joint2")] == told


def test_names_of_joints_tell_more_than_numbers():
    log = found("q_0", "q_1", "knee_pos", "hip_pos", "tau_0", "tau_1", "hip_tau", "knee_tau")
    got = columns(["hip", "knee"], log)
    assert (got["hip"], got["knee"]) == ("hip_pos", "knee_pos")
    assert (got["hip_torque"], got["knee_torque"]) == ("hip_tau", "knee_tau")
