"""Fleet files -> ``Fleet``: which robots there are, what they run, what they share (rules S1, S9).

In: YAML or JSON, with the fleet files that it includes. Out: robots with their policies and label files, and the
elements outside ROS that belong to none of them, with the flows between all these. All problems are raised at once.
"""

from __future__ import annotations

import hashlib
import os
import re
from dataclasses import dataclass, replace
from glob import glob, has_magic
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import FleetError, InputError, InputErrors, shown
from rosprivacy.analysis.model import NO_ROBOT, UNSTATED, Diagnostic, Severity, Surroundings
from rosprivacy.analysis.text import counted
from rosprivacy.analysis.written_names import listed
from rosprivacy.ingest.fleet.fleet_reader import (
    GROUP_KEYS,
    ID,
    ID_HINT,
    ROBOT_KEYS,
    SECTIONS,
    SPEC,
    Spec,
    file_of,
    read_spec,
    text_of,
)
from rosprivacy.ingest.labels.entries import OWN
from rosprivacy.ingest.labels.label_file import OURS
from rosprivacy.ingest.labels.label_reader import LabelReader
from rosprivacy.ingest.labels.stated_facts import OF_SYSTEM, SURROUNDINGS, joined, two_of_one, united
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.bounded_file import WIDEN, leaves, what_leaves
from rosprivacy.ingest.reading.path_kinds import exists, is_file

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.model import Place, Processing
    from rosprivacy.ingest.labels.entries import Entry, FlowEntry, Limit, Stated
    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ontology.vocabulary import Vocabulary

STAR = "*"  # in a group: the robot's id
SHARED = "shared"


@dataclass(frozen=True, slots=True)
class Robot:
    """A robot, or a part of the infrastructure that has policies as robots have.

    Attributes
    ----------
    model
        Name; empty without one.
    policies
        Files, folders and globs.
    labels, own
        Label files of its model and of itself; the latter outrank the former.
    domain
        Name of the DDS domain that it shares with others; empty for one of its own (rule S1).
    strip, add
        Namespace that its policies have and names are shown without, or lack and run under; empty for none.
    surroundings
        Where it works, as the file states it of the fleet, of its model and of itself.
    types
        Files of observed message types, of its model and of itself: a channel has those of all (rule S15).
    """

    id: str
    place: Place
    model: str = ""
    policies: tuple[str, ...] = ()
    labels: tuple[str, ...] = ()
    own: tuple[str, ...] = ()
    domain: str = ""
    strip: str = ""
    add: str = ""
    surroundings: Surroundings = Surroundings()  # noqa: RUF009 - it is frozen
    types: tuple[str, ...] = ()

    @property
    def files(self) -> tuple[str, ...]:
        """All that it is read from; robots that are alike have files in the same order."""
        return (*self.policies, *self.labels, *self.own, *self.types)


@dataclass(frozen=True, slots=True)
class Fleet:
    """What a fleet file says, with its includes.

    Attributes
    ----------
    name
        What is shared is filed under it.
    sources
        (file, SHA-256), sorted.
    robots, infrastructure
        By id, sorted.
    elements, entries, limits, flows
        As in ``Labels``; the ends of flows name robots too (``ROBOTS:/name``).
    processing
        Who is responsible for all robots, what for, on which basis; a label file of a robot may say another.
    root
        The folder that the files which it names do not leave.
    bounds
        With which it was read, for what its robots make together.
    surroundings
        Where it works as a whole: what is shared works there.
    diagnostics
        What a reader has to know of the file.
    """

    name: str
    sources: tuple[tuple[str, str], ...]
    robots: tuple[Robot, ...]
    infrastructure: tuple[Robot, ...]
    elements: tuple[Stated, ...]
    entries: tuple[Entry, ...]
    limits: tuple[Limit, ...]
    flows: tuple[FlowEntry, ...]
    root: str
    bounds: Bounds = BOUNDS
    surroundings: Surroundings = Surroundings()  # noqa: RUF009 - it is frozen
    processing: Processing = UNSTATED
    diagnostics: tuple[Diagnostic, ...] = ()


def read_fleet(
    file: str, vocabulary: Vocabulary, *, include_root: str | Path | None = None, bounds: Bounds = BOUNDS
) -> Fleet:
    """Read a fleet file.

    Parameters
    ----------
    include_root
        Folder that the files which it names may not leave, links followed; by default its own.

    Raises
    ------
    InputErrors
        With every problem of it and of the files that it includes, each a ``FleetError`` of one line.

    Notes
    -----
    Linear in the number of robots.
    """
    root = os.path.realpath(include_root or os.path.dirname(file) or os.curdir)  # noqa: PTH120
    reader = _Fleet(vocabulary, root, bounds)
    reader.read(file, ())
    fleet = reader.fleet(file)
    if reader.problems:
        raise InputErrors(reader.problems)
    return fleet


