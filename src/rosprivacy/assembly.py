"""The way through the house: files -> model -> graph -> analysis. The command line is a thin layer over this.

In: what a user names. Out: a ``Result``.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import rosprivacy
from rosprivacy.analysis.errors import InputError, InputErrors, OntologyError, shown
from rosprivacy.analysis.findings import MAX_PATHS, Options, analyse
from rosprivacy.analysis.model import Diagnostic, Place, Severity
from rosprivacy.analysis.paths import WITNESS
from rosprivacy.analysis.patterns import FleetView
from rosprivacy.ingest.binding import bind
from rosprivacy.ingest.countries import countries
from rosprivacy.ingest.files import read_policies
from rosprivacy.ingest.graph import DECLARED, build
from rosprivacy.ingest.labels import STANDARD, read_labels
from rosprivacy.ingest.outside import extend
from rosprivacy.ingest.saved import read_saved
from rosprivacy.ingest.xinclude import MAX_BYTES
from rosprivacy.ontology.vocabulary import TOP, load
from rosprivacy.report.document import document
from rosprivacy.report.fleet import fleet_document

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from neo4j import Driver

    from rosprivacy.analysis.model import Analysis, Bound, FlowGraph, Policy
    from rosprivacy.ingest.labels import Labels
    from rosprivacy.ingest.rows import RobotRows
    from rosprivacy.ontology.vocabulary import Vocabulary


@dataclass(frozen=True, slots=True)
class Settings:
    """How to read and what to ask.

    Attributes
    ----------
    add
        Saved graphs to add to.
    view
        ``declared`` or ``enforced``, rule S6.
    categories
        Names; the answer is about these and narrower ones. Empty for all.
    category
        What the paper's six lists are about.
    standard_channels
        The label file of the standard channels, or None to take none as mundane (rule S13).
    paths, max_paths
        See ``Options``.
    include_root, max_bytes
        See ``read_policy``.
    progress
        Wraps the list of files, to show how far it is.
    """

    add: tuple[str, ...] = ()
    view: str = DECLARED
    categories: tuple[str, ...] = ()
    category: str = TOP
    standard_channels: str | None = STANDARD
    paths: str = WITNESS
    max_paths: int = MAX_PATHS
    include_root: str | None = None
    max_bytes: int = MAX_BYTES
    progress: Callable[[Sequence[str]], Iterable[str]] = field(default=lambda files: files)


@dataclass(frozen=True, slots=True)
class Result:
    """An analysis and what it rests on.

    Attributes
    ----------
    fleet
        Which robots of the graph stand for which, and what they have in common; None for a single robot.
    """

    analysis: Analysis
    bound: Bound
    vocabulary: Vocabulary
    policies: tuple[Policy, ...]
    diagnostics: tuple[Diagnostic, ...]
    assumptions: dict[str, Any]
    fleet: FleetView | None = None

    def document(self) -> dict[str, Any]:
        """Return the JSON document of the contract."""
        vocabulary = self.vocabulary
        analysis = self.fleet.shown(self.analysis) if self.fleet else self.analysis
        told = document(analysis, vocabulary.categories, vocabulary.hierarchy, self.diagnostics, self.assumptions)
        return fleet_document(told, self.analysis, self.fleet) if self.fleet else told


def run(policies: tuple[str, ...], labels: tuple[str, ...], settings: Settings) -> Result:
    """Read everything, analyse it, and keep what the answer rests on.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    vocabulary = load()
    asked = asked_for(vocabulary, settings.categories)
    system, diagnostics = read_system(policies, settings)
    files = read_label_files(labels, vocabulary, settings)
    graph = extend(build(system, settings.view), files)
    bound = bind(graph, files)
    analysis = analyse(graph, bound, vocabulary.hierarchy, Options(asked, settings.paths, settings.max_paths))
    said = tuple(d for policy in system for d in policy.diagnostics) + diagnostics
    said += tuple(d for file in files for d in file.diagnostics)
    return Result(
        analysis,
        bound,
        vocabulary,
        system,
        said,
        what_it_rests_on(graph, sources_of(system), files, analysis, settings),
    )


