"""From records to a verdict: a hidden law is named, an empty one is not, and what is refused."""

import json
from dataclasses import replace
from functools import cache

import pytest
from page_text import text_of
from pendulum_robot import TOML, make_folder, written
from records_cases import nominal_model, pendulum, record, records

from identification.__main__ import main
from identification.discovery.findings.records_evidence import ShiftedRecord
from identification.discovery.options import DiscoveryOptions
from identification.effects.joint_plant import candidates
from identification.errors import InputError
from identification.prediction.discovery import discover_records
from identification.report.discovery_json import discovery_to_json
from identification.report.discovery_report import discovery_text, write_discovery_report
from identification.report.finding_words import describe_finding

SAMPLES = 300  # of each record
MU = "transmitted_load_friction.mu@hinge"


def rows(log, count):
    """The first samples of a log."""
    cut = {name: getattr(log, name)[:count] for name in ("time", "inputs", "outputs")}
    return replace(log, **cut)


FEW = ("transmitted_load_friction", "gravity_load_friction", "quadratic_friction", "offset")


@cache
def found(mu=0.15, names=FEW):
    logs = records(4, {MU: mu} if mu else None, samples=SAMPLES)
    effects = [e for e in candidates(pendulum(), ("J", "d")) if e.name in names]
    return discover_records(nominal_model(), logs[:2], logs[2:], effects)


def test_friction_under_the_transmitted_load_is_named_with_its_size():
    answer = found()
    assert answer.verdict == "named"
    (named,) = answer.named
    assert named.candidate.effect.name == "transmitted_load_friction"
    value, std, _ = named.parameters["mu"]
    assert abs(value - 0.15) < 4 * std
    assert std < 0.02
    assert len(named.proof.agrees) == 2
    assert named.proof.disagrees == ()
    assert answer.share > 0.9
    assert all(describe_finding(f) for f in answer.findings)
    said = discovery_text(answer)
    assert "grows with the transmitted load" in said
    assert "The named effect lowers the error on 2 of 2 unseen records." in said
    assert answer.repeats == ()
    head, *rows = said[said.index("fitted values:") :].splitlines()[1:5]
    assert head.split("  ")[1] == "parameter"
    assert head.endswith("fitted without effects  fitted with what is named")
    first = [row.strip().split("  ")[0] for row in rows]
    assert first == ["J", "d", "mu, friction – grows with the transmitted load, joint hinge"]
    assert all("±" in row for row in rows)
    assert "g m^2" in rows[0]


def test_a_record_that_repeats_another_is_no_further_witness():
    first, second, third = records(3, {MU: 0.15}, samples=SAMPLES)
    again = replace(third, name="again", outputs=third.outputs + 1e-5)
    effects = [e for e in candidates(pendulum(), ("J", "d")) if e.name == FEW[0]]
    answer = discover_records(nominal_model(), [first, second], [third, again], effects)
    assert answer.repeats == ("again",)
    assert discovery_to_json(answer)["repeats"] == ["again"]
    said = discovery_text(answer)
    assert "on the unseen record. again repeats the motion of others and does not" in said
    (named,) = answer.named
    assert named.compared == 0
    assert "no other came near enough to be refitted in its place, and 95 % is the highest" in said
    (other,) = (e for e in candidates(pendulum(), ("J", "d")) if e.name == "offset")
    twin = replace(answer, named=(replace(named, same_as=other),))
    assert '(or "force – constant": below the Coulomb friction it is' in discovery_text(twin)
    assert discovery_to_json(twin)["effects"][0]["same_as"] == "offset"
    beside = replace(answer, named=(replace(named, compared=2),))
    assert "2 rivals were refitted in its place" in discovery_text(beside)


def test_records_too_short_to_confirm_are_refused():
    first, second = records(2, {MU: 0.15})
    short = rows(second, 45)
    effects = [e for e in candidates(pendulum(), ("J", "d")) if e.name == FEW[0]]
    with pytest.raises(InputError, match=r"hold 2 windows of 0\.2 s, too few to prove anything"):
        discover_records(nominal_model(), [first], [short], effects)


@pytest.mark.usefixtures("undrawn")
def test_shifts_of_records_stand_in_the_report(tmp_path):
    answer = found()
    plain = write_discovery_report(answer, tmp_path, ["Geoms of a and b touch."]).read_text()
    assert "Shifts in time" not in plain
    assert "Geoms of a and b touch." in text_of(plain)
    late = ShiftedRecord(record="record 3", shift=0.02, std=0.002, fall=0.3, chance=1e-5)
    page = text_of(write_discovery_report(replace(answer, shifts=(late,)), tmp_path).read_text())
    assert "Shifts in time" in page
    assert "20.0 ± 2.0 ms later" in page
    early = replace(late, record="record 4", shift=-315e-6, std=20e-6)
    both = replace(answer, shifts=(late, early))
    page = text_of(write_discovery_report(both, tmp_path).read_text())
    for told in (page, discovery_text(both)):
        assert "20.0 ± 2.0 ms later" in told
        assert "315 ± 20 µs earlier" in told
        assert "-315" not in told


