"""A law that was found beside a curve at its joint may be what the curve leaves, and is no name."""

from types import SimpleNamespace

import pytest
from arm_cases import LOG, text

from identification.effects.effect import Candidate
from identification.effects.plant.joint_plant import candidates, joint_plant
from identification.prediction.judging.trial import Contender
from identification.prediction.moves import drop_beside_curves
from identification.windows.comparison import Prediction

KNOWN = {e.name: e for e in candidates(joint_plant(text(0.002, "implicitfast"), (), LOG), ())}
AT = {"s": "joint shoulder", "e": "joint elbow"}


def found(word):
    """The effect of a word such as "curve_speed s", at the joint of its last letter."""
    name, _, place = word.partition(" ")
    where = AT.get(place) or next(iter(KNOWN[name].places))
    candidate = Candidate(KNOWN[name], where, {s.name: s.values[0] for s in KNOWN[name].shapes})
    blank = dict.fromkeys(Prediction.__dataclass_fields__)
    return Contender(
        model=SimpleNamespace(candidates=(candidate,)), prediction=Prediction(**blank),
        gains=None, numbers=1, criterion=0.0, explained=0.0, doubt=None,
    )  # fmt: skip


@pytest.mark.parametrize(("accepted", "kept"), [
    (["curve_speed s", "coulomb_friction s"], ["curve_speed s"]),
    (["curve_speed s", "coulomb_friction e"], ["curve_speed s", "coulomb_friction e"]),
    (["coulomb_friction s", "curve_speed s"], ["coulomb_friction s", "curve_speed s"]),
    (["curve_speed s", "encoder_offset"], ["curve_speed s"]),  # it may act at any joint
])  # fmt: skip
def test_laws_stay_that_came_first_or_act_at_other_joints(monkeypatch, accepted, kept):
    each = tuple(map(found, accepted))
    model = SimpleNamespace(candidates=[a.candidate for a in each])
    task = SimpleNamespace(nominal_model=None, confirm=())
    monkeypatch.setattr(drop_beside_curves, "refitted", lambda *given: "without")
    state = SimpleNamespace(model=model, accepted=each, task=task)
    new, stay, lost = drop_beside_curves.drop_beside_curves(state, lambda line: None)
    assert stay == tuple(a for a, word in zip(each, accepted, strict=True) if word in kept)
    assert [a.doubt for a in lost] == ["curve"] * (len(accepted) - len(kept))
    assert new == ("without" if lost else model)
