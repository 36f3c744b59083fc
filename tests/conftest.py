"""What all tests share: patience, files of logs, and the sentence that refuses one."""

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from hypothesis import settings
from xdist.remote import Producer
from xdist.scheduler import LoadFileScheduling

from identification import InputError

# There is a worker on each core. OpenBLAS would have as many threads in each of them, which wait in
# a busy loop: they took a third of all processor time. Programs that tests start read this too.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# A busy machine is not a failure. `make fuzz` tries more than the examples of a test.
settings.register_profile("patient", deadline=None, max_examples=50)
settings.load_profile("patient")


# Files of which one worker runs all, and their laws or searches once, by what they share.
TOGETHER = {
    "worlds": ("tests/worlds/",),
    "worlds of joints": ("tests/worlds_of_joints/",),
    "elbow": ("tests/report/test_horizon_gap.py", "tests/report/test_missing_place.py",
              "tests/report/test_headline.py", "tests/robot/test_second_opinion.py",
              "tests/packaging/test_results_"),
}  # fmt: skip


class ByLaws(LoadFileScheduling):
    """A file's tests run in one worker, and so do files that compile or search for the same."""

    def _split_scope(self, nodeid: str) -> str:
        file = nodeid.partition("::")[0]
        return next((name for name, files in TOGETHER.items() if file.startswith(files)), file)


def pytest_xdist_make_scheduler(config: pytest.Config, log: Producer) -> ByLaws | None:
    return ByLaws(config, log) if config.getoption("dist") == "loadfile" else None


@pytest.fixture(autouse=True)
def _as_found() -> Iterator[None]:
    """Commands that do not draw say so to the process; other tests of it may draw."""
    before = os.environ.get("MUJOCO_GL")
    yield
    if before is None:
        os.environ.pop("MUJOCO_GL", None)
    else:
        os.environ["MUJOCO_GL"] = before


@pytest.fixture
def csv(tmp_path) -> Callable[[str | bytes], Path]:
    """Puts text or bytes into `log.csv`."""

    def put(content: str | bytes) -> Path:
        path = tmp_path / "log.csv"
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    return put


@pytest.fixture
def refusal() -> Callable[..., str]:
    """The one sentence with which a call is refused."""

    def sentence(call: Callable, *args, **kwargs) -> str:
        with pytest.raises(InputError) as caught:
            call(*args, **kwargs)
        text = str(caught.value)
        assert len(text.splitlines()) == 1
        return text

    return sentence


@pytest.fixture(scope="module")
def few_effects() -> Iterator[None]:
    """Robots that are read have two effects: a law of all takes 18 s to compile for new axes."""
    from identification.robot import robot as made

    every, names = made.all_effects, ("coulomb_friction", "quadratic_friction")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            made, "all_effects",
            lambda *given: tuple(e for e in every(*given) if e.name.endswith(names)),
        )  # fmt: skip
        yield


@pytest.fixture
def undrawn(monkeypatch) -> None:
    """Pages have their words and no figures, which take a second each."""
    from identification.report.discovery import report as discovery_report
    from identification.report.page import page, page_files

    monkeypatch.setattr(page, "drawing", lambda *_: "")
    monkeypatch.setattr(page, "save_figures", lambda *_: [])
    monkeypatch.setattr(page_files, "save_figures", lambda *_: [])
    monkeypatch.setattr(discovery_report, "law_sections", lambda *_: [])
