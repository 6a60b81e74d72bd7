"""The way through the house: files -> model -> graph -> analysis. The command line is a thin layer over this.

In: what a user names. Out: a ``Result``.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from itertools import chain
from typing import TYPE_CHECKING, Any

import rosprivacy
from rosprivacy.analysis.decisions import decided
from rosprivacy.analysis.errors import InputError, InputErrors, OntologyError, shown
from rosprivacy.analysis.findings import MAX_PATHS, Options, analyse
from rosprivacy.analysis.model import Diagnostic, Place, Severity
from rosprivacy.analysis.paths import WITNESS
from rosprivacy.ingest.binding import bind
from rosprivacy.ingest.countries import countries
from rosprivacy.ingest.files import read_policies
from rosprivacy.ingest.graph import DECLARED, build
from rosprivacy.ingest.labels import STANDARD, read_labels
from rosprivacy.ingest.outside import extend
from rosprivacy.ingest.saved import read_saved
from rosprivacy.ingest.xinclude import MAX_BYTES
from rosprivacy.ontology.special import special_provision
from rosprivacy.ontology.vocabulary import TOP, load
from rosprivacy.report.decided import with_decisions
from rosprivacy.report.document import document

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from neo4j import Driver

    from rosprivacy.analysis.decisions import Decided, Decisions
    from rosprivacy.analysis.model import Analysis, Bound, Category, FlowGraph, Policy
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
    article9
        Answer only for kinds that fall or may fall under Article 9(1) GDPR, or of which that is not known.
    data_types
        Answer only for kinds that are represented so, such as video. Empty for all.
    ontologies
        Users' own, beside the shipped one.
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
    decisions
        A decisions file.
    today
        ISO date on which decisions are valid or expired; None for the date of now (or ``SOURCE_DATE_EPOCH``).
    """

    add: tuple[str, ...] = ()
    view: str = DECLARED
    categories: tuple[str, ...] = ()
    article9: bool = False
    data_types: tuple[str, ...] = ()
    ontologies: tuple[str, ...] = ()
    category: str = TOP
    standard_channels: str | None = STANDARD
    paths: str = WITNESS
    max_paths: int = MAX_PATHS
    include_root: str | None = None
    max_bytes: int = MAX_BYTES
    progress: Callable[[Sequence[str]], Iterable[str]] = field(default=lambda files: files)
    decisions: str | None = None
    today: str | None = None


@dataclass(frozen=True, slots=True)
class Result:
    """An analysis and what it rests on."""

    analysis: Analysis
    bound: Bound
    vocabulary: Vocabulary
    policies: tuple[Policy, ...]
    diagnostics: tuple[Diagnostic, ...]
    assumptions: dict[str, Any]
    labels: tuple[Labels, ...] = ()
    options: Options = field(default_factory=Options)
    decided: Decided | None = None

    def document(self) -> dict[str, Any]:
        """Return the JSON document of the contract."""
        vocabulary = self.vocabulary
        made = document(
            self.analysis,
            vocabulary.categories,
            vocabulary.hierarchy,
            self.diagnostics,
            self.assumptions,
            self.bound.subjects,
        )
        return with_decisions(made, self.decided) if self.decided else made

    def linked_data(self, form: str, **more: Any) -> str:
        """Return the findings as RDF, in ``turtle`` or ``json-ld``; ``more`` as for ``rdf_graph``."""
        from rosprivacy.report.rdf import rdf_graph  # noqa: PLC0415 - rdflib, only where it is used
        from rosprivacy.report.serialise import SERIALISERS  # noqa: PLC0415

        graph = rdf_graph(self.analysis, self.vocabulary, self.diagnostics, self.assumptions, **more)
        return SERIALISERS[form](graph)


