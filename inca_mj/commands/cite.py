"""inca cite: how to cite the program and the thesis."""

from __future__ import annotations

from dataclasses import asdict, dataclass

from identification.commands.common import say, say_json


@dataclass(frozen=True)
class Cite:
    """Say how to cite this program and the thesis that its equations are of.

    Examples:
        inca cite
        inca cite --bibtex
    """

    bibtex: bool = False
    """Print BibTeX entries."""
    json: bool = False
    """Print one JSON object on stdout and nothing else."""

    def run(self) -> int:
        """Print the citation."""
        from inca_mj.report.citation import to_bibtex, to_text, works

        if self.json:
            say_json(
                {"works": [asdict(work) for work in works()], "text": to_text(),
                 "bibtex": to_bibtex()}
            )  # fmt: skip
        else:
            say(to_bibtex() if self.bibtex else to_text())
        return 0
