"""The digital twin of the INCA 6D: eight elastic cables, eight motors with drums, a handle.

The public names; each is imported when it is first asked for, so that `inca --help` is quick.
"""

from identification.lazy import lazy

_PUBLIC = {
    "Comparison": "workflows.comparison",
    "Geometry": "robot.geometry",
    "INCA": "robot.geometry",
    "Run": "twin.run",
    "Twin": "twin.twin",
    "build_twin": "twin.twin",
    "compare": "workflows.comparison",
    "load_run": "twin.run",
    "load_twin": "twin.saved",
    "make_input": "robot.inputs",
    "parameter_set": "robot.parameters",
    "read_geometry": "robot.geometry",
    "read_inca_log": "twin.logs",
    "run_to_log": "twin.logs",
    "save_run": "twin.run",
    "save_twin": "twin.saved",
    "simulate": "twin.run",
}
__all__ = list(_PUBLIC)
__getattr__, __dir__ = lazy(__name__, _PUBLIC)