class _Fleet:
    """Gathers what fleet files say, and puts robots together at the end."""

    def __init__(self, vocabulary: Vocabulary, root: str, bounds: Bounds) -> None:
        self.problems: list[InputError] = []
        self._bounds = bounds
        self._count = 0  # of robots
        self._root = root
        self._vocabulary = vocabulary
        self._name = ""
        self._sources: dict[str, str] = {}
        self._read: set[str] = set()
        self._models: dict[str, Spec] = {}
        self._robots: dict[str, Robot] = {}
        self._infrastructure: dict[str, Robot] = {}
        self._drafts: list[tuple[str, Spec, bool]] = []  # id, what is said, whether it is infrastructure
        self._groups: list[tuple[LabelReader, Spec, Value]] = []
        self._parts: list[LabelReader] = []
        self._diagnostics: list[Diagnostic] = []
        self._domains: dict[str, tuple[str, Place]] = {}  # as they are compared -> as one is written first, and where

    def read(self, file: str, within: tuple[str, ...]) -> None:
        """Read one file with all that it includes; ``within`` are the files that are being read."""
        path = os.path.realpath(file)
        if path in self._read:
            return
        self._read.add(path)

        def fail(line: int, problem: str, hint: str) -> InputError:
            return FleetError(file, line, problem, "write at least 'fleet: 1'" if "empty" in problem else hint)

        try:
            top, data = yaml_values.read(file, fail, self._bounds)
        except InputError as error:
            self.problems.append(error)
            return
        self._sources[file] = hashlib.sha256(data).hexdigest()
        part = LabelReader(
            file,
            self._vocabulary,
            "",
            OWN,
            error=FleetError,
            problems=self.problems,
            bounds=self._bounds,
            of_fleet=True,
        )
        self._parts.append(part)
        part.version(top, "fleet", "fleet")
        part.system(top)
        for key, line, value in part.entries_of(top, ("fleet", *OF_SYSTEM, *SECTIONS)) if top.kind == "map" else ():
            self._section(part, key, line, value, (*within, path))

    def _section(self, part: LabelReader, key: str, line: int, value: Value, within: tuple[str, ...]) -> None:
        if key == "name":
            self._name = text_of(part, value, "the name of a fleet")
        elif key == "include":
            for item in value.items if value.kind == "list" else (value,):
                self._include(part, item, within)
        elif key in SURROUNDINGS:
            part.surroundings = part.surrounded(part.surroundings, key, value)
        elif key in ("elements", "limits", "flows"):
            part.outside(key, line, value)
        elif key == "groups":
            for item in value.items:
                self._groups.append((part, read_spec(part, "a group", item.line, item, GROUP_KEYS), item))
            if value.kind not in ("list", "empty"):
                part.problem(line, f"groups is a list, not a {value.kind}", "write [{robots: 10, model: …}]")
        elif key in ("models", "robots", "infrastructure"):
            if value.kind not in ("map", "empty"):
                part.problem(line, f"{key} is a map, not a {value.kind}", "write 'name: {policies: […]}'")
            for name, at, said in value.entries:
                self._entry(
                    part, key, name, at, read_spec(part, shown(name), at, said, SPEC if key == "models" else ROBOT_KEYS)
                )

    def _entry(self, part: LabelReader, section: str, name: str, line: int, spec: Spec) -> None:
        if not ID.fullmatch(name):
            part.problem(line, f"{shown(name)!r} cannot name a robot or model", ID_HINT)
        elif section != "models":
            self._drafts.append((name, spec, section == "infrastructure"))
        elif name in self._models:
            part.problem(line, f"model {shown(name)!r} again, first at {self._models[name].place}", "define it once")
        else:
            self._models[name] = spec

    def _include(self, part: LabelReader, item: Value, within: tuple[str, ...]) -> None:
        file = file_of(part, item, "include")
        if not file:
            return
        if leaves(file, self._root):
            part.problem(item.line, what_leaves(file, self._root), WIDEN)
        elif os.path.realpath(file) in within:
            part.problem(item.line, f"{shown(item.text)} includes itself, on a ring", "remove one of the includes")
        elif not is_file(file):
            part.problem(item.line, f"{shown(item.text)}: file not found", "correct the path")
        else:
            self.read(file, within)

    def fleet(self, file: str) -> Fleet:
        """Put everything together."""
        drafts = self._drafts
        for name, spec, shared in drafts if drafts and self._bounded(len(drafts), drafts[-1][1].place) else ():
            self._add(name, spec, shared=shared)
        for part, spec, item in self._groups:
            for name, one in self._members(part, spec, item):
                self._add(name, one, shared=False)
        if not self._robots and not self.problems:
            self.problems.append(FleetError(file, 1, "a fleet without robots", "name some under robots or groups"))
        name = self._name or SHARED
        taken = self._robots.get(name) or self._infrastructure.get(name)
        if taken:
            self._problem(taken.place, f"robot {shown(name)!r} has the name of what is shared", "rename one")
        robots = tuple(robot for _, robot in sorted(self._robots.items()))
        self._check_files([*robots, *self._infrastructure.values()])
        return Fleet(
            name,
            tuple(sorted(self._sources.items())),
            robots,
            tuple(robot for _, robot in sorted(self._infrastructure.items())),
            tuple(stated for part in self._parts for stated in part.elements),
            tuple(entry for part in self._parts for entry in part.entries),
            tuple(limit for part in self._parts for limit in part.limits),
            tuple(flow for part in self._parts for flow in part.flows),
            self._root,
            self._bounds,
            self._everywhere(),
            united((((0, 0), part.processing) for part in self._parts), self._differ),
            tuple(self._diagnostics),
        )

    def _everywhere(self) -> Surroundings:
        """Where the whole fleet works; what an including file says counts before what it includes."""
        return joined(part.surroundings for part in reversed(self._parts))

    def _differ(self, fact: str, first: Processing, other: Processing) -> None:
        self.problems.append(two_of_one(fact, first, other, FleetError))

    def _add(self, name: str, spec: Spec, *, shared: bool) -> None:
        known = self._robots.get(name) or self._infrastructure.get(name)
        if known:
            self._problem(spec.place, f"robot {shown(name)!r} again, first at {known.place}", "rename one")
            return
        model = self._models.get(spec.model, Spec(spec.place))
        if spec.model and spec.model not in self._models:
            known_models = ", ".join(sorted(self._models)) or "there is none"
            self._problem(self._line(spec, "model"), f"unknown model {shown(spec.model)!r}", f"models: {known_models}")
            return
        if not (model.policies or spec.policies):
            self._problem(spec.place, f"robot {shown(name)!r} has no policies", "name some, or a model that has some")
            return
        domain = spec.domain or model.domain
        if domain:
            self._one_spelling(domain, self._line(spec if spec.domain else model, "domain"))
        own = bool(spec.strip or spec.add)
        namespace = (spec.strip, spec.add) if own else (model.strip, model.add)
        strip, add = (text.replace(STAR, name) for text in namespace)
        robot = Robot(
            name,
            spec.place,
            spec.model,
            (*model.policies, *spec.policies),
            model.labels,
            spec.labels,
            domain,
            strip,
            add,
            joined((self._everywhere(), model.surroundings, spec.surroundings)),
            tuple(dict.fromkeys((*model.types, *spec.types))),
        )
        (self._infrastructure if shared else self._robots)[name] = robot

    def _one_spelling(self, domain: str, place: Place) -> None:
        """Refuse a domain that looks like another: ``Lab`` and ``lab``, ``01`` and ``1`` would join nothing (S1)."""
        alike = str(int(domain)) if domain.isdecimal() else domain.lower()
        first, where = self._domains.setdefault(alike, (domain, place))
        if first != domain:
            what = f"domain {domain!r} is another one than {first!r} (at {where}), and looks like it"
            self._problem(place, what, "write it in one way, or give them names that differ by more")

    def _members(self, part: LabelReader, spec: Spec, item: Value) -> Iterator[tuple[str, Spec]]:
        """The robots of a group: so many, or one for each file that a glob matches."""
        count, pattern = item.get("robots"), [file for file in spec.policies if STAR in file]
        if (count is None) != bool(pattern):
            what = "a group takes either a number of robots or policies with a *"
            part.problem(item.line, what, "write {robots: 10, model: …} or {policies: robots/*.policy.xml}")
        elif count is None:
            yield from self._matched(part, spec, pattern[0])
        elif count.kind != "number" or not re.fullmatch(r"[0-9]{1,18}", count.text) or not int(count.text):
            part.problem(count.line, f"robots: {shown(count.text or count.kind)!r}", "write a whole number above 0")
        elif self._bounded(int(count.text), spec.place._replace(line=count.line)):
            yield from self._counted(part, spec, item, int(count.text))

    def _bounded(self, count: int, place: Place) -> bool:
        """Whether there may be so many more robots; counted before one of them is made."""
        self._count += count
        if self._count > self._bounds.robots:
            self._problem(place, *self._bounds.refusal("robots", self._count))
        return self._count <= self._bounds.robots

    def _counted(self, part: LabelReader, spec: Spec, item: Value, count: int) -> Iterator[tuple[str, Spec]]:
        said = item.get("id")
        pattern = said.text if said else f"{spec.model}_{STAR}"
        if pattern.count(STAR) != 1 or not ID.fullmatch(pattern.replace(STAR, "0")):
            hint = "write one with a * for the number, such as carrier_*"
            part.problem(said.line if said else item.line, f"{shown(pattern)!r} cannot be the ids of a group", hint)
            return
        width = len(str(count))
        for number in range(1, count + 1):
            name = pattern.replace(STAR, f"{number:0{width}}")
            yield name, _of_robot(spec, name)

    def _matched(self, part: LabelReader, spec: Spec, pattern: str) -> Iterator[tuple[str, Spec]]:
        line = self._line(spec, "policies")
        if pattern.count(STAR) != 1 or has_magic(pattern.replace(STAR, "")):
            part.problem(line.line, f"{shown(pattern)!r} has more than one *", "write one *, for the robot's id")
            return
        before, after = pattern.split(STAR)
        if leaves(pattern, self._root):
            part.problem(line.line, what_leaves(pattern, self._root), WIDEN)
            return
        files = sorted(glob(pattern))  # noqa: PTH207 - absolute patterns too
        self._passed_over(before, after, line)
        if not files:
            part.problem(line.line, f"{shown(pattern)!r} matches no file", "correct the pattern")
        for file in files if self._bounded(len(files), line) else ():
            name = file[len(before) : len(file) - len(after)]
            if ID.fullmatch(name):
                yield name, _of_robot(spec, name)
            else:
                part.problem(line.line, f"{shown(file)!r}: {shown(name)!r} cannot name a robot", ID_HINT)

    def _passed_over(self, before: str, after: str, place: Place) -> None:
        """Tell of folders that look like those of robots and lack the policy: ``b`` with ``policy.XML`` is no robot."""
        within, slash, policy = after.partition("/")
        folders = sorted(glob(f"{before}{STAR}{within}/")) if slash else []  # noqa: PTH207 - absolute patterns too
        lacking = [folder for folder in folders if not exists(Path(folder, policy))]
        if lacking:
            which = f"{counted(len(lacking), 'folder')} that {shown(f'{before}{STAR}{within}')} matches"
            what = f"no {shown(policy)} in {which}, so no robot: {listed([one.removesuffix('/') for one in lacking])}"
            self._diagnostics.append(Diagnostic(place, Severity.WARNING, what, NO_ROBOT))

    def _check_files(self, robots: Iterable[Robot]) -> None:
        """Files that are named and are not there, at the line that names them first."""
        seen: set[str] = set()
        for robot in robots:
            labels = (*robot.labels, *robot.own)
            for key, files in (("policies", robot.policies), ("labels", labels), ("types", robot.types)):
                for file in [file for file in files if file not in seen]:
                    seen.add(file)
                    if key != "types" and file.startswith(OURS):
                        continue
                    if leaves(file, self._root):
                        self._problem(self._place_of(key, file, robot), what_leaves(file, self._root), WIDEN)
                    elif not (exists(file) or (key == "policies" and has_magic(file))):
                        self._problem(self._place_of(key, file, robot), f"{shown(file)}: file not found", "correct it")

    def _place_of(self, key: str, file: str, robot: Robot) -> Place:
        model = self._models.get(robot.model)
        if model and file in getattr(model, key):
            return self._line(model, key)
        return robot.place

    def _line(self, spec: Spec, key: str) -> Place:
        return spec.place._replace(line=spec.lines.get(key, spec.place.line))

    def _problem(self, place: Place, problem: str, hint: str) -> None:
        self.problems.append(FleetError(place.file, place.line, problem, hint))


def _of_robot(spec: Spec, name: str) -> Spec:
    """What a group says of one of its robots: the star is its id."""
    policies = tuple(file.replace(STAR, name) for file in spec.policies)
    labels = tuple(file.replace(STAR, name) for file in spec.labels)
    types = tuple(file.replace(STAR, name) for file in spec.types)
    return replace(spec, policies=policies, labels=labels, types=types)
