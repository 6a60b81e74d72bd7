"""What code uses of libraries -> what lies outside ROS and with which it exchanges data, each with its line.

In: files of source code with their uses, and the rules of ``ontology/libraries.yaml``. Out: by class or function (of
C++, by class) one ``External`` for each thing. Where an address stands beside a client, the host is its name: never
what else stands in an address, which can hold a user, a password or a key. Nothing says that the code runs: it is
suggested, not stated. A program of ROS that code starts is a gap: what ends of channels it has is not known.
"""

from __future__ import annotations

import ipaddress
import re
from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple
from urllib.parse import urlsplit

from rosprivacy.analysis.model import Place
from rosprivacy.analysis.suggesting.library_rules import ADDRESS, CPP, PROGRAM, NodeUse
from rosprivacy.ingest.code.cpp_code import STARTERS as CPP_STARTERS
from rosprivacy.ingest.code.python_uses import STARTERS
from rosprivacy.ingest.scan.scan_facts import CodePlace, External, Gap

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.suggesting.library_rules import LibraryRules
    from rosprivacy.analysis.suggesting.name_rules import NameRule
    from rosprivacy.ingest.code.source_code import Code, NameUse

SORT_OF = {"network": "cloud", "display": "screen", "file": "file", "loudspeaker": "loudspeaker"}  # by ``where``
OUT, IN, BOTH = (False, True), (True, False), (True, True)
DIRECTIONS = {"screen": OUT, "loudspeaker": OUT, "file": OUT, "process": OUT}  # of the others both
AS_WHOLE = ("web-server", "screen", "loudspeaker")  # several libraries of a class make one of these
SCHEMES = {"http": ("http", "https"), "socket": ("ws", "wss"), "broker": ("mqtt", "mqtts")}
SHARED = ("google", "azure", "gi", "xml", "langgraph")  # first names of libraries of many sorts
PICTURES = ("cv2.imread", "cv::imread", "imageio.imread")  # that are read from files
UNKNOWN_PROGRAM = "another program"
SUBPROCESS = ("run", "call", "Popen", "check_call", "check_output", "getoutput", "getstatusoutput")  # that start one
LOOKS_FOR = "shutil.which"  # and starts nothing
FAILURES = ("Error", "Exception", "Timeout", "Warning", "Disconnect")  # ends of names of what nothing is sent to
HARMLESS = frozenset(["clear", "cls", "echo", "sleep", "kill", "pkill", "killall", "mkdir", "chmod", "cd", "ls"])
ROS, RECORDING = "ros2", "ros2 bag"
LAUNCHES = "launch.actions.ExecuteProcess"  # the reader of launch files knows what a recording of it takes
RUNS_TEXT = re.compile(r"(__import__|importlib\.import_module|exec|eval)(?![^.(])")
RUN_AT_RUN_TIME = "'{name}' runs code that is named as it runs: what it exchanges data with is not known"
STARTS_ROS = "the code starts '{program}': the ends of channels that it makes are not known"


class UnitExternal(NamedTuple):
    """Something outside ROS, with the class or function that uses it; an empty unit is all else in the file."""

    unit: str
    external: External


class CodeExternals(NamedTuple):
    """What code exchanges data with, and programs of ROS that it starts; both sorted by place."""

    units: tuple[UnitExternal, ...]
    gaps: tuple[Gap, ...] = ()


def read_externals(codes: Iterable[Code], rules: LibraryRules, names: Mapping[str, str]) -> CodeExternals:
    """Return what code exchanges data with.

    Parameters
    ----------
    names
        By file, its name in the facts: relative to the root of the checkout. Files without one are left out.
    """
    found: list[UnitExternal] = []
    gaps: set[Gap] = set()
    for code in codes:
        if code.file in names:
            by_unit: dict[str, list[NameUse]] = defaultdict(list)
            for use in code.uses:
                by_unit[use.unit].append(use)
            for unit, uses in by_unit.items():
                things = _Things(names[code.file], code, rules, (uses, by_unit.get("", [])))
                found += (UnitExternal(unit, external) for external in things.things.values())
                gaps |= things.gaps
    return CodeExternals(tuple(sorted(found, key=lambda one: (one.external.place, one))), tuple(sorted(gaps)))


def host_of(address: str) -> str:
    """Return the host of an address, without user, password, path and query; empty where it is open.

    >>> host_of("https://ada:secret@api.example:8443/v1/key?token=1"), host_of("http://{}/upload")
    ('api.example', '')
    >>> host_of("turn:relay.example:3478")
    'relay.example'
    """
    scheme, _, rest = address.partition(":")
    try:
        host = urlsplit(address if rest.startswith("//") else f"{scheme}://{rest}").hostname or ""
    except ValueError:
        return ""
    return host if host and all(sign.isalnum() or sign in ".-_:" for sign in host) else ""


def on_the_internet(host: str) -> bool:
    """Return whether a host has a public name or address.

    >>> on_the_internet("api.example.com"), on_the_internet("localhost"), on_the_internet("192.168.0.7")
    (True, False, False)
    """
    try:
        return ipaddress.ip_address(host).is_global
    except ValueError:
        return "." in host and host.rpartition(".")[2] not in ("local", "lan", "internal", "home", "localdomain")


