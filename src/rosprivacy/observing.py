"""From a running system to a policy, the types of its channels and a label file (rules S3, S15, S16).

In: doors. Out: texts to write, and lines about what was seen and what is known to be missing. What nodes declare of
themselves names a node from which personal data stem, what for, and perhaps the file that they are kept in; it names no
kind of data, so the source is one of ``PersonalData``. Its label file is read only where ``--labels`` names it: a
person takes it over, or does not.
"""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from datetime import datetime, timezone
from itertools import chain, count
from typing import TYPE_CHECKING

from ruamel.yaml.comments import CommentedMap

from rosprivacy.analysis.errors import InputError, InputErrors, ObservationError, shown
from rosprivacy.analysis.model import WITHOUT_WARNINGS
from rosprivacy.analysis.python_311 import from_iso
from rosprivacy.analysis.text import blanked, counted
from rosprivacy.clock import source_date
from rosprivacy.ingest.labels.entries import LONGEST_NAME
from rosprivacy.ingest.policies.observed_metadata import GAPS, UNWARNED
from rosprivacy.ingest.running.doors import seen_by
from rosprivacy.ingest.running.node_info import Ros2Program, TextFiles
from rosprivacy.ingest.running.observation import TYPE, Observation, added_up, moment
from rosprivacy.ingest.running.observed_files import policy_xml, prepared, types_yaml, yaml_text
from rosprivacy.ingest.running.observed_names import is_name
from rosprivacy.ingest.types import named_after, types_path

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence
    from pathlib import Path

    from rosprivacy.ingest.running.doors import Door
    from rosprivacy.ingest.running.observation import Declared, Span
    from rosprivacy.ingest.running.observed_files import Prepared

ANY_KIND = "PersonalData"
HEAD = """\
# What nodes declared of themselves ({type}), seen from {first} to {last}.
# It is their own word: nobody has checked it, and it names no kind of data. Review it, name the kinds, give it with -l.
"""
SECONDS = {"": 1, "s": 1, "m": 60, "h": 3600, "d": 86400}


@dataclass(frozen=True, slots=True)
class ObservedTexts:
    """What is made of an observation.

    Attributes
    ----------
    policy, types
        Texts of the two files.
    declared
        Text of a label file with what nodes declare of themselves; empty if none does.
    remarks
        One line each, for people.
    """

    policy: bytes
    types: str
    declared: str
    remarks: tuple[str, ...]


def now() -> str:
    """Return the time, or that of ``SOURCE_DATE_EPOCH`` (rule S14)."""
    return moment(source_date(os.environ) or datetime.now(timezone.utc))


def seconds_of(duration: str) -> float:
    """Return the seconds of a duration such as ``90``, ``30s``, ``10m`` or ``1.5h``.

    Raises
    ------
    InputError
        If it is none.

    >>> seconds_of("10m"), seconds_of("90"), seconds_of("1.5h")
    (600.0, 90.0, 5400.0)
    """
    match = re.fullmatch(r"([0-9]{1,9}(?:\.[0-9]{1,3})?)([smhd]?)", duration, re.ASCII)
    if match is None:
        raise InputError("--for", 0, f"{shown(repr(duration))} is no duration", "write 30s, 10m or 1h")
    return float(match[1]) * SECONDS[match[2]]


def time_of(text: str) -> str:
    """Return a time that a user names, as observations hold it.

    Raises
    ------
    InputError
        If it is no time, or one of no time zone.

    >>> time_of("2026-11-22T11:00:00+01:00")
    '2026-11-22T10:00:00Z'
    """
    try:
        time = from_iso(text)
        if time.tzinfo is not None:
            return moment(time)
    except (ValueError, OverflowError):
        pass
    raise InputError("--at", 0, f"{shown(repr(text))} is no time with a time zone", "write 2026-11-22T10:00:00Z")


def declared_file(policy: Path, sort: str = "declared") -> Path:
    """Return the label file with what nodes declare of themselves, beside a policy; one that is there stays.

    Parameters
    ----------
    sort
        ``outside`` for that of what lies outside ROS.

    >>> from pathlib import Path
    >>> str(declared_file(Path("robot.policy.xml")))
    'robot.declared.labels.yaml'
    """
    numbered = (named_after(policy, f"{sort}-{number}.labels") for number in count(2))
    return next(file for file in chain([named_after(policy, f"{sort}.labels")], numbered) if not file.exists())


def keeps_what_is_there(policy: Path) -> None:
    """Refuse to write over what an earlier run wrote, before anybody looks (rule S16).

    Raises
    ------
    InputErrors
        If there is a policy, or a file of types, of that name.
    """
    hint = "remove it, or write to another file; --earlier POLICY adds what was seen then"
    there = [file for file in (policy, types_path(policy)) if file.is_file()]
    if there:
        raise InputErrors([InputError(str(file), 0, "is there already and would be lost", hint) for file in there])