def run(policies: tuple[str, ...], labels: tuple[str, ...], settings: Settings) -> Result:
    """Read everything, analyse it, and keep what the answer rests on.

    Raises
    ------
    InputErrors
        With every problem of the input, one line each.
    """
    vocabulary = load(ontologies=settings.ontologies)
    asked = _asked(vocabulary, settings)
    system, diagnostics = read_system(policies, settings)
    files = _read_labels(labels, vocabulary, settings)
    graph = extend(build(system, settings.view), files)
    bound = bind(graph, files)
    decisions = _decisions(settings, vocabulary)
    options = Options(asked, settings.paths, settings.max_paths, decisions.accepts if decisions else None)
    analysis = analyse(graph, bound, vocabulary.hierarchy, options)
    joined = _joined(decisions, analysis, vocabulary, asked)
    said = tuple(d for policy in system for d in policy.diagnostics) + diagnostics
    said += tuple(d for file in files for d in file.diagnostics)
    said += joined.diagnostics if joined else ()
    rests_on = _own_assumptions(graph, settings, vocabulary) | _assumptions(system, files, analysis, settings)
    rests_on |= _assumed_decisions(decisions)
    return Result(analysis, bound, vocabulary, system, said, rests_on, tuple(files), options, joined)


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

    vocabulary = load(ontologies=settings.ontologies)
    asked = _asked(vocabulary, settings)
    stored = read_stored(driver, vocabulary)
    everything = Options(None, settings.paths, settings.max_paths)
    analysis = analyse(stored.graph, stored.bound, vocabulary.hierarchy, everything)
    write_back(driver, stored, analysis, vocabulary)
    decisions = _decisions(settings, vocabulary)
    chosen = Options(asked, settings.paths, settings.max_paths, decisions.accepts if decisions else None)
    if chosen != everything:
        analysis = analyse(stored.graph, stored.bound, vocabulary.hierarchy, chosen)
    joined = _joined(decisions, analysis, vocabulary, asked)
    said, remembered = _remembered(stored.robots.values(), analysis)
    said += joined.diagnostics if joined else ()
    assumptions = _own_assumptions(stored.graph, settings, vocabulary) | remembered | _assumed_decisions(decisions)
    return Result(analysis, stored.bound, vocabulary, (), said, assumptions, options=chosen, decided=joined)


def _decisions(settings: Settings, vocabulary: Vocabulary) -> Decisions | None:
    if settings.decisions is None:
        return None
    from rosprivacy.ingest.decisions import read_decisions, today  # noqa: PLC0415 - only where there are some

    return read_decisions(settings.decisions, vocabulary, settings.today or today())


def _joined(
    decisions: Decisions | None, analysis: Analysis, vocabulary: Vocabulary, asked: set[str] | None
) -> Decided | None:
    """Decisions joined to findings; where only some categories were asked for, none is called orphaned."""
    if decisions is None:
        return None
    special = {name: special_provision(vocabulary, name) for name in analysis.emitted}
    held = {name: provision for name, provision in special.items() if provision}
    return decided(decisions, analysis.findings, held, everything=asked is None)


def _assumed_decisions(decisions: Decisions | None) -> dict[str, Any]:
    if decisions is None:
        return {}
    return {"decisions": {"file": decisions.file, "sha256": decisions.sha256, "today": decisions.today}}


def robot_of(name: str, result: Result) -> RobotRows:
    """Return the rows of a robot for the database; what the answer rests on goes with it."""
    from rosprivacy.ingest.rows import robot_rows  # noqa: PLC0415

    more = {
        "assumptions": json.dumps(result.assumptions, sort_keys=True),
        "diagnostics": json.dumps([_as_dict(diagnostic) for diagnostic in result.diagnostics]),
    }
    return robot_rows(name, result.analysis, result.bound, result.vocabulary, more)


def _as_dict(diagnostic: Diagnostic) -> dict[str, Any]:
    place = diagnostic.place
    return {"file": place.file, "line": place.line, "severity": diagnostic.severity, "message": diagnostic.message}


