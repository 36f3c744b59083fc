"""The film of a discovery: the nominal and the corrected robot, on unseen seconds if any."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from contextvars import copy_context
from dataclasses import replace
from pathlib import Path
from shutil import move
from tempfile import TemporaryDirectory
from threading import Event

from identification.discovery.result import Discovery
from identification.logs.joined import rows_of
from identification.logs.log import Log, halves
from identification.report.page.page import Section
from inca_mj.rendering.film import Progress, film
from inca_mj.rendering.graphics import draws_in_any_thread
from inca_mj.rendering.scene import Scene
from inca_mj.twin.logs import pose_of
from inca_mj.twin.twin import Twin
from inca_mj.workflows.discovery_model import named_twin, nominal_twin, rerun

FILMED = 6.0  # [s]; drawing costs several times as long
FPS = 15
LARGER = (
    " In the close view of the handle the outline is drawn farther away than it is: the differences"
    " of both sides are enlarged by the factor that is written there."
)
TITLES = ("before: the model, fitted", "after: with what was missing")


@contextmanager
def film_beside(
    found: Discovery, folder: Path, progress: Progress
) -> Iterator[Callable[[], Section]]:
    """Films a discovery while the block draws other things; yields what waits for the section.

    The block begins with the first frame: what is opened before it, and figures, change settings
    that all threads share. Where OpenGL needs a window, the film is drawn when it is waited for.
    Progress is told as soon as the film is waited for.
    """
    if not draws_in_any_thread():
        yield lambda: film_discovery(found, folder, progress)
        return
    begun, waited, left = Event(), Event(), Event()

    def drawn(done: int, frames: int) -> None:
        begun.set()
        if left.is_set():
            raise KeyboardInterrupt  # as an interrupt of the film itself: nothing is kept of it
        if waited.is_set():
            progress(done, frames)

    with (
        TemporaryDirectory(prefix="film", ignore_cleanup_errors=True) as half,
        ThreadPoolExecutor(1, thread_name_prefix="film") as thread,
    ):
        film_of = thread.submit(copy_context().run, film_discovery, found, Path(half), drawn)
        film_of.add_done_callback(lambda _: begun.set())

        def wait() -> Section:
            waited.set()
            section = film_of.result()
            moved = [Path(move(file, folder)) for file in (section.video, section.poster) if file]
            return replace(section, video=moved[0], poster=moved[1])

        try:
            begun.wait()
            yield wait
        finally:
            left.set()


def film_discovery(found: Discovery, folder: Path, progress: Progress | None = None) -> Section:
    """Writes film.mp4 and film.jpg of a discovery of twins; returns the section that shows them."""
    log = found.records[0].log
    seconds = filmed_seconds(log)
    before = _scene(nominal_twin(found), log, seconds)
    after = _scene(named_twin(found), log, seconds) if found.named else None
    path, picture = folder / "film.mp4", folder / "film.jpg"
    titles = TITLES if after is not None else TITLES[:1]
    film(before, path, beside=after, titles=titles, fps=FPS, picture=picture, progress=progress)
    shown = (log.time >= seconds[0]) & (log.time < seconds[1])
    is_unseen = not (shown & rows_of(log, "estimation")).any()
    return _section(path, picture, seconds, after is not None, is_unseen)


def filmed_seconds(log: Log) -> tuple[float, float]:
    """Returns begin and end [s] of the first seconds that no fit has seen, else of the record."""
    first, last = (log.splits or halves(log)).get("estimation", (log.time[0], log.time[0]))
    begin, end = float(log.time[0]), float(log.time[-1])
    at = last if last < end - 1.0 else begin
    until = first if at == begin and first > begin + 1.0 else end
    return float(at), min(float(at) + FILMED, until)


def _scene(robot: Twin, log: Log, seconds: tuple[float, float]) -> Scene:
    run = rerun(robot, log)
    late = float(run.time[0] - log.time[0])  # a run counts from its own begin
    return Scene(run, log.outputs, pose_of(log)).between(seconds[0] + late, seconds[1] + late)


def _section(
    path: Path, picture: Path, seconds: tuple[float, float], is_beside: bool, is_unseen: bool
) -> Section:
    shown = (
        "the model before (left) and with what was missing (right)" if is_beside else "the model"
    )
    begin, end = seconds
    of = "unseen" if is_unseen else "fitted"
    which = "that no fit has seen" if is_unseen else "of the first record, which was fitted"
    return Section(
        f"The film: {of} seconds {begin:.4g} to {end:.4g}",
        f"It shows {shown}, simulated from the currents alone, over seconds {which}."
        " The handle is orange and the cables have the colour of their tension. The blue outline is"
        " the measured robot: its pose is the one that the measured angles imply for cables that do"
        " not stretch, where the log has no pose. The numbers say how far the handle and the motors"
        f" of the model are from it.{LARGER if is_beside else ''}",
        video=path,
        poster=picture,
        first=2,
    )
