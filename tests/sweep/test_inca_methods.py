"""Methods on INCA: worlds are those of their numbers, labels are read, estimates meet the truth."""

import json

import numpy as np
import pytest

from identification.errors import InputError
from identification.sweep.method import Seed, load_method
from identification.sweep.work import checked
from inca_mj.robot.parameters import parameter_set
from inca_mj.studies import METHODS
from inca_mj.studies.excitation import excitation_findings
from inca_mj.studies.null_score import null_findings
from inca_mj.studies.practice import truth_of
from inca_mj.studies.world_score import score_findings
from inca_mj.studies.world_settings import WorldSettings, make_world
from inca_mj.studies.worlds import (
    CHANGES,
    FAULTS,
    HIDDEN_EFFECTS,
    UNLISTED,
    HiddenSetting,
    draw_effect,
    records,
    world,
)

SEED = Seed(5, (0, 0, 3))


def test_a_null_world_is_that_of_its_number():
    settings = WorldSettings(world=11, kind="null", duration=1.0, rate=50.0, coloured=True)
    (log,), truth = make_world(settings, SEED)
    setting = HiddenSetting(
        input="multisine", duration=1.0, sampling_time=1 / 50, error_rms=5e-4
    )  # fmt: skip
    np.testing.assert_array_equal(log.outputs, world(11, setting=setting).log.outputs)
    assert (truth["kind"], truth["hidden"], truth["ratio"]) == ("null", [], 0.0)


def test_without_a_number_the_seed_gives_one():
    settings = WorldSettings(kind="null", duration=0.5)
    (first,), truth = make_world(settings, SEED)
    (second,), _ = make_world(WorldSettings(world=SEED.number(), kind="null", duration=0.5), SEED)
    assert truth["world"] == SEED.number() != Seed(5, (0, 0, 4)).number()
    np.testing.assert_array_equal(first.outputs, second.outputs)


def test_an_effect_that_is_asked_for_is_hidden_with_its_ratio():
    settings = WorldSettings(world=4, kind="listed", effect="quadratic_friction", ratio=5.0,
                             duration=1.0, records=2)  # fmt: skip
    logs, truth = make_world(settings, SEED)
    made = records(
        4, [draw_effect("quadratic_friction", 4)], n=2, ratio=5.0,
        inputs=("prbs", "multisine", "prbs"), setting=HiddenSetting(duration=1.0),
    )  # fmt: skip
    for ours, theirs in zip(logs, made, strict=True):
        np.testing.assert_array_equal(ours.outputs, theirs.log.outputs)
    assert truth["hidden"] == ["quadratic_friction"]
    assert truth["hidden_size_of"] == ["quadratic_friction.c@all drives"]
    assert truth["hidden_sizes"] == [made[0].truth.effects[0].c]


def test_of_six_mixed_worlds_one_hides_nothing_and_one_an_unlisted_effect(monkeypatch):
    from inca_mj.studies.world_settings import _drawn

    settings = WorldSettings(kind="mixed", first=100, effects=2)
    drawn = [_drawn(settings, 100 + k) for k in range(60)]
    assert [kind for kind, *_ in drawn[:6]] == ["null", "pair", "pair", "unknown", "pair", "pair"]
    assert all(not names for kind, names, *_ in drawn if kind == "null")
    assert {n for kind, names, *_ in drawn if kind == "unknown" for n in names} <= {*UNLISTED}
    pairs = [names for kind, names, *_ in drawn if kind == "pair"]
    assert all(len({*names}) == 2 and {*names} <= {*HIDDEN_EFFECTS} for names in pairs)
    assert len({tuple(names) for names in pairs}) > 20
    assert {ratio for *_, ratio in drawn} == {1.0, 3.0, 10.0}
    for kind, names, others, _ in drawn:
        if kind == "pair":
            assert sorted([*names, *others]) == sorted(HIDDEN_EFFECTS)


