"""A whole search on the logs of a hidden world: minutes of one core each."""

from __future__ import annotations

from typing import Any

from identification.sweep.answers import ANSWER, JUDGED, PROOF, TRUTH, answer, judged, proof
from identification.sweep.discovery_findings import discovery_findings
from identification.sweep.method import Method, Seed
from inca_mj.studies.world_settings import WORLD, WorldSettings, make_world


def world_discovery(settings: WorldSettings, seed: Seed) -> dict[str, Any]:
    """Make a world, and find what the twin lacks to explain it.

    A world stands at rest with what it lacks, as a robot that was let go.

    Raises:
        InputError: the world cannot be made, or the search refuses its logs.
        DivergenceError: a simulation left the finite numbers.
    """
    from inca_mj.workflows.discovery import discover
    from inca_mj.workflows.spread import spread_of

    logs, truth = make_world(settings, seed)
    found = discover(logs, settled=True, spread=spread_of(settings.spread))
    told = answer(found)
    return {
        **truth, **told, **proof(found), **judged(told["named"], truth["hidden"], truth["kind"]),
    }  # fmt: skip


WORLD_DISCOVERY = Method(
    about="makes a hidden world and searches what the twin lacks",
    settings=WorldSettings,
    columns={**WORLD, **TRUTH, **ANSWER, **PROOF, **JUDGED},
    run=world_discovery,
    success="right",
    against="ratio",
    summary=discovery_findings,
)
