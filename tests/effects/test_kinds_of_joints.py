"""On a robot with hinges and slides, each effect says on which of them it acts."""

import pytest

from identification.effects.axes import Axis
from identification.effects.catalogue import TURNS, joint_effects
from identification.effects.joint_group import SLIDE
from identification.effects.named import unknown_effect, unknown_number

HINGE, SLIDER = Axis("pivot", "hinge", 1.0, 1.0, 1.0), Axis("rail", "slide", 1.0, 1.0, 1.0)
BOTH = joint_effects((HINGE, SLIDER), TURNS)


def test_words_tell_the_kind_where_there_are_both() -> None:
    for effect in BOTH:
        kind = "(slides)" if SLIDE in effect.name else "(hinges)"
        assert effect.phrase.endswith(kind), effect.name
        assert {*effect.places.values()} == {"@rail" if SLIDE in effect.name else "@pivot"}
    assert len({e.phrase for e in BOTH}) == len(BOTH)


@pytest.mark.parametrize("axis", [HINGE, SLIDER])
def test_nothing_is_added_where_there_is_one_kind(axis: Axis) -> None:
    for effect in joint_effects((axis,), TURNS):
        assert SLIDE not in effect.name
        assert "(" not in effect.phrase


def test_messages_that_list_names_say_when_they_begin_with_slide() -> None:
    of_both = str(unknown_effect("effect:", "slide_coulombfriction", BOTH))
    assert "did you mean 'slide_coulomb_friction'?" in of_both
    assert of_both.endswith("begin with slide_ here, because effects may act on hinges too.")
    slides = joint_effects((SLIDER,), TURNS)
    of_one = str(unknown_number("slide_coulomb_friction.f_c@rail", slides))
    assert "did you mean 'coulomb_friction.f_c@rail'?" in of_one
    assert of_one.endswith("begin with slide_ only where effects may act on hinges too.")
    assert "slide" not in str(unknown_effect("effect:", "nothing", slides))