def run_stored(driver: Driver, settings: Settings) -> Result:
    """Analyse what is in the database, with what people added to it, and write the answer back.

    Raises
    ------
    InputErrors
        With every element, flow and role that cannot be understood.
    DatabaseError
        If the server refuses, or a robot was loaded meanwhile.
    """
    from rosprivacy.ingest.stored import read_stored  # noqa: PLC0415 - only where there is a database
    from rosprivacy.ingest.writeback import write_back  # noqa: PLC0415

    vocabulary = load()
    asked = asked_for(vocabulary, settings.categories)
    stored = read_stored(driver, vocabulary)
    everything = Options(None, settings.paths, settings.max_paths)
    analysis = analyse(stored.graph, stored.bound, vocabulary.hierarchy, everything)
    write_back(driver, stored, analysis, vocabulary)
    if asked is not None:
        chosen = Options(asked, settings.paths, settings.max_paths)
        analysis = analyse(stored.graph, stored.bound, vocabulary.hierarchy, chosen)
    said, assumptions = _remembered(stored.robots.values(), stored.graph, analysis, settings)
    view = FleetView.of(analysis, stored.likeness) if len(stored.robots) > 1 else None
    return Result(analysis, stored.bound, vocabulary, (), said, assumptions, view)


def robot_of(name: str, result: Result) -> RobotRows:
    """Return the rows of a robot for the database; what the answer rests on goes with it."""
    from rosprivacy.ingest.rows import robot_rows  # noqa: PLC0415

    more = remembered(result.assumptions, result.diagnostics)
    return robot_rows(name, result.analysis, result.bound, result.vocabulary, more)


def remembered(assumptions: Mapping[str, Any], diagnostics: Iterable[Diagnostic]) -> dict[str, str]:
    """Return what the answer rests on as properties of a ``Robot``."""
    return {
        "assumptions": json.dumps(assumptions, sort_keys=True),
        "diagnostics": json.dumps([_as_dict(diagnostic) for diagnostic in diagnostics]),
    }


def _as_dict(diagnostic: Diagnostic) -> dict[str, Any]:
    place = diagnostic.place
    return {"file": place.file, "line": place.line, "severity": diagnostic.severity, "message": diagnostic.message}


def _remembered(
    robots: Iterable[Mapping[str, Any]], graph: FlowGraph, analysis: Analysis, settings: Settings
) -> tuple[tuple[Diagnostic, ...], dict[str, Any]]:
    """What the robots were loaded with, put together (rule S12)."""
    robots = list(robots)
    loaded = [json.loads(robot["assumptions"]) for robot in robots if robot.get("assumptions")]
    count = sum(bool(robot.get("assumptions")) and not robot.get("shared") for robot in robots)
    files: dict[str, list[dict[str, str]]] = {}
    for kind in ("policies", "labels", "fleet"):
        named = {(entry["file"], entry["sha256"]) for said in loaded for entry in said.get(kind, ())}
        if named or kind != "fleet":
            files[kind] = [{"file": name, "sha256": digest} for name, digest in sorted(named)]
    standard = [said["standard_channels"] for said in loaded]
    distinct = {(entry["file"], entry["sha256"]) for entry in standard if entry}
    taken = [{"file": name, "sha256": digest} for name, digest in sorted(distinct)]
    diagnostics = {
        Diagnostic(Place(d["file"], d["line"]), Severity(d["severity"]), d["message"])
        for robot in robots
        for d in json.loads(robot.get("diagnostics") or "[]")
    }
    assumptions = {
        **_own_assumptions(graph, settings),
        **_adequacy(analysis),
        **files,
        "standard_channels": {**taken[0], "taken": analysis.standard_channels} if taken else None,
        "database": {"robots": count},
    }
    if len(taken) > 1 or (taken and not all(standard)):
        message = "robots were loaded with different files of standard channels; one of them is named"
        diagnostics.add(Diagnostic(Place("the database", 0), Severity.WARNING, message))
    return tuple(sorted(diagnostics, key=lambda d: (d.place.file, d.place.line, d.message))), assumptions


