"""From a running system to a policy and the types of its channels (rules S3, S15, S16).

In: doors. Out: texts to write, and lines about what was seen and what is known to be missing.
"""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import chain, count
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors, shown
from rosprivacy.analysis.model import WITHOUT_WARNINGS
from rosprivacy.analysis.text import counted
from rosprivacy.clock import source_date
from rosprivacy.ingest.doors.doors import seen_by
from rosprivacy.ingest.observe.declared import TYPE
from rosprivacy.ingest.observe.declared_labels import declared_labels
from rosprivacy.ingest.observe.observation import Observation, added_up, moment
from rosprivacy.ingest.observe.observed_policy import policy_xml, prepared
from rosprivacy.ingest.observe.observed_types import types_yaml
from rosprivacy.ingest.policies.observed_metadata import GAPS, UNWARNED

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator
    from pathlib import Path

    from rosprivacy.ingest.doors.doors import Door
    from rosprivacy.ingest.observe.observed_policy import Prepared

SECONDS = {"": 1, "s": 1, "m": 60, "h": 3600, "d": 86400}


@dataclass(frozen=True, slots=True)
class Written:
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
    return moment(source_date(os.environ) or datetime.now(UTC))


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
        time = datetime.fromisoformat(text)
        if time.tzinfo is not None:
            return moment(time)
    except (ValueError, OverflowError):
        pass
    raise InputError("--at", 0, f"{shown(repr(text))} is no time with a time zone", "write 2026-11-22T10:00:00Z")


def types_file(policy: Path) -> Path:
    """Return the file of types that stands beside a policy.

    >>> from pathlib import Path
    >>> str(types_file(Path("a/robot.policy.xml"))), str(types_file(Path("robot.xml")))
    ('a/robot.types.yaml', 'robot.types.yaml')
    """
    return _beside(policy, "types")


def declared_file(policy: Path) -> Path:
    """Return the label file with what nodes declare of themselves, beside a policy; one that is there stays.

    >>> from pathlib import Path
    >>> str(declared_file(Path("robot.policy.xml")))
    'robot.declared.labels.yaml'
    """
    numbered = (_beside(policy, f"declared-{number}.labels") for number in count(2))
    return next(file for file in chain([_beside(policy, "declared.labels")], numbered) if not file.exists())


def keeps_what_is_there(policy: Path) -> None:
    """Refuse to write over what an earlier run wrote, before anybody looks (rule S16).

    Raises
    ------
    InputErrors
        If there is a policy, or a file of types, of that name.
    """
    hint = "remove it, or write to another file; --earlier POLICY adds what was seen then"
    there = [file for file in (policy, types_file(policy)) if file.is_file()]
    if there:
        raise InputErrors([InputError(str(file), 0, "is there already and would be lost", hint) for file in there])


def _beside(policy: Path, what: str) -> Path:
    name = policy.name
    for ending in (".policy.xml", ".xml"):
        if name.lower().endswith(ending) and len(name) > len(ending):
            name = name[: -len(ending)]
            break
    return policy.with_name(f"{name}.{what}.yaml")


def observe(
    doors: Iterable[Door],
    seconds: float | None,
    told: Callable[[Observation | None, Observation], None] = lambda *_: None,
) -> Observation | None:
    """Look through some doors, one after the other, and return what they have seen together; None if nothing."""
    seen = [one for door in doors if (one := seen_by(door, seconds, told))]
    return added_up(seen) if seen else None


def written(observation: Observation) -> Written | None:
    """Return the policy and the types of an observation; None if there is nothing that a policy can say."""
    ready = prepared(observation)
    if not ready.enclaves:
        return None
    labels = declared_labels(observation.declared, observation.seen)
    return Written(policy_xml(ready), types_yaml(ready.observation), labels, tuple(_remarks(ready)))


def _of_declarations(whole: Observation) -> Iterator[str]:
    """What nodes said of themselves, and where nothing was heard."""
    heard = {one.topic for one in whole.declared}
    if whole.declared:
        told = counted(len(whole.declared), "declaration")
        yield f"{told} of nodes on how they process personal data: their own word, in a label file to review"
    for name in sorted({one.name for one in whole.endpoints if one.type == TYPE and one.role == "publish"} - heard):
        yield f"{name}: nodes declare there how they process personal data, and none was heard"


def _remarks(ready: Prepared) -> Iterator[str]:
    whole = ready.observation
    nodes = {node for nodes in ready.enclaves.values() for node in nodes}
    channels = {(one.kind, one.name) for one in whole.endpoints}
    amount = f"{counted(len(nodes), 'node')}, {counted(len(channels), 'channel')}"
    yield f"{amount}: observed from {whole.seen.first} to {whole.seen.last} by {', '.join(whole.doors)}"
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
