"""Worlds of three effects at once: what acts in them, and how answers are counted."""

import numpy as np
from joint_page import section
from joint_statistics import count_found, has_false_name, is_all_said, summary
from joint_worlds.hidden import EVERY, THREE
from joint_worlds.world import SEVERAL, make_world


def test_the_truth_has_every_one_of_them_and_no_two_with_one_name():
    world = make_world("pendulum", THREE, 7, duration=3.0)
    assert len(world.acting) == SEVERAL
    names = [n for a in world.acting for n in a.names]
    assert len(names) == len({*names})
    assert {*names} == {*world.names}
    assert all(a.effect in a.names and a.size != 0 for a in world.acting)
    known = {k for a in world.acting for k in EVERY[a.effect].known}
    assert not known & {f.kind for f in world.free}  # what would pass for one of them


def row(verdict, *named, unexplained=True):
    """An answer where a friction, an offset below the Coulomb level and a lag act."""

    def acts(effect, size, *names):
        return {"effect": effect, "names": [effect, *names], "joint": "elbow", "size": size,
                "places": ["elbow", "u2"]}  # fmt: skip

    return {
        "duration": 12.0,
        "truth": {
            "robot": "two_link", "effect": THREE, "names": [], "joint": "", "places": [],
            "curve": "", "size": 1.0, "parameters": {"coulomb_friction.f_c@elbow": 0.2},
            "acting": [acts("quadratic_friction", 1.0), acts("offset", 0.1), acts("lag", 0.01)],
        },
        "verdict": verdict, "errors": {"fit": 2.0, "discover": 1.0, "written": 3.0},
        "named": [{"name": n, "where": w, "one_of": bool(alike), "rivals": list(alike),
                   "confidence": 0.85} for n, w, *alike in named],
        "unexplained": unexplained, "processor_seconds": 1.0,
    }  # fmt: skip


def test_answers_are_counted_by_what_they_name_and_where():
    friction, lag = ("quadratic_friction", "joint elbow"), ("lag", "input u2")
    twin = ("asymmetric_friction", "joint elbow")  # an offset below the Coulomb level by its name
    alike = ("delay", "input u2", "lag")
    astray = ("offset", "joint shoulder")
    rows = [
        row("named", friction, twin, lag, unexplained=False), row("named", friction, alike),
        row("named", friction, astray), row("named", friction, unexplained=False),
        row("unknown effect"), row("nothing missing", unexplained=False),
        row("unlisted effect", ("curve_speed", "joint elbow")),
    ]  # fmt: skip
    assert [count_found(r) for r in rows] == [3, 2, 1, 1, 0, 0, 0]
    assert np.flatnonzero([has_false_name(r) for r in rows]).tolist() == [2]
    assert np.flatnonzero([is_all_said(r) for r in rows]).tolist() == [3, 5]
    found = summary(rows)
    assert found["worlds"] == len(rows)
    assert found["all"]["right_first"]["of"] == 0  # they are counted apart
    counted = {k: (r["hits"], r["of"]) for k, r in found["several"]["two_link"].items()}
    assert counted == {
        "all_found": (1, 7), "most_found": (2, 7), "false_name": (1, 7), "all_said": (2, 7),
        "drawn": (1, 7), "worse_than_fit": (0, 7),
    }  # fmt: skip
    assert "| all three are named, each where it acts, goal 60 % | 1 of 7" in section(rows)
