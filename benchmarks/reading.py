"""Reading policies against bare lxml on the same files: every readable policy of the corpus.

Ours parses, follows includes, checks every element against the format and keeps file and line of each grant; the other
side is ``lxml.etree.parse`` and ``.xinclude()``, which hands over a tree and nothing more.
"""

from __future__ import annotations

from statistics import median
from typing import TYPE_CHECKING

from lxml import etree
from measure import compared, side_by_side

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.policies.policy_xml import read_policy

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from measure import Line

AT_ONCE = 20  # readings of all files per round: one takes a few milliseconds only


def compare(corpus: Path, *, quick: bool) -> Iterator[Line]:
    """Time both sides: all policies together, which has the bound, and those with includes and without."""
    with_includes, without = _readable(corpus)
    sets = ((with_includes + without, "all"), (with_includes, "those with XIncludes"), (without, "those without"))
    for files, what in sets:
        expanded = sum(len(etree.tostring(_bare(file))) for file in files)
        seconds = side_by_side(
            5 if quick else 15,
            lambda: [_read(file, corpus) for _ in range(AT_ONCE) for file in files],  # noqa: B023 - called within the round
            lambda: [_bare(file) for _ in range(AT_ONCE) for file in files],  # noqa: B023 - as above
        )
        once = [[second / AT_ONCE for second in side] for side in seconds]
        speed = f"{len(files) / median(once[0]):,.0f} policies/s, {expanded / median(once[0]) / 1e6:.1f} MB/s"
        bare = f"{expanded / median(once[1]) / 1e6:.1f} MB/s"
        note = f"{len(files)} policies, {expanded / 1e3:,.0f} kB expanded; ours {speed}; bare {bare}"
        bound = 8 if what == "all" else None
        yield compared(f"(c) reading policies, {what} / bare lxml", once, bound=bound, note=note)


def _readable(corpus: Path) -> tuple[list[str], list[str]]:
    """The policies of the corpus that both sides can read, with includes and without."""
    found: tuple[list[str], list[str]] = ([], [])
    for path in sorted((corpus / "policies").rglob("*.xml")):
        try:
            _read(str(path), corpus)
            _bare(str(path))
        except (InputErrors, etree.XMLSyntaxError, etree.XIncludeError):
            continue
        found[b"XInclude" not in path.read_bytes()].append(str(path))
    return found


def _read(file: str, corpus: Path) -> object:
    return read_policy(file, include_root=str(corpus))


def _bare(file: str) -> etree._ElementTree:
    tree = etree.parse(file)
    tree.xinclude()
    return tree