def observe(
    doors: Iterable[Door],
    seconds: float | None,
    notify: Callable[[Observation | None, Observation], None] = lambda *_: None,
) -> Observation | None:
    """Look through some doors, one after the other, and return what they have seen together; None if nothing."""
    seen = [one for door in doors if (one := seen_by(door, seconds, notify))]
    return added_up(seen) if seen else None


def observed_texts(texts: Sequence[str] = ()) -> ObservedTexts:
    """Return what runs, as the texts that ``observe`` writes.

    Parameters
    ----------
    texts
        Files with texts of ``ros2 node info``; without any the ``ros2`` program of this machine is asked.

    Raises
    ------
    InputErrors
        If a text cannot be read.
    ObservationError
        If nothing was seen.
    """
    door: Door = TextFiles(tuple(texts), now) if texts else Ros2Program(now)
    seen = observe([door], 0.0)
    made = written(seen) if seen else None
    if made is None:
        raise ObservationError(texts[0] if texts else "ros2", 0, "no node is seen", "start the robot, and look again")
    return made


def written(observation: Observation) -> ObservedTexts | None:
    """Return the policy and the types of an observation; None if there is nothing that a policy can say."""
    ready = prepared(observation)
    if not ready.enclaves:
        return None
    labels = declared_labels(observation.declared, observation.span)
    return ObservedTexts(policy_xml(ready), types_yaml(ready.observation), labels, tuple(_remarks(ready)))


def _of_declarations(observation: Observation) -> Iterator[str]:
    """What nodes said of themselves, and where nothing was heard."""
    heard = {one.topic for one in observation.declared}
    if observation.declared:
        told = counted(len(observation.declared), "declaration")
        yield f"{told} of nodes on how they process personal data: their own word, in a label file to review"
    for name in sorted(
        {one.name for one in observation.endpoints if one.type == TYPE and one.role == "publish"} - heard
    ):
        yield f"{name}: nodes declare there how they process personal data, and none was heard"


def _remarks(ready: Prepared) -> Iterator[str]:
    whole = ready.observation
    nodes = {node for nodes in ready.enclaves.values() for node in nodes}
    channels = {(one.kind, one.name) for one in whole.endpoints}
    amount = f"{counted(len(nodes), 'node')}, {counted(len(channels), 'channel')}"
    yield f"{amount}: observed from {whole.span.first} to {whole.span.last} by {', '.join(whole.doors)}"
    if ready.made_up:
        yield f"enclaves are made up: one per node ({len(ready.made_up):,})"
    yield from whole.remarks
    yield from _of_declarations(whole)
    for one in ready.folded:
        yield f"folded by the rule {one.rule}: {shown(', '.join(one.names))} -> {one.name}"
    for gap, number in whole.all_gaps.items():
        known = f"known gap ({number:,}): {GAPS.get(gap, gap)}; the verdict is undetermined at best"
        yield UNWARNED if gap == WITHOUT_WARNINGS else known
    yield "what was not seen proves nothing"


def declared_labels(several: Iterable[Declared], span: Span) -> str:
    """Return a label file; empty if nothing that is declared can be said in one."""
    nodes: dict[str, CommentedMap] = {}
    elements: dict[str, CommentedMap] = {}
    flows: set[tuple[str, str]] = set()
    for one in sorted(set(several)):
        if not is_name(one.node):
            continue
        facts = nodes.setdefault(one.node, CommentedMap(source=[ANY_KIND], author=f"{one.node} itself"))
        called, purpose = _in_one_line(one.label), _in_one_line(one.purpose)
        _say(facts, "note", f"declared on {one.topic}" + (f": {called}" if called else ""))
        if purpose:
            purposes = facts.setdefault("purpose", [])
            purposes += [purpose] if purpose not in purposes else []
        if one.path:
            name = _element(one.path)
            elements.setdefault(name, CommentedMap(kind="storage", author=f"{one.node} itself"))
            flows.add((one.node, name))
    if not nodes:
        return ""
    document = CommentedMap(labels=1, nodes=CommentedMap(sorted(nodes.items())))
    if elements:
        document["elements"] = CommentedMap(sorted(elements.items()))
        document["flows"] = [{"from": node, "to": name} for node, name in sorted(flows)]
    return HEAD.format(type=TYPE, first=span.first, last=span.last) + yaml_text(document)


def _say(facts: CommentedMap, key: str, text: str) -> None:
    known = facts.get(key)
    facts[key] = text if known is None or known == text else f"{known}; {text}"


def _element(path: str) -> str:
    """A name that no element of ROS has, without what the label file's grammar forbids."""
    return f"file {_in_one_line(path).lstrip('/').replace(':', '_')}"[:LONGEST_NAME].strip()


def _in_one_line(text: str) -> str:
    return " ".join(blanked(text).split())[:LONGEST_NAME]
