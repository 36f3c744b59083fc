"""Tasks and seeds come from the TOML alone; what it gets wrong is refused in a sentence."""

import json

import numpy as np
import pytest
from sweep_cases import GRID, METHOD

from identification.sweep.config import read_sweep
from inca_mj.studies import METHODS

TWO = f"seed = 3\n[[study]]\nname='one'\nmethod='{METHOD}:TOSS'\ncount=4\n{{}}\n" + (
    f"[[study]]\nname='two'\nmethod='{METHOD}:TOSS'\ncount=3\n[study.grid]\nsize=[1, 2]\n"
)


TRIAL = "[[study]]\nmethod = 'trial'"
PRACTICE = "[[study]]\nmethod = 'practice-discovery'"
WORLDS = "[[study]]\nmethod = 'world-score'"


def of(tmp_path, text, known=()):
    path = tmp_path / "sweep.toml"
    path.write_text(text)
    return read_sweep(path, dict(known))


def test_seeds_are_those_that_spawn_makes(tmp_path):
    sweep = of(tmp_path, TWO.format(GRID))
    nested = [
        seed
        for child, points, count in zip(
            np.random.SeedSequence(3).spawn(2), (6, 2), (4, 3), strict=True
        )
        for point in child.spawn(points)
        for seed in point.spawn(count)
    ]
    assert len(sweep) == len(nested) == 30
    states = [seed.generate_state(4).tolist() for seed in nested]
    ours = [sweep.task(n).seed.sequence().generate_state(4).tolist() for n in range(30)]
    assert ours == states
    assert len({tuple(state) for state in states}) == 30
    assert all(0 <= sweep.task(n).seed.number() < 2**31 for n in range(30))


def test_a_paired_study_has_the_same_seeds_at_all_points(tmp_path):
    sweep = of(tmp_path, TWO.format("paired = true\n" + GRID))
    seeds = [sweep.task(n).seed for n in range(24)]
    assert all(seeds[n] == seeds[n % 4] for n in range(24))
    assert len(set(seeds)) == 4


def test_the_last_axis_changes_fastest_and_defaults_are_told(tmp_path):
    sweep = of(tmp_path, TWO.format(GRID))
    shown = [sweep.shown(n) for n in range(0, 24, 4)]
    assert [(s["size"], s["word"]) for s in shown] == [
        (size, word) for size in (0.5, 2.0, 8.0) for word in "ab"
    ]
    assert {**shown[0]} == {
        "size": 0.5, "word": "a", "mass": None, "seconds": 0.0, "bad": False, "marker": None
    }  # fmt: skip


def test_the_digest_follows_what_tasks_depend_on(tmp_path):
    same = of(tmp_path, "# a remark\nabout = 'x'\n" + TWO.format(GRID)).digest()
    assert same == of(tmp_path, TWO.format(GRID)).digest()
    for other in (TWO.replace("seed = 3", "seed = 4"), TWO.replace("[1, 2]", "[1, 3]"),
                  TWO.replace("count=3", "count=2"), TWO.replace("'two'", "'2'")):  # fmt: skip
        assert of(tmp_path, other.format(GRID)).digest() != same


def test_files_of_a_folder_are_an_axis(tmp_path, monkeypatch):
    data = tmp_path / "data"
    data.mkdir()
    for name in "abc":
        (data / f"{name}.csv").touch()
    labels = {"a": {"kind": "null"}, "b": {"kind": "single", "effects": ["x"]}, "c": {}}
    (data / "labels.json").write_text(json.dumps(labels))
    monkeypatch.setenv("DATA", str(data))
    text = f"[[study]]\nmethod='{METHOD}:TOSS'\n[study.grid]\nmarker={{}}\n"
    sweep = of(tmp_path, text.format("{ files = '$DATA/*.csv' }"))
    assert [sweep.shown(n)["marker"] for n in range(3)] == [f"$DATA/{n}.csv" for n in "abc"]
    assert sweep.task(2).settings["marker"] == str(data / "c.csv")
    chosen = of(tmp_path, text.format("{ files = 'data/*.csv', label = { effects = 'x' } }"))
    assert [chosen.shown(n)["marker"] for n in range(len(chosen))] == ["data/b.csv"]
    assert chosen.task(0).settings["marker"] == str(data / "b.csv")


@pytest.mark.parametrize(("text", "words"), [
    ("seed = 1", "has no [[study]]"),
    ("speed = 1\n[[study]]\nmethod = 'trial'", "unknown key .*'speed'; did you mean 'seed'"),
    ("[[study]]\nmethod = 'trail'", "unknown method 'trail'; did you mean 'trial'"),
    ("[[study]]\nmethod = 'no.py:M'", "there is no file .*no.py"),
    (TRIAL + "\ncounts = 2", "unknown key in .*'counts'"),
    (TRIAL + "\ncount = 0", "count in .* must be 1 or more"),
    (TRIAL + "\n[study.settings]\ntrials = 4", "unknown setting .*'trials'"),
    (TRIAL + "\n[study.settings]\ntrial = '4'", "trial in .* a whole number"),
    (TRIAL + "\n[study.grid]\ntrial = 3", "must be a list of values"),
    (TRIAL + "\n[study.grid]\ntrial = [4, 4]", "has a value twice"),
    (TRIAL + "\n[study.grid]\ntrial = { first = 1 }", "both first and count"),
    (TRIAL + "\n[study.settings]\ntrial=4\n[study.grid]\ntrial=[4]", "in grid"),
    (TRIAL + "\n[study.grid]\nnoise_seed = { first = 1, count = 200000 }", "100000 at most"),
    ("[[study]]\nmethod='null-score'", "does not say 'robot'"),
    (PRACTICE + "\n[study.grid]\nlog={files='no/*.csv'}", "no file matches .*no/"),
    (PRACTICE + "\n[study.settings]\nlog='*.csv'", r'as log = \{ files = "\*.csv" \}'),
    (WORLDS + "\n[study.settings]\nspread='much'", "spread in .* or give none or usual"),
    (WORLDS + "\n[study.settings]\nduration=-1", "'world-score': duration = -1 .* 0.02 s"),
    (WORLDS + "\n[study.settings]\nworld=-1", "world -1 is negative"),
    (PRACTICE + "\n[study.settings]\nlog='$NO_SUCH/a.csv'",
     "needs the variable NO_SUCH"),
])  # fmt: skip
def test_bad_sweeps_are_refused_before_anything_runs(tmp_path, refusal, text, words):
    import re

    path = tmp_path / "sweep.toml"
    path.write_text(text)
    assert re.search(words.replace("[[", r"\[\["), refusal(read_sweep, path, METHODS))