@pytest.mark.parametrize(("kind", "known"), [("rule", CHANGES), ("sensor", FAULTS)])
def test_a_kind_of_its_own_hides_one_of_its_effects(kind, known):
    from inca_mj.studies.world_settings import _drawn

    drawn = [_drawn(WorldSettings(kind=kind), k) for k in range(150)]
    assert {told for told, *_ in drawn} == {kind}
    assert {name for _, names, *_ in drawn for name in names} == {*known}
    assert all(sorted([*names, *others]) == sorted(known) for _, names, others, _ in drawn)


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"kind": "nul"}, "unknown kind of world 'nul'; did you mean 'null'"),
        ({"effect": "cog"}, "unknown effect 'cog'"),
        (
            {"effect": "cogging", "kind": "sensor"},
            'write kind = "listed", or leave effect out, or one of kind sensor: encoder_ecc',
        ),
        ({"effect": "encoder_lag", "kind": "mixed"}, "is of kind sensor"),
        ({"effect": "cogging", "kind": "null"}, "worlds of kind null do not hide it"),
        ({"effects": 4}, "a world hides 1, 2 or 3"),
        ({"rate": 0.0}, "give samples a second above zero"),
        ({"ratio": -1.0}, "give a number above zero"),
        ({"records": 0}, "give 1 or more"),
        ({"input": "sine"}, "unknown input 'sine'"),
    ],
)
def test_settings_of_worlds_are_checked(settings, words):
    with pytest.raises(InputError, match=words):
        WorldSettings(**settings)


@pytest.mark.parametrize("kind", ["listed", "mixed", "unknown", "rule", "sensor"])
def test_an_effect_of_its_own_kind_may_be_asked_for(kind):
    from inca_mj.studies.world_settings import HIDES, _drawn

    for effect in HIDES.get(kind, HIDDEN_EFFECTS):
        number = 1  # of six mixed worlds, this one hides what is listed
        assert _drawn(WorldSettings(kind=kind, effect=effect), number)[1] == [effect]


def test_labels_are_read(tmp_path, refusal):
    label = {"kind": "pair", "effects": ["cogging", "delay"], "ratio": 20, "where": [3, None],
             "size": {"cog_c": 0.01, "cog_s": -0.02, "delay": 0.004, "other": 1.0}}  # fmt: skip
    (tmp_path / "labels.json").write_text(json.dumps({"log_1": label}))
    truth = truth_of(tmp_path / "log_1.csv")
    sizes = dict(zip(truth["hidden_size_of"], truth["hidden_sizes"], strict=True))
    assert sizes == {"cogging.a@drive 3": 0.01, "cogging.b@drive 3": -0.02, "delay.tau@": 0.004}
    assert truth["hidden_where"] == ["drive 3", ""]
    assert "has no label of log_2" in refusal(truth_of, tmp_path / "log_2.csv")


def test_an_excitation_is_the_information_of_its_robot():
    from inca_mj.twin.run import simulate
    from inca_mj.twin.twin import build_twin
    from inca_mj.workflows.excitation import Bench
    from inca_mj.workflows.identification import UNKNOWN
    from inca_mj.workflows.limits import Limits
    from inca_mj.workflows.recipes import SAMPLING, standard_inputs

    method = load_method(METHODS["excitation"])
    name, currents = standard_inputs(51)[6]
    settings = method.settings(input=name, duration=0.5, spread=0.0)
    record = checked(method.run(settings, SEED), method.columns)
    robot = build_twin(parameter_set("trial"), visual=False)
    bench = Bench(robot, settings.noise, UNKNOWN, Limits())
    found = bench.attempt(name, simulate(robot, currents, SAMPLING)).found
    np.testing.assert_allclose(record["std"], found.std, rtol=1e-12)
    assert record["names"] == [*UNKNOWN]
    told = excitation_findings([{**record, "set.input": name}] * 2).record["inputs"][name]
    assert told["worst_std"] == pytest.approx(found.e_value**-0.5)


def test_false_names_are_counted_by_noise():
    rows = [
        {"set.coloured": coloured, "false_name": k == 0 and coloured, "names": ["a, b"] * (k == 0),
         "below_5_percent": 0.05, "below_5_percent_blocks": 0.1}
        for coloured in (False, True) for k in range(4)
    ]  # fmt: skip
    found = null_findings(rows).record
    assert found["white"]["a_false_name"]["hits"] == 0
    assert found["coloured"]["a_false_name"]["value"] == 0.25
    assert found["coloured"]["below_5_percent_blocks"] == pytest.approx(0.1)


def test_scores_are_counted_by_effect():
    rows = [{"hidden": ["delay"], "found": k < 2, "shown": True} for k in range(3)]
    rows.append({"hidden": [], "found": None, "shown": False})
    found = score_findings(rows).record["by_effect"]
    assert found["delay"]["found"]["hits"] == 2
    assert found["nothing"]["found"]["of"] == 0
