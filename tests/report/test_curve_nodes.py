"""The nodes that are told are those of the law: at node k a curve is c_k."""

from dataclasses import replace

import fake_discovery
import numpy as np
import pytest
from joint_cases import arm, reached, seen, share, slider

from identification.effects.effect import Candidate
from identification.quantities import quantity
from identification.report.discovery.named_words import curve_nodes, curve_top, node_lines

C = (1.0, -2.0, 3.0, -4.0, 5.0, -6.0, 7.0, -8.0)
FIELD = {"speed": "v", "load": "f_u", "position": "q", "time": "time",
         "before": "x_before", "behind": "x_behind",
         "speed_before": "v_before", "speed_behind": "v_behind"}  # fmt: skip
ENDS = {("before", "joint shoulder"), ("behind", "joint elbow")}  # no such neighbour
NEIGHBOUR = {"joint elbow": "shoulder", "joint shoulder": "elbow"}
CASES = [
    (plant, effect, where)
    for plant in (arm(), slider())
    for effect in plant.effects
    if effect.is_curve
    for where in effect.places
    if (effect.name.rpartition("_")[2], where) not in ENDS
]


@pytest.mark.parametrize(
    ("plant", "effect", "where"), CASES, ids=[f"{e.name}-{w}" for _, e, w in CASES]
)
def test_a_curve_has_its_sizes_at_its_nodes(plant, effect, where):
    candidate = Candidate(effect, where, {})
    (nodes,) = curve_nodes(candidate, plant)
    joint, field = where.removeprefix("joint "), FIELD[nodes.depends_on]
    beside = nodes.depends_on.endswith(("before", "behind"))
    neighbour = NEIGHBOUR[where] if beside else ""
    (law,) = effect.hooks.values()
    for at, c in zip(nodes.at, C, strict=True):
        x = at
        if beside:
            is_speed, top = nodes.depends_on.startswith("speed"), reached(plant, neighbour)[2]
            x = at / top if is_speed else share(plant, neighbour, at)
        s = seen(plant, joint, 0.0, 0.0, 0.0, 0.0, 0.0)._replace(**{field: x})
        assert law.py_func(s, C) == pytest.approx(c, rel=1e-9)
    assert (neighbour or joint) in nodes.reads or nodes.reads == "time"
    assert np.isfinite(nodes.at).all()
    parameters = {f"c_{k + 1}": (c, 0.1, "N m") for k, c in enumerate(C)}
    named = replace(fake_discovery.found().named[0], candidate=candidate, parameters=parameters)
    size, place = curve_top(named, plant)
    assert size == quantity(C[-1], 0.1, "N m")
    assert place == f"{nodes.reads}: {quantity(nodes.at[-1], unit=nodes.unit)}"
    first, *told = node_lines(named, plant)
    assert nodes.reads in first
    order = np.argsort(nodes.at, kind="stable")
    assert [float(line.partition(": ")[2].split()[0]) for line in told] == [C[k] for k in order]


@pytest.mark.parametrize("std", [0.0, np.nan, np.inf], ids=["at a bound", "few data", "none"])
def test_a_node_that_no_data_hold_has_no_force(std):
    plant, effect, where = CASES[0]
    parameters = {f"c_{k + 1}": (c, 0.1, "N m") for k, c in enumerate(C)}
    parameters["c_2"] = (-13.1, std, "N m")
    named = replace(
        fake_discovery.found().named[0], candidate=Candidate(effect, where, {}),
        parameters=parameters,
    )  # fmt: skip
    said = "\n".join(node_lines(named, plant))
    assert said.count("not known, too few data") == 1
    assert "13.1" not in said
