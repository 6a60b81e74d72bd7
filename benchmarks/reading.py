"""Reading policies against bare lxml on the same files: every readable policy of the corpus.

Ours parses, follows includes, checks every element against the format and keeps file and line of each grant; the other
side is ``lxml.etree.parse`` and ``.xinclude()``, which hands over a tree and nothing more.
"""

from __future__ import annotations

from functools import partial
from statistics import median
from typing import TYPE_CHECKING

from lxml import etree
from measure import Row, compared, corpus, side_by_side

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.policies.policy_xml import read_policy

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from measure import Measured

AT_ONCE = 20  # readings of all files per round: one takes a few milliseconds only


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured: all policies together, which has the bound, and those with includes and without."""
    policies = corpus()
    with_includes, without = _readable(policies)
    rounds = 5 if quick else 15
    yield Row("reading policies, all", "bare lxml", lambda: _timed(with_includes + without, policies, rounds), bound=10)
    if not quick:
        yield Row("reading policies with XIncludes", "bare lxml", lambda: _timed(with_includes, policies, rounds))
        yield Row("reading policies without", "bare lxml", lambda: _timed(without, policies, rounds))


def _timed(files: list[str], policies: Path, rounds: int) -> Measured:
    expanded = sum(len(etree.tostring(_bare(file))) for file in files)
    read = partial(_read, policies)
    seconds = side_by_side(rounds, lambda: _often(read, files), lambda: _often(_bare, files))
    once = [[second / AT_ONCE for second in side] for side in seconds]
    speed = f"{len(files) / median(once[0]):,.0f} policies/s, {expanded / median(once[0]) / 1e6:.1f} MB/s"
    bare = f"{expanded / median(once[1]) / 1e6:.1f} MB/s"
    return compared(once, f"{len(files)} policies, {expanded / 1e3:,.0f} kB expanded; ours {speed}; bare {bare}")


def _often(read: Callable[[str], object], files: list[str]) -> None:
    for _ in range(AT_ONCE):
        for file in files:
            read(file)  # and let go: to keep all would measure the garbage collector


def _readable(corpus: Path) -> tuple[list[str], list[str]]:
    """The policies of the corpus that both sides can read, with includes and without."""
    found: tuple[list[str], list[str]] = ([], [])
    for path in sorted((corpus / "policies").rglob("*.xml")):
        try:
            _read(corpus, str(path))
            _bare(str(path))
        except (InputErrors, etree.XMLSyntaxError, etree.XIncludeError):
            continue
        found[b"XInclude" not in path.read_bytes()].append(str(path))
    return found


def _read(corpus: Path, file: str) -> object:
    return read_policy(file, include_root=str(corpus))


def _bare(file: str) -> etree._ElementTree:
    tree = etree.parse(file)
    tree.xinclude()
    return tree
