"""Text of a page in which no line ends between a number and its unit."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from markupsafe import Markup

_UNIT = r"[nµmkM]?(?:kg|rad|Hz|min|[gNmsAVWJh])(?:\^?-?[\d²³]+)?(?:/(?:\([^)]*\)|[\w²³^]+))?"
_QUANTITY = re.compile(  # a number, its std, and a unit such as N m s/rad
    rf"[-+]?\d[\d.]*(?:e[-+]?\d+)?(?: ± [\d.]+(?:e[-+]?\d+)?)?(?: %|(?: {_UNIT}(?![\w/]))+)"
)


def whole_quantities(text: str) -> Markup:
    """Returns text for a page in which no line ends between a number and its unit.

    Args:
        text: as it is read; it is escaped.
    """
    from markupsafe import Markup, escape

    return Markup(_QUANTITY.sub(r'<span class="whole">\g<0></span>', str(escape(text))))
