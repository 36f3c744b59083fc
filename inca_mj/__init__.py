"""The digital twin of the INCA 6D: eight elastic cables, eight motors with drums, a handle.

The public names; each is imported when it is first asked for, so that `inca --help` is quick.
"""

from identification.lazy import lazy

_PUBLIC = {
    "Comparison": "comparison",
    "Geometry": "geometry",
    "INCA": "geometry",
    "Run": "run",
    "Twin": "twin",
    "build_twin": "twin",
    "compare": "comparison",
    "load_run": "run",
    "load_twin": "effects.saved",
    "make_input": "inputs",
    "parameter_set": "parameters",
    "read_geometry": "geometry",
    "read_inca_log": "logs",
    "run_to_log": "logs",
    "save_run": "run",
    "save_twin": "effects.saved",
    "simulate": "run",
}
__all__ = list(_PUBLIC)
__getattr__, __dir__ = lazy(__name__, _PUBLIC)
