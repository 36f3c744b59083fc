"""Discovery on logs of the robot, with its nominal model, its priors and its catalogue."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from identification import Log
from identification.discovery.options import DiscoveryOptions
from identification.effects.effect import Effect
from identification.logs.joined import join_logs, records_of
from identification.model.parameter import ParameterSet, with_own
from inca_mj.effects.catalogue import CATALOGUE
from inca_mj.refusals.wiring import refuse_miswired
from inca_mj.robot.geometry import INCA, Geometry
from inca_mj.robot.parameters import parameter_set
from inca_mj.robot.spread import with_spread
from inca_mj.twin.logs import POSE
from inca_mj.twin.twin import build_twin
from inca_mj.workflows.calibration import TIMESTEP, nominal_model
from inca_mj.workflows.comparison import timestep_for
from inca_mj.workflows.spread import Spread, spread_of

if TYPE_CHECKING:
    from identification.discovery.result import Discovery
    from identification.storage.written import Files

TOLD = 2.0  # of a record that confirms, the fit sees so much, which tells where it begins [s]


def discover(
    log: Log | Sequence[Log],
    parameters: ParameterSet | None = None,
    geometry: Geometry = INCA,
    *,
    confirm: Sequence[Log] = (),
    spread: Spread | None = None,
    effects: Sequence[Effect] = CATALOGUE,
    progress: Callable[[str], None] | None = None,
    timestep: float = TIMESTEP,
    settled: bool = False,
    options: DiscoveryOptions | None = None,
    trust: Sequence[str] = (),
) -> Discovery:
    """Name the physical effect that the twin lacks to explain logs, and prove it.

    What is found shows the first sentence of its verdict; `identification.discovery_text` tells all
    of it. Read `found.verdict` first ("named", "unknown effect" or "nothing missing"), then
    `found.unexplained`: whether something is left that no named effect explains.
    `found.report(path)` writes the report, `found.save(folder)` all that `inca discover` keeps but
    for the film (`film` draws one), and `found.to_dict()` returns the numbers.

    Examples:
        from identification import discovery_text
        from inca_mj import discover, named_twin, read_inca_log

        found = discover(read_inca_log("examples/log.csv"), progress=print)
        print(found.verdict, found.unexplained)
        for named in found.named:
            print(named.name, named.where, named.confidence, named.parameters)
            print([(rival.name, rival.where, rival.confidence) for rival in named.rivals])
        print(discovery_text(found))
        found.report("report.html")
        robot = named_twin(found)

    Args:
        log: what was measured, one record or several. Where nothing confirms, the part `estimation`
            (or first half) of each is fitted, and the rest is unseen data for the proof.
        confirm: records for the proof, of which a fit sees the first two seconds only, which tell
            where they begin; `log` is then fitted whole.
        spread: how much the drives and points of one robot usually differ (`spread_of`): each has
            then values of its own, held by what is usual (the default, None) or by a table.
            `spread_of("none")` takes all drives for alike.
        parameters: nominal values; the thesis' Table 3.2 when None.
        geometry: anchors of the cables.
        effects: candidates; the whole catalogue by default.
        progress: is told a line per stage.
        timestep: largest step of the integrator [s].
        settled: True if the robot stood by itself for a while before the log began, so that it
            starts at rest with the effects that the twin lacks; False if it was held where the
            nominal model rests.
        options: the judgement constants; the defaults of `DiscoveryOptions` when None.
        trust: checks of the log that you overrule, words of `inca_mj.twin.logs.JUDGED`.

    Raises:
        InputError: a log is too short, is not wired as the robot is, two logs are no records of
            one robot, or a start has no pretension.
        DivergenceError: the nominal model cannot be simulated.
    """
    logs = [log] if isinstance(log, Log) else [*log]
    every = join_logs([*map(_whole, logs), *map(_begun, confirm)] if confirm else logs)
    step = timestep_for(every.sampling_time, timestep)
    plain = build_twin(parameters, geometry, timestep=step, visual=False)
    for one in (*logs, *confirm):
        refuse_miswired(one, plain, trust)

    # These imports are slow, so they come after the checks that may refuse the log.
    from identification.innovations.discovery import discover as search
    from identification.innovations.discovery import refuse_unfit
    from identification.report.discovery import verdict as discovery_verdict  # noqa: F401  how the result is shown
    from inca_mj.workflows.discovery_model import told

    options, spread = options or DiscoveryOptions(), spread or spread_of("usual")
    refuse_unfit(every, options)
    if progress is not None:
        progress(f"preparing the law of the cables with {len(effects)} effects")
    records = len(records_of(every))
    known = parameters or parameter_set()
    known = with_own(with_spread(known) if spread.groups else known, POSE, records)
    plant = build_twin(
        known, geometry, timestep=step, effects=effects, settled=settled, visual=False
    )
    found = search(nominal_model(plant, spread, records), every, effects, progress, options)
    return replace(told(found), files_of=files_of)


def files_of(found: Discovery) -> Files:
    """Returns what writes the files of a discovery on the robot."""
    from inca_mj.workflows.discovery_files import TwinDiscoveryFiles  # slow to import

    return TwinDiscoveryFiles(found)


def _whole(log: Log) -> Log:
    """Returns a record of which every sample is fitted."""
    end = float(log.time[-1]) + log.sampling_time
    return replace(log, splits={"estimation": (float(log.time[0]), end)})


def _begun(log: Log) -> Log:
    """Returns a record of which only the beginning is fitted."""
    first, last = float(log.time[0]), float(log.time[-1]) + log.sampling_time
    seen = min(first + TOLD, (first + last) / 2)
    return replace(log, splits={"estimation": (first, seen), "validation": (seen, last)})
