"""DDS-Security permissions -> what each subject may do, rule by rule, as it is written.

In: the text of a permissions file. Out: ``Permissions``, or every problem at its line. Nothing is decided here: which
rule wins is said where the graph is built, what ROS calls a topic in ``names``.

Source: DDS-Security 1.1, 9.4.1.3.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.ingest.keystore.domains import Domains
from rosprivacy.ingest.keystore.security_xml import Source, security_entries

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.analysis.model import Place
    from rosprivacy.ingest.keystore.security_xml import Section

RULES = {"allow_rule": True, "deny_rule": False}
CRITERIA = ("publish", "subscribe", "relay")
NOWHERE = Domains(())
_TIME = re.compile(r"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d)(?:\.\d+)?(Z|[+-]\d\d:\d\d)?")


@dataclass(frozen=True, slots=True)
class Criterion:
    """What one ``<publish>``, ``<subscribe>`` or ``<relay>`` is about.

    Attributes
    ----------
    topics
        (expression, where it stands), as written.
    partitions
        Expressions; empty where none is written: then it is about the default partition, which ROS 2 uses.
    tags
        Whether ``<data_tags>`` narrow it, which Fast DDS and Cyclone DDS do not look at.
    """

    direction: str
    topics: tuple[tuple[str, Place], ...]
    partitions: tuple[str, ...]
    tags: bool
    place: Place


@dataclass(frozen=True, slots=True)
class Rule:
    """``<allow_rule>`` or ``<deny_rule>``; the first that matches decides."""

    allow: bool
    domains: Domains
    criteria: tuple[Criterion, ...]
    place: Place


@dataclass(frozen=True, slots=True)
class SubjectGrant:
    """What a certificate's subject may do, and when.

    Attributes
    ----------
    allow
        ``<default>``: what holds where no rule matches.
    default
        Where that stands.
    not_before, not_after
        Without a time zone it is UTC.
    """

    name: str
    subject: str
    not_before: datetime
    not_after: datetime
    rules: tuple[Rule, ...]
    allow: bool
    default: Place
    place: Place


@dataclass(frozen=True, slots=True)
class Permissions:
    """All grants of a permissions file, in its order."""

    file: str
    grants: tuple[SubjectGrant, ...]


def read_permissions(data: bytes, file: str, before: int = 0) -> Permissions:
    """Read the text of a permissions file.

    Parameters
    ----------
    before
        Lines of the file before the text, as in a signed file.

    Raises
    ------
    InputErrors
        With every problem of the text, each a ``PolicyError`` of one line.
    """
    source = Source(file, before)
    grants = tuple(map(_grant, security_entries(data, source, "permissions", "grant")))
    source.check()
    return Permissions(file, grants)


def _grant(grant: Section) -> SubjectGrant:
    tags = {"subject_name", "validity", "default", *RULES}
    parts = {tag: grant.one(tag, tags) for tag in ("subject_name", "validity", "default")}
    subject, validity, default = parts["subject_name"], parts["validity"], parts["default"]
    if subject and not subject.text.strip():
        grant.source.problem(subject.element, "<subject_name> is empty", "write the subject of a certificate")
    rules = tuple(_rule(rule) for rule in grant.children(tags) if rule.tag in RULES)
    first, last = (_time(end) for end in _ends(validity))
    return SubjectGrant(
        str(grant.element.get("name") or ""),
        subject.text.strip() if subject else "",
        first,
        last,
        rules,
        default is not None and default.chosen({"ALLOW", "DENY"}, "DENY") == "ALLOW",
        default.place if default else grant.place,
        grant.place,
    )


def _ends(validity: Section | None) -> tuple[Section | None, Section | None]:
    if validity is None:
        return None, None
    return validity.one("not_before", {"not_after"}), validity.one("not_after", {"not_before"})


def _time(end: Section | None) -> datetime:
    """A moment of the XML schema's ``dateTime``; whole seconds."""
    if end is None:
        return datetime.min.replace(tzinfo=UTC)
    match = _TIME.fullmatch(end.text.strip())
    try:
        written = datetime.fromisoformat(match[1] + (match[2] or "")) if match else None
    except ValueError:
        written = None
    if written is None:
        what = f"{shown(repr(end.text.strip()))} in <{end.tag}>"
        end.source.problem(end.element, what, "write a moment such as 2026-01-31T00:00:00Z")
        return datetime.min.replace(tzinfo=UTC)
    return written if written.tzinfo else written.replace(tzinfo=UTC)


def _rule(rule: Section) -> Rule:
    domains = rule.one("domains", CRITERIA)
    criteria = tuple(_criterion(child) for child in rule.children({"domains", *CRITERIA}) if child.tag in CRITERIA)
    return Rule(RULES[rule.tag], domains.domains() if domains else NOWHERE, criteria, rule.place)


def _criterion(criterion: Section) -> Criterion:
    topics: list[tuple[str, Place]] = []
    partitions: list[str] = []
    tags = False
    for part in criterion.children({"topics", "partitions", "data_tags"}):
        if part.tag == "topics":
            topics += ((name.text, name.place) for name in _named(part, "topic"))
        elif part.tag == "partitions":
            partitions += (name.text for name in _named(part, "partition"))
        else:
            tags = True
    return Criterion(criterion.tag, tuple(topics), tuple(partitions), tags, criterion.place)


def _named(part: Section, tag: str) -> Iterator[Section]:
    names = list(part.children({tag}))
    if not names:
        part.source.problem(part.element, f"<{part.tag}> is empty", f"add a <{tag}>")
    for name in names:
        if name.text or tag == "partition":  # the empty partition is the default one
            yield name
        else:
            part.source.problem(name.element, f"<{tag}> without a name", "write a name, or * for all")