def read_system(policies: tuple[str, ...], settings: Settings) -> tuple[tuple[Policy, ...], tuple[Diagnostic, ...]]:
    """Read policies and the saved graphs that they add to."""
    saved = [policy for file in settings.add for policy in read_saved(file)]
    read: tuple[Policy, ...] = ()
    diagnostics: tuple[Diagnostic, ...] = ()
    if policies or not saved:
        read, diagnostics = read_policies(
            policies,
            include_root=settings.include_root,
            max_bytes=settings.max_bytes,
            progress=settings.progress,
        )
    known = {policy.file for policy in read}  # read again is read anew
    system = (*read, *(policy for policy in saved if policy.file not in known))
    return tuple(sorted(system, key=lambda policy: policy.file)), diagnostics


def standard_channels(graph: FlowGraph, vocabulary: Vocabulary, settings: Settings) -> set[tuple[str, str]]:
    """Return (kind, name) of the channels that the standard file takes as mundane (rule S13)."""
    bound = bind(graph, read_label_files((), vocabulary, settings))
    return {(graph.elements[vertex].kind, graph.elements[vertex].name) for vertex in bound.elements}


def read_label_files(labels: tuple[str, ...], vocabulary: Vocabulary, settings: Settings) -> list[Labels]:
    """Read the standard channels' file and the user's, with the problems of all of them."""
    files: list[Labels] = []
    problems: list[InputError] = []
    standard = [settings.standard_channels] if settings.standard_channels else []
    for file in dict.fromkeys([*standard, *labels]):
        try:
            shipped = file in standard and file not in labels  # named by the user, it is the user's own
            files.append(read_labels(file, vocabulary, category=settings.category, shipped=shipped))
        except InputErrors as error:
            problems += error.errors
    if problems:
        raise InputErrors(problems)
    return files


def asked_for(vocabulary: Vocabulary, names: tuple[str, ...]) -> set[str] | None:
    """Return the categories that the answer is about, narrower ones included; None for all."""
    asked: set[str] = set()
    problems = []
    for name in names:
        category = vocabulary.find(name)
        if category is None:
            hint = f"did you mean one of: {', '.join(vocabulary.nearest(name))}?"
            problems.append(OntologyError("--categories", 0, f"unknown category {shown(name)!r}", hint))
        else:
            asked |= vocabulary.with_narrower(category.name)
    if problems:
        raise InputErrors(problems)
    return asked if names else None


def sources_of(system: Iterable[Policy]) -> list[tuple[str, str]]:
    """Return (file, SHA-256) of policies and all that they include, sorted."""
    return sorted({source for policy in system for source in policy.sources})


def what_it_rests_on(
    graph: FlowGraph,
    sources: Iterable[tuple[str, str]],
    files: Iterable[Labels],
    analysis: Analysis,
    settings: Settings,
) -> dict[str, Any]:
    """Return the assumptions of a report (rule S12)."""
    hashes = [(file, {"file": file.file, "sha256": file.sha256}) for file in files]
    standard = [entry for file, entry in hashes if file.shipped and file.file == settings.standard_channels]
    return {
        **_own_assumptions(graph, settings),
        **_adequacy(analysis),
        "policies": [{"file": name, "sha256": digest} for name, digest in sources],
        "labels": [entry for _, entry in hashes if entry not in standard],
        "standard_channels": {**standard[0], "taken": analysis.standard_channels} if standard else None,
    }


def _adequacy(analysis: Analysis) -> dict[str, str]:
    """The date of the list of countries, where it counts (rule S10)."""
    return {"countries_as_of": countries().as_of} if any(facts.country for facts in analysis.outside.values()) else {}


def _own_assumptions(graph: FlowGraph, settings: Settings) -> dict[str, Any]:
    return {
        "rosprivacy": rosprivacy.__version__,
        "view": graph.view,
        "unlabelled_node": "conduit, not reviewed",
        "unlabelled_channel": "sensitive, not reviewed",
        "categories_asked": list(settings.categories) or "all",
        "paths": settings.paths,
        "max_paths": settings.max_paths,
    }
