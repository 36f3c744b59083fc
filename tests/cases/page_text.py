"""The text of a report without the marks that keep a number and its unit on one line."""

import re


def text_of(page: str) -> str:
    return re.sub(r'<span class="whole">(.*?)</span>', r"\1", page)