@pytest.mark.usefixtures("undrawn")
def test_steps_that_are_longer_than_the_models_are_told(tmp_path):
    answer = found()
    own = answer.nominal.plant
    own_step = own.bare.model.opt.timestep
    for steps in (1, 2):
        parts = tuple(
            replace(p, predictor=replace(p.predictor, plant=replace(own, steps=steps)))
            for p in answer.nominal.fit.problem.parts
        )
        problem = replace(answer.nominal.fit.problem, parts=parts)
        model = replace(answer.nominal, fit=replace(answer.nominal.fit, problem=problem))
        same = replace(answer, nominal=model)
        assert discovery_to_json(same)["timestep"] == {
            "simulated": pytest.approx(steps * own_step), "model": own_step
        }  # fmt: skip
        is_told = "The search took steps of 10 ms where the model has 5 ms"
        assert (is_told in discovery_text(same)) == (steps > 1)
        page = text_of(write_discovery_report(same, tmp_path).read_text())
        assert (is_told in page) == (steps > 1)


def test_records_without_an_effect_get_no_name():
    answer = found(mu=0.0)
    assert answer.named == ()
    assert answer.verdict == "nothing missing"
    assert "Nothing is missing" in discovery_text(answer)
    large = replace(answer, before=replace(answer.before, rms=9 * answer.noise_rms))
    said = discovery_text(replace(large, input_error=0.021))
    assert said.startswith("No effect is named: ")
    assert "9 times the" in said
    assert "Either the inputs err by 2.1 % of their rms, or something is missing" in said
    # what a tiny error of the inputs makes is noise, but not where it is far above that
    said = discovery_text(replace(large, input_error=0.0))
    assert said.startswith("No effect is named: ")
    assert "9 times the" in said
    assert "noise does not explain all of it" in said
    near = replace(answer, before=replace(answer.before, rms=1.2 * answer.noise_rms))
    assert discovery_text(replace(near, input_error=0.0)).startswith("Nothing is missing")
    assert "error of prediction over 0.2 s, nothing is named:" in discovery_text(answer)
    assert "->" not in discovery_text(answer).partition("nothing is named:")[2].split("\n\n")[0]


def clipped_and_not(names):
    """Two records whose torque is clipped and two whose torque is small; the model begins right."""
    hidden = {"saturation.c@drive": 1.0, "saturation.u_max": 0.4}
    logs = [record(k, SAMPLES, hidden, plant=pendulum()) for k in (1, 2)]
    logs += [record(k, SAMPLES, plant=pendulum(), largest=0.35) for k in (3, 4)]
    effects = [e for e in candidates(pendulum(), ("J", "d")) if e.name in names]
    base = replace(nominal_model(), plant=pendulum())
    return discover_records(base, logs[:2], logs[2:], effects)


def test_what_made_a_fit_worse_than_its_start_is_named_and_told():
    answer = clipped_and_not(("saturation", "offset"))
    assert [n.candidate.effect.name for n in answer.named] == ["saturation"]
    assert answer.named[0].parameters["u_max"][0] == pytest.approx(0.4, rel=0.02)
    said = discovery_text(answer)
    assert "the fitted values predicted unseen data worse than those of the model" in said


def test_a_horizon_is_needed(refusal):
    base, logs = replace(nominal_model(), horizon=None), records(2)
    assert "horizon" in refusal(discover_records, base, logs[:1], logs[1:], [])


ONLY = '[effects]\nonly = ["transmitted_load_friction", "offset"]\n'


@pytest.fixture
def folder(tmp_path):
    make_folder(tmp_path)
    (tmp_path / "robot.toml").write_text(TOML + ONLY)
    written(tmp_path, *records(4, {MU: 0.15}, samples=SAMPLES))
    return tmp_path


@pytest.mark.long
@pytest.mark.usefixtures("undrawn")
def test_the_command_takes_several_logs_and_several_confirm_flags(folder, capsys):
    logs = [str(folder / f"log_{k}.csv") for k in range(4)]
    arguments = ["discover", str(folder / "robot.toml"), *logs[:2], "--confirm", logs[2]]
    out = folder / "out"
    code = main([*arguments, "--confirm", logs[3], "--json", "--out", str(out)])
    record = json.loads(capsys.readouterr().out)
    assert code == 0
    assert record["verdict"] == "named"
    assert [r["role"] for r in record["records"]] == ["fit", "fit", "confirm", "confirm"]
    assert record["effects"][0]["name"] == "transmitted_load_friction"
    assert all(r["after"] < r["before"] for r in record["records"])
    assert {p.name for p in out.iterdir()} >= {"report.html", "result.json", "robot.toml"}


def test_a_search_behind_its_time_limit_answers_and_says_what_it_has_not_tried():
    logs = records(4, {MU: 0.15}, samples=SAMPLES)
    effects = [e for e in candidates(pendulum(), ("J", "d")) if e.name in FEW]
    options = DiscoveryOptions(max_minutes=0.0)
    answer = discover_records(nominal_model(), logs[:2], logs[2:], effects, options=options)
    assert answer.verdict == "unknown effect"
    assert answer.scores
    assert answer.cut_short == ("add_effect", "add_set")
    assert discovery_to_json(answer)["cut_short"] == [*answer.cut_short]
    assert "within these moves: add effect and add set. " in discovery_text(answer)
    assert found().cut_short == ()