def _remembered(
    robots: Iterable[Mapping[str, Any]], analysis: Analysis
) -> tuple[tuple[Diagnostic, ...], dict[str, Any]]:
    """What the robots were loaded with, put together (rule S12)."""
    loaded = [json.loads(robot["assumptions"]) for robot in robots if robot.get("assumptions")]
    files: dict[str, list[dict[str, str]]] = {}
    for kind in ("policies", "labels"):
        named = {(entry["file"], entry["sha256"]) for entry in chain.from_iterable(said[kind] for said in loaded)}
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
        **_adequacy(analysis),
        **files,
        "standard_channels": {**taken[0], "taken": analysis.standard_channels} if taken else None,
        "database": {"robots": len(loaded)},
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
    bound = bind(graph, _read_labels((), vocabulary, settings))
    return {(graph.elements[vertex].kind, graph.elements[vertex].name) for vertex in bound.elements}


def _read_labels(labels: tuple[str, ...], vocabulary: Vocabulary, settings: Settings) -> list[Labels]:
    """The standard channels' file and the user's, with the problems of all of them."""
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


def _asked(vocabulary: Vocabulary, settings: Settings) -> set[str] | None:
    """The categories that the answer is about, narrower ones included; None for all."""
    if not (settings.categories or settings.article9 or settings.data_types):
        return None
    asked = set(vocabulary.categories)
    problems = []
    if settings.categories:
        asked = set()
        for name in settings.categories:
            category = vocabulary.find(name)
            if category is None:
                what = f"unknown category {shown(name)!r}"
                problems.append(OntologyError("--categories", 0, what, vocabulary.hint(name)))
            else:
                asked |= vocabulary.with_narrower(category.name)
    known = sorted({kind for category in vocabulary.categories.values() for kind in category.data_types})
    for kind in settings.data_types:
        if kind not in known:
            hint = f"it is one of: {', '.join(known)}"
            problems.append(OntologyError("--data-type", 0, f"unknown data type {shown(kind)!r}", hint))
    if problems:
        raise InputErrors(problems)
    return {name for name in asked if _chosen(vocabulary.categories[name], settings)}


def _chosen(category: Category, settings: Settings) -> bool:
    """Whether the filters keep a category; what is not known of it is kept, since silence would look like an answer."""
    types = not settings.data_types or not category.data_types or set(category.data_types) & set(settings.data_types)
    return bool(types) and (not settings.article9 or category.article9 != "no")


def _assumptions(
    system: tuple[Policy, ...], files: list[Labels], analysis: Analysis, settings: Settings
) -> dict[str, Any]:
    """What the answer rests on (rule S12)."""
    sources = sorted({source for policy in system for source in policy.sources})
    hashes = [(file, {"file": file.file, "sha256": file.sha256}) for file in files]
    standard = [entry for file, entry in hashes if file.shipped and file.file == settings.standard_channels]
    return {
        **_adequacy(analysis),
        "policies": [{"file": name, "sha256": digest} for name, digest in sources],
        "labels": [entry for _, entry in hashes if entry not in standard],
        "standard_channels": {**standard[0], "taken": analysis.standard_channels} if standard else None,
    }


def _adequacy(analysis: Analysis) -> dict[str, str]:
    """The date of the list of countries, where it counts (rule S10)."""
    return {"countries_as_of": countries().as_of} if any(facts.country for facts in analysis.outside.values()) else {}


def _own_assumptions(graph: FlowGraph, settings: Settings, vocabulary: Vocabulary) -> dict[str, Any]:
    return {
        "rosprivacy": rosprivacy.__version__,
        "view": graph.view,
        "ontologies": [{"file": name, "sha256": digest} for name, digest in vocabulary.sources],
        "law_as_of": vocabulary.law_as_of,
        "unlabelled_node": "conduit, not reviewed",
        "unlabelled_channel": "sensitive, not reviewed",
        "categories_asked": list(settings.categories) or "all",
        "article9_only": settings.article9,
        "data_types_asked": list(settings.data_types) or "all",
        "paths": settings.paths,
        "max_paths": settings.max_paths,
    }
