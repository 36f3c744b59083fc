"""Methods of sweeps on the INCA robot, by their names in a sweep's TOML."""

from identification.sweep.log_methods import METHODS as OF_ANY_ROBOT

METHODS = {
    **OF_ANY_ROBOT,
    "null-score": "inca_mj.studies.null_score:NULL_SCORE",
    "world-score": "inca_mj.studies.scores:WORLD_SCORE",
    "world-discovery": "inca_mj.studies.searches:WORLD_DISCOVERY",
    "practice-discovery": "inca_mj.studies.searches:PRACTICE_DISCOVERY",
    "trial": "inca_mj.studies.parameters:TRIAL",
    "excitation": "inca_mj.studies.parameters:EXCITATION",
}
