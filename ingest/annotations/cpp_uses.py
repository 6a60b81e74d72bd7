"""What C++ code uses: qualified names, types and functions, as far as the file itself says what a name stands for.

``using cv::VideoCapture``, ``namespace c = cv`` and ``using namespace cv`` are followed. Where several namespaces are
used, a plain name may be of each: it is noted for each, and no rule speaks about the wrong ones.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.ingest.annotations.source_code import LONGEST_USE, Use
from rosprivacy.ingest.annotations.started import program

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.ingest.annotations.cpp_types import TypeNames

STARTERS = ("system", "std::system", "popen", "execl", "execlp")
OPENERS = ("fopen", "std::fopen")
WRITING = frozenset("wa+")


class CppUses:
    """Collects the uses of one file.

    Parameters
    ----------
    types
        What names stand for; complete when ``uses`` is asked.

    Attributes
    ----------
    namespaces
        Of ``using namespace``.
    """

    def __init__(self, types: TypeNames) -> None:
        self.types = types
        self.namespaces: list[str] = []
        self._found: dict[tuple[str, str], int] = {}

    def add(self, name: str, line: int, unit: str) -> None:
        """Note a name."""
        self._found.setdefault((unit, name), line)

    def add_call(self, name: str, texts: Sequence[str | None], line: int, unit: str) -> None:
        """Note a call of a function.

        Parameters
        ----------
        texts
            Its arguments, those that are literal texts.
        """
        self.add(name, line, unit)
        if name in OPENERS and len(texts) > 1 and WRITING & set(texts[1] or ""):
            self.add(f"{name}(w)", line, unit)
        if name in STARTERS and texts and texts[0] and (started := program(texts[0].split())):
            self.add(started, line, unit)

    def uses(self) -> tuple[Use, ...]:
        """Return what is used, each name once in a unit, by line.

        >>> from rosprivacy.ingest.annotations.cpp_types import TypeNames
        >>> used = CppUses(TypeNames())
        >>> used.namespaces.append("cv")
        >>> used.add("VideoCapture", 3, "Camera")
        >>> [use.name for use in used.uses()]
        ['VideoCapture', 'cv::VideoCapture']
        """
        found: dict[tuple[str, str], int] = {}
        for (unit, name), line in self._found.items():
            for meant in self._meant(name):
                found[unit, meant] = min(line, found.get((unit, meant), line))
        made = (Use(name, line, unit) for (unit, name), line in found.items())
        made = (use for use in made if len(use.name) <= LONGEST_USE)
        return tuple(sorted(made, key=lambda use: (use.line, use.name)))

    def _meant(self, name: str) -> list[str]:
        known = self.types.meaning(name)
        plain = known == name and "::" not in name and name.isidentifier()
        return [known, *(f"{space}::{name}" for space in dict.fromkeys(self.namespaces) if plain)]
