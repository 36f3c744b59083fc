"""A name that is one of a set: the head, the verdict and the next file say so, with its odds."""

from dataclasses import replace

import pytest
from elbow_cases import elbow
from fake_discovery import found

from identification import read_robot
from identification.report.discovery.effect_sections import rivals_section
from identification.report.discovery.json import discovery_to_json
from identification.report.discovery.named_words import confidence_of_set, likely_rivals
from identification.report.discovery.report import discovery_headline
from identification.report.discovery.verdict import discovery_verdict
from identification.report.words.effects import describe_effect, describe_sizes
from identification.report.words.values import phrase
from identification.robot.results.discovery_files import RobotDiscoveryFiles


def odds(own, *others, several=False, unexplained=False):
    """A discovery whose first name has these odds, and as many rivals."""
    made = found(one_of=True, several=several, unexplained=unexplained)
    first, *rest = made.named
    rivals = tuple(replace(first.rivals[0], confidence=share) for share in others)
    return replace(made, named=(replace(first, confidence=own, rivals=rivals), *rest))


def test_the_likeliest_stands_first_and_its_odds_are_its_own():
    answer = odds(0.5, 0.1, 0.3)
    head = discovery_headline(answer)
    assert head.lead == "Missing from the model is one of these, most likely the first"
    (one,) = head.answers
    own, *others = one.place.split("; or ")
    assert own.endswith("(50 %)")
    assert [words[-6:] for words in others] == ["(30 %)", "(10 %)"]
    together = one.tiles[-2]  # before the error
    assert (together.value, together.note) == ("90 %", "50 % for the first alone")
    assert "likeliest" not in " ".join(discovery_verdict(answer))


def test_a_model_that_has_another_one_than_the_likeliest_says_so():
    answer = odds(0.3, 0.6)
    assert discovery_headline(answer).lead.endswith("and the first is not the likeliest")
    assert (
        "The model got the first one, which is not the likeliest." in (discovery_verdict(answer)[0])
    )


def test_of_several_names_each_that_is_one_of_a_set_says_or():
    """ "Missing is one of these" above two names that are both missing would be wrong."""
    head = discovery_headline(odds(0.5, 0.4, several=True))
    assert head.lead == (
        "Missing from the model, together. A name with “or” is one of those that are told with it"
    )
    assert ["; or " in answer.place for answer in head.answers] == [True, False]
    alone = found(several=True)
    assert discovery_headline(alone).lead == "Missing from the model, together"


@pytest.mark.parametrize(("unexplained", "most"), [(False, 0.95), (True, 0.85)])
def test_a_set_is_no_surer_than_a_name_may_be(unexplained, most):
    answer = odds(0.6, 0.4, unexplained=unexplained)
    assert confidence_of_set(answer, answer.named[0]) == most
    assert f"with a confidence of {100 * most:.0f} %." in discovery_verdict(answer)[0]


def test_each_name_of_a_set_has_the_sizes_of_its_own_fit():
    """Only the size of the first one was told, and the truth may be another one."""
    answer = odds(0.5, 0.3, 0.2)
    first, *_ = answer.named
    sized = replace(first.rivals[0], parameters={"delta": (0.2, 0.03, "")})
    second, third = replace(sized, confidence=0.3), first.rivals[1]
    answer = replace(answer, named=(replace(first, rivals=(second, third)),))
    said, rival = discovery_verdict(answer)[0], describe_effect(second.candidate)
    assert f"(50 %), {describe_sizes(first, answer.final.plant)}; {rival}" in said
    sizes = describe_sizes(second)
    assert sizes.startswith("delta = 20.0 ± 3.0 %")
    assert f"; {rival} (30 %), {sizes}; {rival} (20 %). It is one of them" in said
    assert "The model got the first one." in said
    assert f"; or {rival} (30 %), {sizes}; or " in discovery_headline(answer).answers[0].place
    rows = rivals_section(answer).table.rows
    assert [row[2] for row in rows] == [sizes, ""]
    told = discovery_to_json(answer)["effects"][0]["rivals"][0]["parameters"]
    assert told == {"delta": {"value": 0.2, "std": 0.03, "unit": ""}}


def test_another_name_of_the_same_force_has_its_own_size():
    answer = odds(0.5)
    (first,) = answer.named
    twin = replace(found(one_of=True).named[0].rivals[0], parameters={"delta": (0.2, 0.03, "")})
    effect, sizes = twin.candidate.effect, describe_sizes(twin)
    (said, *_) = discovery_verdict(
        replace(answer, named=(replace(first, same_as=effect, twin=twin),))
    )
    assert f'(or "{phrase(effect)}", {sizes}: below the Coulomb friction it is' in said
    (said, *_) = discovery_verdict(replace(answer, named=(replace(first, same_as=effect),)))
    assert f'(or "{phrase(effect)}": below the Coulomb friction it is' in said


def test_what_is_far_less_likely_than_the_first_is_not_told():
    (named,) = odds(0.8, 0.02, 0.15).named
    assert [r.confidence for r in likely_rivals(named)] == [0.15]


def test_the_file_for_the_next_log_says_that_its_effect_is_one_of_a_set(tmp_path):
    robot, made = elbow()
    first = made.named[0]
    rival = replace(found(one_of=True).named[0].rivals[0], confidence=0.3)
    of_set = replace(first, confidence=0.6, one_of=True, rivals=(rival,))
    RobotDiscoveryFiles(replace(made, named=(of_set,)), robot).keep(tmp_path, tmp_path)
    said = (tmp_path / "robot.toml").read_text().splitlines()[0]
    assert said == (
        f"# one of these is missing, and the data do not tell which: {first.name}, {first.where}"
        f" (60 %); or {rival.name}, {rival.where} (30 %); the model has the first one"
    )
    again = read_robot(tmp_path / "robot.toml", robot.paths[0])
    assert {*first.candidate.sizes} <= {*again.file.free}
    RobotDiscoveryFiles(made, robot).keep(tmp_path, tmp_path)
    assert not (tmp_path / "robot.toml").read_text().startswith("#")
