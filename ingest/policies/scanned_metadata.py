"""What a policy's ``<metadata>`` says of a scan: the line of code behind each grant, what was not resolved (rule S16).

In: the ``<profiles>`` of a policy that ``rosprivacy scan`` wrote. Out: lines of code by grant, and what a reader has to
know. sros2 passes over metadata. A scan is never whole, so its verdict is undetermined at best. What looks like ours
and cannot be read is a gap, too; so are gaps that were taken out.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import SCAN_GAP, SCANNED, Diagnostic, Place, Severity, unresolved
from rosprivacy.ingest.policies.observed_metadata import attribute, grant_key, ours_in

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from lxml import etree

    from rosprivacy.ingest.policies.observed_metadata import Key

TAG, GRANT, GAP = "scanned", "grant", "gap"
VERSION = "1"
_LINE = re.compile(r"(.+):([0-9]{1,9})", re.DOTALL)
_WORD = re.compile(r"[a-z][a-z-]{0,30}", re.ASCII)
CodeLine = tuple[Place, str]  # a line of code, and how it fixes the name
ALWAYS = "source code does not say all that runs: what it does by other means, and code that was not read"


class ScanGap(NamedTuple):
    """What a scan could not resolve, at a line of the code."""

    place: Place
    sort: str
    text: str


class ScannedMetadata(NamedTuple):
    """What a scan says of itself beside an enclave.

    Attributes
    ----------
    launch
        The launch file whose nodes these are; empty where there is none.
    gaps
        Those that stand here.
    number
        Of the gaps of the whole scan.
    """

    launch: str
    gaps: tuple[ScanGap, ...]
    number: int


def diagnostics_of(scans: Sequence[ScannedMetadata], place: Place) -> Iterator[Diagnostic]:
    """Return what a reader has to know of a policy that was made of source code, by what its enclaves say."""
    gaps = tuple(dict.fromkeys(gap for scan in scans for gap in scan.gaps))
    launch = next((scan.launch for scan in scans if scan.launch), "")
    yield from scan_diagnostics(launch, gaps, place)
    lost = max(scan.number for scan in scans) - len(gaps)
    if lost > 0:
        message = f"gaps of the scan that stand here no more: {lost:,}; scan again"
        yield Diagnostic(place, Severity.WARNING, message, SCAN_GAP)


def scan_diagnostics(launch: str, gaps: Iterable[ScanGap], place: Place) -> Iterator[Diagnostic]:
    """Return that a policy is made of source code, each gap at its line, and that a scan is never whole."""
    of = f"what {shown(launch)} starts" if launch else "all nodes of the code"
    message = f"made of source code, not of what runs: {of}; enclaves are made up, one per node"
    yield Diagnostic(place, Severity.NOTICE, message, SCANNED)
    for gap in gaps:
        yield Diagnostic(gap.place, Severity.WARNING, unresolved(gap.sort, shown(gap.text)), SCAN_GAP)
    yield Diagnostic(place, Severity.WARNING, f"{ALWAYS}; the verdict is undetermined at best", SCAN_GAP)


def unreadable(why: str, place: Place) -> Diagnostic:
    """Return what is to be said of metadata that look like ours and cannot be read."""
    message = f"what a scan says here cannot be read: {why}; scan again, or remove it"
    return Diagnostic(place, Severity.WARNING, message, SCAN_GAP)


def scanned_in(metadata: etree._Element) -> etree._Element | None:
    """Return what a scan says in a ``<metadata>``, if there is such a thing."""
    return ours_in(metadata, TAG)


def scan_of(element: etree._Element) -> ScannedMetadata:
    """Return what a scan says of itself.

    Raises
    ------
    ValueError
        If it cannot be read.
    """
    if element.get("version") != VERSION:
        raise ValueError(f"version {shown(repr(element.get('version')))} of a scan is not known")
    number = element.get("gaps", "")
    if not re.fullmatch(r"[0-9]{1,9}", number, re.ASCII):
        raise ValueError(f"gaps={shown(repr(number))} is no number")
    gaps = (
        ScanGap(_place(child), _word(child, "sort"), attribute(child, "text")) for child in element if child.tag == GAP
    )
    return ScannedMetadata(element.get("launch", ""), tuple(gaps), int(number))


def code_of(element: etree._Element) -> Mapping[Key, tuple[CodeLine, ...]]:
    """Return the lines of code behind each grant of an enclave.

    Raises
    ------
    ValueError
        If it cannot be read.
    """
    lines: dict[Key, tuple[CodeLine, ...]] = {}
    for grant in element:
        if grant.tag == GRANT:
            key = grant_key(grant)
            lines[key] = (*lines.get(key, ()), (_place(grant), _word(grant, "basis")))
    return lines


def _place(element: etree._Element) -> Place:
    match = _LINE.fullmatch(attribute(element, "at"))
    if match is None:
        raise ValueError(f"at={shown(repr(element.get('at')))} is no line such as src/camera.py:34")
    return Place(match[1], int(match[2]))


def _word(element: etree._Element, name: str) -> str:
    value = attribute(element, name)
    if not _WORD.fullmatch(value):
        raise ValueError(f"{name}={shown(repr(value))} is no word of a scan")
    return value