def library_of(name: str) -> str:
    """Return what a library is called, by the name of a rule.

    >>> library_of("requests.Session.post"), library_of("google.cloud.speech"), library_of("curl_easy_*")
    ('requests', 'google.cloud.speech', 'curl_easy')
    """
    plain = name.partition("(")[0].rstrip("*_:")
    head = plain.partition(".")[0]
    return plain if head in SHARED or "::" in plain else head


class _Things:
    """What one unit of a file exchanges data with: each thing once, at its first line."""

    def __init__(
        self, file: str, code: Code, rules: LibraryRules, nearby: tuple[Sequence[NameUse], Sequence[NameUse]]
    ) -> None:
        self.file, self.code, self.rules = file, code, rules
        self.nearby = nearby  # uses of the unit, and of what stands in none
        self.things: dict[tuple[object, ...], External] = {}
        self.gaps: set[Gap] = set()
        self.spoken_hosts: set[str] = set()  # that a rule says more of than that they are on a network
        uses, _ = nearby
        self.launches = any(use.name == LAUNCHES for use in uses)
        for use in sorted(uses, key=lambda use: not use.name.startswith(ADDRESS)):
            if called := RUNS_TEXT.match(use.name):
                self.gaps.add(Gap(CodePlace(file, use.line), "outside", RUN_AT_RUN_TIME.format(name=called[1])))
            elif use.name.startswith(PROGRAM):
                self._program(use)
            elif not use.name.endswith(FAILURES):
                for rule, matched in self._speaking(use):
                    self._add_use(use, rule, matched)
        self._unknown_programs(uses)

    def _add(self, key: tuple[object, ...], name: str, sort: str, line: int, ways: tuple[bool, bool]) -> None:
        new = External(CodePlace(self.file, line), name, sort, *ways)
        old = self.things.get(key)
        if old:
            first = min(old, new, key=lambda one: one.place)
            new = first._replace(incoming=old.incoming or new.incoming, outgoing=old.outgoing or new.outgoing)
        self.things[key] = new

    def _speaking(self, use: NameUse) -> Iterator[tuple[NameRule, str]]:
        """The rules that speak about a use, and the names by which they do."""
        asked = NodeUse(use.name, self.code.language, Place(self.code.file, use.line))
        for section in (self.rules.lets_out, self.rules.makes):
            rule = self.rules.spoken(section, asked)
            if rule and (rule.sort or rule.where in SORT_OF):
                found = section[self.code.language].of(use.name)
                yield rule, found[0] if found else use.name
        if use.name in PICTURES:
            self._add(("pictures",), library_of(use.name), "file", use.line, IN)

    def _add_use(self, use: NameUse, rule: NameRule, matched: str) -> None:
        """Add what one use is of, by the name of its host where an address beside it has one."""
        sort = rule.sort or SORT_OF[rule.where]
        ways = DIRECTIONS.get(sort, BOTH)
        if sort == "speech":
            ways = IN if rule.to else OUT if rule.where == "loudspeaker" else BOTH
        if use.name.startswith(ADDRESS):
            host = host_of(use.name.removeprefix(ADDRESS))
            self.spoken_hosts.add(host)
            self._add((sort, host or matched), host or matched, sort, use.line, ways)
            return
        hosts = next((some for uses in self.nearby if (some := _hosts(uses, sort))), ())
        for host in hosts:
            if host not in self.spoken_hosts:
                fine = "cloud" if sort == "http" and on_the_internet(host) else sort
                self._add((fine, host), host, fine, use.line, ways)
        if not hosts:
            name = library_of(matched)
            key = (sort,) if sort in AS_WHOLE else (sort, rule.kinds) if sort == "file" else (sort, name)
            self._add(key, name, sort, use.line, ways)

    def _program(self, use: NameUse) -> None:
        name = use.name.removeprefix(PROGRAM)
        first = name.partition(" ")[0]
        of_bags = name.startswith(RECORDING)
        if first == ROS and not (of_bags and self.launches):
            self.gaps.add(Gap(CodePlace(self.file, use.line), "started", STARTS_ROS.format(program=name)))
        if first not in HARMLESS and (first != ROS or of_bags):
            wheres = {rule.where for rule, _ in self._speaking(use)}
            sort = "loudspeaker" if "loudspeaker" in wheres else "process"
            self._add((sort, name), name, sort, use.line, OUT)

    def _unknown_programs(self, uses: Sequence[NameUse]) -> None:
        """Add that a program is started whose name does not stand in the code."""
        lines = {use.line for use in uses if use.name.startswith(PROGRAM)}
        for use in uses:
            if use.line not in lines and _starts(use.name, self.code.language):
                self._add(("process", ""), UNKNOWN_PROGRAM, "process", use.line, OUT)


def _hosts(uses: Iterable[NameUse], sort: str) -> tuple[str, ...]:
    addresses = (use.name.removeprefix(ADDRESS) for use in uses if use.name.startswith(ADDRESS))
    fitting = (one for one in addresses if one.partition("://")[0] in SCHEMES.get(sort, ()))
    return tuple(dict.fromkeys(host for one in fitting if (host := host_of(one))))


def _starts(name: str, language: str) -> bool:
    """Whether a use starts a program: ``subprocess.run``, and not ``subprocess.PIPE``."""
    if language == CPP:
        return name in CPP_STARTERS
    if name.startswith("subprocess."):
        return name.split(".")[1] in SUBPROCESS
    return name.startswith(STARTERS) and name != LOOKS_FOR
