"""What an answer rests on (rule S12): files with their hashes, the view, what is taken so where nobody says anything.

In: what was read and asked. Out: the ``assumptions`` of a document, and what a database keeps of them.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import MAY_REVEAL, Diagnostic, Place, Severity
from rosprivacy.ingest.labels.countries import countries
from rosprivacy.ingest.neo4j_graph.robot_facts import FILES, diagnostics_of, diagnostics_text, loaded_with
from rosprivacy.question import may_be
from rosprivacy.version import __version__

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.decisions import Decisions
    from rosprivacy.analysis.model import Policy
    from rosprivacy.ingest.labels.label_file import Labels
    from rosprivacy.ingest.types.types_file import TypesFile
    from rosprivacy.question import Question
    from rosprivacy.settings import Settings


def assumptions_of(
    rests_on: Mapping[str, Any], analysis: Analysis, question: Question, *, typed: bool = False
) -> dict[str, Any]:
    """Return the assumptions of a report (rule S12).

    Parameters
    ----------
    rests_on
        As of ``System``.
    analysis
        Its channels that the file of standard channels takes as mundane are counted.
    typed
        Whether the types of any channel are known.
    """
    standard = rests_on["standard_channels"]
    return {
        **_of_question(analysis, question),
        **({"countries_as_of": countries().as_of} if any(f.country for f in analysis.outside.values()) else {}),
        **rests_on,
        "standard_channels": {**standard, "taken": analysis.standard_channels} if standard else None,
        **(_type_limits(analysis, question) if typed else {}),
        **_decisions(question.decisions),
    }


def _of_question(analysis: Analysis, question: Question) -> dict[str, Any]:
    """What is assumed whatever is read."""
    settings, vocabulary = question.settings, question.vocabulary
    broader = may_be(vocabulary, settings, analysis.emitted, question.contexts)
    return {
        "rosprivacy": __version__,
        "view": analysis.graph.view,
        "ontologies": [{"file": name, "sha256": digest} for name, digest in vocabulary.sources],
        "law_as_of": vocabulary.law_as_of,
        "unlabelled_node": "conduit, not reviewed",
        "unlabelled_channel": "sensitive, not reviewed",
        "categories_asked": list(settings.categories) or "all",
        "article9_only": settings.article9,
        **({"article9_level": settings.article9_level or MAY_REVEAL} if settings.article9 else {}),
        "data_types_asked": list(settings.data_types) or "all",
        **({"identity_factors_asked": list(settings.identity_factors)} if settings.identity_factors else {}),
        **({"may_be_asked": broader} if broader else {}),
        "paths": settings.paths,
        "max_paths": settings.max_paths,
        **({"project": [{"file": settings.project[0], "sha256": settings.project[1]}]} if settings.project else {}),
    }


def _type_limits(analysis: Analysis, question: Question) -> dict[str, Any]:
    """Which table of what types cannot carry was used; None where types limit nothing (rule S15)."""
    if analysis.closed is None or question.type_limits is None:
        return {"type_limits": None}
    limits = question.type_limits()
    return {"type_limits": {"file": limits.file, "sha256": limits.sha256, "flows": analysis.closed.flows}}


def files_read(policies: Iterable[Policy], files: Iterable[Labels], settings: Settings) -> dict[str, Any]:
    """Return which files were read; of several robots' each once."""
    labels = ((file.file, file.sha256, file.shipped) for file in files)
    return named_files(sources_of(policies), labels, settings)


def named_files(
    sources: Iterable[tuple[str, str]], labels: Iterable[tuple[str, str, bool]], settings: Settings
) -> dict[str, Any]:
    """Return which files were read.

    Parameters
    ----------
    sources
        (file, SHA-256) of policies.
    labels
        (file, SHA-256, whether it comes with the program) of label files.
    """
    distinct = {(file, digest): shipped for file, digest, shipped in labels}  # one of several robots is named once
    hashes = [(shipped, {"file": file, "sha256": digest}) for (file, digest), shipped in distinct.items()]
    standard = [entry for shipped, entry in hashes if shipped and entry["file"] == settings.standard_channels]
    return {
        "policies": [{"file": name, "sha256": digest} for name, digest in sources],
        "labels": [entry for _, entry in hashes if entry not in standard],
        "standard_channels": standard[0] if standard else None,
    }


def types_read(types: Iterable[TypesFile]) -> dict[str, Any]:
    """Return which files of observed types were read, and from when to when was looked; nothing without one (S16)."""
    rows = []
    for file in types:
        seen = {"from": file.observed.start, "to": file.observed.end, "by": list(file.observed.by)}
        rows.append({"file": file.file, "sha256": file.sha256, "observed": seen})
    return {"types": rows} if rows else {}


def sources_of(system: Iterable[Policy]) -> list[tuple[str, str]]:
    """Return (file, SHA-256) of policies and all that they include, sorted."""
    return sorted({source for policy in system for source in policy.sources})


def _decisions(decisions: Decisions | None) -> dict[str, Any]:
    """Which decisions an answer takes into account, and on which day."""
    if decisions is None:
        return {}
    head = {"head": decisions.head} if decisions.head else {}
    return {"decisions": {"file": decisions.file, "sha256": decisions.sha256, "today": decisions.today, **head}}


def remembered(
    assumptions: Mapping[str, Any], diagnostics: Iterable[Diagnostic], doubts: list[str]
) -> dict[str, str | list[str]]:
    """Return what the answer rests on as properties of a ``Robot``."""
    return {
        "assumptions": json.dumps(assumptions, sort_keys=True),
        "diagnostics": diagnostics_text(diagnostics),
        "doubts": doubts,
    }


def put_together(robots: Iterable[Mapping[str, Any]]) -> tuple[tuple[Diagnostic, ...], dict[str, Any]]:
    """Return what the robots of a database were loaded with, put together (rule S12): diagnostics, what it rests on."""
    robots = list(robots)
    loaded = [loaded_with(robot) for robot in robots if robot.get("assumptions")]
    count = sum(bool(robot.get("assumptions")) and not robot.get("shared") for robot in robots)
    files: dict[str, list[dict[str, str]]] = {}
    for kind in FILES:
        named = {(entry["file"], entry["sha256"]) for said in loaded for entry in said.get(kind, ())}
        if named or kind != "fleet":
            files[kind] = [{"file": name, "sha256": digest} for name, digest in sorted(named)]
    types = {json.dumps(entry, sort_keys=True) for said in loaded for entry in said.get("types", ())}
    standard = [said["standard_channels"] for said in loaded]
    distinct = {(entry["file"], entry["sha256"]) for entry in standard if entry}
    taken = [{"file": name, "sha256": digest} for name, digest in sorted(distinct)]
    diagnostics = {said for robot in robots for said in diagnostics_of(robot)}
    seen: dict[str, Any] = {"types": [json.loads(entry) for entry in sorted(types)]} if types else {}
    rests_on = {**files, **seen, "standard_channels": taken[0] if taken else None, "database": {"robots": count}}
    if len(taken) > 1 or (taken and not all(standard)):
        message = "robots were loaded with different files of standard channels; one of them is named"
        diagnostics.add(Diagnostic(Place("the database", 0), Severity.WARNING, message))
    return tuple(sorted(diagnostics, key=lambda d: (d.place.file, d.place.line, d.message))), rests_on
