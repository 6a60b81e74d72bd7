"""From a checkout to a policy, the types of its channels and what could not be resolved (rules S3, S15, S16).

In: a folder of sources, and a launch file of it. Out: texts to write, and lines for people. Nothing is run.
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.text import counted
from rosprivacy.ingest.scan.checkout import chosen, scanned
from rosprivacy.ingest.scan.outside.outside_labels import outside_labels
from rosprivacy.ingest.scan.scan_facts import BASES, DESCRIBED
from rosprivacy.ingest.scan.scanned_policy import placed, policy_xml, types_yaml
from rosprivacy.report.compare.snapshot import CodeState

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.ingest.scan.checkout import Checkout
    from rosprivacy.ingest.scan.scan_facts import CodePlace, External
    from rosprivacy.ingest.scan.systems import ScannedSystem
    from rosprivacy.report.compare.matching import Key, Record

ARROWS = {(True, True): "<->", (True, False): "<-", (False, True): "->", (False, False): "-"}
LOGS = "/rosout and log files"
DEPENDS_ON = re.compile(r" (?:is|are) not known: |^not known: |: it depends on | depends on ")  # in the text of a gap
LISTED = re.compile(": ")  # in that of a gap about a file or a system: what is wrong with its lines, or many names
SHOWN_AT_MOST = 40  # of the gaps, and of the systems


class Scan(NamedTuple):
    """What was read of a folder, and the system of it that counts."""

    checkout: Checkout
    systems: tuple[ScannedSystem, ...]
    system: ScannedSystem

    @property
    def policy(self) -> bytes:
        """The system as an SROS 2 policy; ``ValueError`` if it has no node."""
        return policy_xml(self.system, self.checkout.folder)

    @property
    def types(self) -> str:
        """The types of its channels, as ``--types`` reads them; empty where none is known."""
        return types_yaml(self.system, self.checkout.folder, self.checkout.definitions)

    @property
    def labels(self) -> str:
        """A label file: what lies outside ROS as files state it, what is logged, and suggestions; may be empty."""
        system = self.system
        logs = ((log.node, log.call) for log in system.logs)
        channels = {end.name: end.kind for end in system.ends}
        return outside_labels(system.externals, logs, self.checkout.stated, channels)


def scan(*folders: str, launch: str = "") -> Scan:
    """Return what the sources in folders, read as one checkout, say of the system that a launch file starts.

    Raises
    ------
    InputErrors
        If they have no such launch file.
    """
    checkout, systems = scanned(*folders, launch=launch)
    return Scan(checkout, systems, chosen(checkout, systems, launch))


def code_state(scans: Iterable[Scan]) -> CodeState:
    """Return the ways out and the gaps of scans, to be compared with those of others.

    A gap is about what is not known: the name of a topic that this node writes with this type. What that depends on is
    told in words of the code, which change when a variable is renamed, and says no more of it. A number at the
    beginning of its text says how often.
    """
    places: dict[Key, list[str]] = defaultdict(list)
    ways: dict[Key, Record] = defaultdict(lambda: {"times": 0})
    gaps: dict[Key, Record] = defaultdict(lambda: {"times": 0, "depends_on": []})
    for scan in scans:
        for key, place in _ways_out(scan):
            ways[key]["times"] += 1
            places[key].append(_line(place, scan))
        for gap in sorted({gap for system in (scan.system, *scan.systems) for gap in system.gaps}):
            about, *depends = (LISTED if gap.sort in ("file", "system") else DEPENDS_ON).split(gap.text, maxsplit=1)
            number, _, rest = about.partition(" ")
            key = (gap.sort, gap.place.file, rest if number.isdecimal() else about)
            gaps[key]["times"] += int(number) if number.isdecimal() else 1
            gaps[key]["depends_on"] += depends
            places[key].append(_line(gap.place, scan))
    return CodeState(dict(ways), dict(gaps), places)


def _ways_out(scan: Scan) -> Iterator[tuple[Key, CodePlace]]:
    """Where data gets out of ROS: what libraries are used for, what files state, and what is logged.

    Of code that is not in the system too, under the name of its class: something else may start it.
    """
    started = {id(node.code) for node in scan.system.nodes}
    others = [code for code in scan.checkout.facts.nodes if id(code) not in started]
    used = [*scan.system.externals, *((code.name, one) for code in others for one in code.externals)]
    for node, one in (*used, *(("", stated) for stated in scan.checkout.stated)):
        for channel in (one.channels or ("",)) if one.outgoing else ():
            yield (one.sort, node, one.name, channel), one.place
    for node, channels, call in scan.system.logs:
        for channel in channels or ("",):
            yield ("log", node, LOGS, channel), call.place
    yield from ((("log", code.name, LOGS, ""), call.place) for code in others for call in code.logs)


def _line(place: CodePlace, scan: Scan) -> str:
    return f"{placed(place.file, scan.checkout.folder)}:{place.line}"


def scan_lines(scan: Scan) -> Iterator[str]:
    """Yield what was found: systems, nodes, ends of channels by how they are known, and gaps, the worst first."""
    checkout, systems, system = scan
    folder = checkout.folder
    channels = {(end.kind, end.name) for end in system.ends}
    counting = [shown(placed(launch, folder)) for launch in (system.launch, *system.besides) if launch]
    verb = "start" if system.besides else "starts"
    of = f"what {' and '.join(counting)} {verb}" if counting else "all nodes of the code"
    described = sum(node.code is not None and node.code.language == DESCRIBED for node in system.nodes)
    yield f"{of}: {counted(len(system.nodes), 'node')}, {counted(len(channels), 'channel')}"
    if described:
        yield f"  of {described} of the nodes only a description is known"
    without_code = sum(node.code is None for node in system.nodes)
    if without_code:
        yield f"  of {without_code} of the nodes the code is not here"
    ways = Counter(end.basis for end in system.ends)
    ends = ", ".join(f"{way} {ways[way]}" for way in BASES if ways[way])
    if ends:
        yield f"  {counted(len(system.ends), 'end')} of channels, by how the name is known: {ends}"
    yield from _outside_lines(scan)
    if len(systems) > 1:
        yield f"{counted(len(systems), 'launch file')} at the top; --launch chooses another:"
        for other in systems[:SHOWN_AT_MOST]:
            mark = "*" if other.launch in (system.launch, *system.besides) else " "
            yield f"  {mark} {shown(placed(other.launch, folder))}: {counted(len(other.nodes), 'node')}"
        if len(systems) > SHOWN_AT_MOST:
            yield f"    and {len(systems) - SHOWN_AT_MOST} more"
    if system.idle and system.launch:
        yield f"{counted(len(system.idle), 'node')} of the code that it does not start"
    if checkout.left_out:
        yield f"left out: {', '.join(shown(placed(name, folder)) for name in checkout.left_out[:SHOWN_AT_MOST])}"
    yield from _gap_lines(scan)


def _outside_lines(scan: Scan) -> Iterator[str]:
    folder = scan.checkout.folder
    if scan.system.externals:
        yield "outside ROS, by what libraries the code uses:"
    for node, one in scan.system.externals:
        yield f"  {shown(node)} {ARROWS[one.incoming, one.outgoing]} {_described(one, folder)}"
    if scan.system.logs:
        yield f"logged: data of channels, at {counted(len(scan.system.logs), 'line')}"
    for node, channels, call in scan.system.logs[:SHOWN_AT_MOST]:
        at = f"{shown(placed(call.place.file, folder))}:{call.place.line}"
        yield f"  {shown(node)}: {shown(call.words)} ({', '.join(map(shown, channels)) or 'recognised'}), {at}"
    if scan.checkout.stated:
        yield "outside ROS, as files state it:"
    yield from (f"  {_described(one, folder)}" for one in scan.checkout.stated)


def _described(external: External, folder: str) -> str:
    at = f"{shown(placed(external.place.file, folder))}:{external.place.line}"
    return f"{shown(external.name)} ({external.sort}), {at}"


def _gap_lines(scan: Scan) -> Iterator[str]:
    gaps, folder = scan.system.gaps, scan.checkout.folder
    if gaps:
        yield f"not resolved: {counted(len(gaps), 'gap')}, first what could hide most"
    for gap in gaps[:SHOWN_AT_MOST]:
        line = f":{gap.place.line}" if gap.place.line else ""
        yield f"  {shown(placed(gap.place.file, folder))}{line}: {gap.sort}: {shown(gap.text)}"
    if len(gaps) > SHOWN_AT_MOST:
        yield f"  and {len(gaps) - SHOWN_AT_MOST} more; the policy that is written (-o) has all"
