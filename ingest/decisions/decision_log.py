"""A log of decisions -> ``Decisions``, as of a decisions file; and a new decision, a join, an old file -> the log.

In: the entries of ``decision_chain.py``. The last entry about a target is its decision, whole: nothing of an earlier
one is inherited. A condition holds an acceptance open until an entry confirms it; where branches join that decided
differently about a target, nothing is decided about it.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.decisions import Choice, Decisions
from rosprivacy.analysis.errors import DecisionError, InputError, InputErrors, shown
from rosprivacy.analysis.model.logged_step import LoggedStep
from rosprivacy.ingest.decisions.decision_chain import (
    ENDING,
    SECTIONS,
    ChainEntry,
    canonical,
    heads,
    joined,
    log_text,
    read_chain,
    sealed,
)
from rosprivacy.ingest.decisions.decisions_file import (
    ANSWERS,
    LISTS,
    OF_DOUBTS,
    TARGET,
    DecisionsReader,
    read_decisions,
)
from rosprivacy.ingest.reading import yaml_values
from rosprivacy.ingest.reading.bounded_file import read_regular

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.ingest.reading.yaml_values import Value
    from rosprivacy.ontology.vocabulary import Vocabulary

CONFIRM, WITHDRAW = "confirm", "withdraw"  # what an entry says of the decision before it
SIGNED = ("owner", "reason")  # what both need


def is_log(file: str) -> bool:
    """Return whether a file is a log of decisions: by its name, so that no change in it makes it something else."""
    return file.endswith(ENDING)


@dataclass(slots=True)
class Standing:
    """What a log says of one target.

    Attributes
    ----------
    entry
        The decision that counts; None where it was withdrawn, or branches disagree.
    steps
        All entries about it, in their order.
    confirmed
        Whether its condition is.
    """

    entry: ChainEntry | None = None
    steps: list[ChainEntry] = field(default_factory=list)
    confirmed: bool = False


def standing(entries: Iterable[ChainEntry]) -> dict[str, Standing]:
    """Return target -> what a log says of it."""
    targets: dict[str, Standing] = {}
    for entry in entries:
        for name in entry.facts.get("undecided", ()):
            targets.setdefault(name, Standing()).entry = None
        if not entry.decision:
            continue
        target = targets.setdefault(_target(entry), Standing())
        target.steps.append(entry)
        if entry.decision.get("decision") == CONFIRM:
            target.confirmed = True
        else:
            target.entry = None if entry.decision.get("decision") == WITHDRAW else entry
            target.confirmed = False
    return targets


def read_log_or_file(file: str, vocabulary: Vocabulary, day: str, bounds: Bounds = BOUNDS) -> Decisions:
    """Read decisions from a log or, by its name, from a decisions file; see ``read_decisions``."""
    if not is_log(file):
        return read_decisions(file, vocabulary, day, bounds)
    try:
        data = read_regular(file, yaml_values.MAX_BYTES, partial(DecisionError, file))
    except InputError as error:
        raise InputErrors([error]) from None
    return parse_log(file, data, vocabulary, day, bounds)


def parse_log(file: str, data: bytes, vocabulary: Vocabulary, day: str, bounds: Bounds = BOUNDS) -> Decisions:
    """Read the bytes of a log; see ``decisions_file.read_decisions``.

    Raises
    ------
    InputErrors
        With every entry that was changed, moved or removed, or is no decision.
    """
    entries = read_chain(file, data)
    targets = [target for target in standing(entries).values() if target.entry]
    steps = {target.entry.line: tuple(map(logged_step, target.steps)) for target in targets if target.entry}
    reader = DecisionsReader(file, vocabulary)
    fail = partial(DecisionError, file)
    findings, doubts = (yaml_values.parse(_as_file(targets, section), fail, bounds) for section in SECTIONS)
    decided = tuple(replace(entry, history=steps[entry.place.line]) for entry in reader.document(findings))
    accepted = tuple(reader.doubts(doubts))
    digest = hashlib.sha256(data).hexdigest()
    log = Decisions(file, digest, day, decided, vocabulary.hierarchy, doubts=accepted, head=heads(entries))
    return reader.whole(log)


def with_entry(
    file: str, text: str | None, decision: Mapping[str, Any], section: str, facts: Mapping[str, Any],
    vocabulary: Vocabulary,
) -> str:  # fmt: skip
    """Return the text of a log with one more entry.

    Parameters
    ----------
    text
        Of the log as it is; None if there is none.
    decision
        Key -> value, as in a decisions file; what it does not say is not decided.
    facts
        Who wrote it, when, and what was there then: ``account``, ``when``, ``about``.

    Raises
    ------
    InputErrors
        If the log was changed by another hand, or the entry is not a decision.
    """
    entries = read_chain(file, text.encode()) if text else []
    entry = sealed({**facts, "section": section, "decision": decision}, [heads(entries)] if entries else [])
    _check_step(file, entry, standing(entries).get(_target(entry)))
    text = log_text([*entries, entry])
    parse_log(file, text.encode(), vocabulary, "")
    return text


def merged(file: str, ours: bytes, other: str, theirs: bytes, facts: Mapping[str, Any]) -> tuple[str, list[str]]:
    """Return the text of a log that joins two which begin alike, and the targets about which nothing is decided now.

    Raises
    ------
    InputErrors
        If one was changed by another hand, or they do not begin alike.
    """
    mine, others = read_chain(file, ours), read_chain(other, theirs)
    common = {entry.hash for entry in mine} & {entry.hash for entry in others}
    if heads(mine) in common or heads(others) in common:
        return log_text(others if heads(mine) in common else mine), []
    if not common:
        raise InputErrors([DecisionError(other, 0, f"begins otherwise than {shown(file)}", "name logs of one origin")])
    changed = [_last_decisions(entries, common) for entries in (mine, others)]
    both = sorted(changed[0].keys() & changed[1].keys())
    undecided = [target for target in both if changed[0][target] != changed[1][target]]
    return log_text(joined(mine, others, {**facts, "undecided": undecided})), undecided


def taken_over(top: Value, source: Mapping[str, str], facts: Mapping[str, Any]) -> str:
    """Return the text of a log with what a decisions file says: of each entry its history first.

    Parameters
    ----------
    top
        What the file says; it was read without a problem.
    source
        Its ``file`` and ``sha256``.
    """
    entries: list[ChainEntry] = []
    for section in SECTIONS:
        listed = top.get(section)
        for item in listed.items if listed else ():
            whole = _plain(item)
            target = {key: value for key, value in whole.items() if key in (*TARGET, *OF_DOUBTS)}
            for earlier in (*whole.pop("history", ()), whole):
                fields = {**facts, "from": source, "section": section, "decision": {**target, **earlier}}
                entries.append(sealed(fields, [heads(entries)] if entries else []))
    return log_text(entries)


def _check_step(file: str, entry: ChainEntry, before: Standing | None) -> None:
    """See that what an entry says of the decision before it can be said."""
    step = entry.decision.get("decision")
    if step not in (CONFIRM, WITHDRAW):
        return
    problems = [(f"to {step} without {key}", f"add {key}") for key in SIGNED if not entry.decision.get(key)]
    decision = before.entry.decision if before and before.entry else {}
    if not decision:
        problems.append((f"nothing is decided that could be {step}ed", "name what an entry of the log names"))
    elif step == CONFIRM and (decision.get("decision") != Choice.CONDITIONAL or (before and before.confirmed)):
        problems.append(("no condition is open there", "confirm what was accepted on a condition"))
    if problems:
        raise InputErrors([DecisionError(file, 0, *problem) for problem in problems])


def _target(entry: ChainEntry) -> str:
    """What an entry is about, as text; lists of names in any order are the same."""
    keys = TARGET if entry.facts["section"] == SECTIONS[0] else OF_DOUBTS
    target = {key: entry.decision[key] for key in keys if key in entry.decision}
    return canonical({key: _unordered(value) if key in LISTS else value for key, value in target.items()})


def _unordered(names: Any) -> Any:
    return sorted(map(str, names)) if isinstance(names, list) else names


def _last_decisions(entries: Iterable[ChainEntry], common: set[str]) -> dict[str, object]:
    """Target -> what one branch decided about it last; of two that say the same, neither is in doubt."""
    own = [entry for entry in entries if entry.hash not in common]
    undecided = {name: "" for entry in own for name in entry.facts.get("undecided", ())}
    return undecided | {_target(entry): {**entry.decision, "date": ""} for entry in own if entry.decision}


def _as_file(targets: Iterable[Standing], section: str) -> str:
    """The decisions that count as the text of a decisions file, each in its own line."""
    lines: dict[int, str] = {}
    for target in targets:
        if target.entry and target.entry.facts["section"] == section:
            decision = dict(target.entry.decision)
            if target.confirmed:
                decision["decision"] = Choice.ACCEPT
            lines[target.entry.line] = canonical(decision)
    pieces, at = [], 1
    for number, line in sorted(lines.items()):
        pieces.append("\n" * (number - at) + line)
        at = number
    return f'{{"decisions":1,"{section}":[{",".join(pieces)}]}}'


def logged_step(entry: ChainEntry) -> LoggedStep:
    """Return one entry of a log in the words of the field."""
    account = entry.facts["account"]
    person = " ".join(shown(str(account[key])) for key in ("user", "git") if key in account)
    texts = {key: str(entry.decision.get(key, "")) for key in ("decision", "owner", "reason", "condition", "expires")}
    said = entry.decision.get(ANSWERS)
    answers = tuple(sorted((str(code), str(text)) for code, text in said.items())) if isinstance(said, dict) else ()
    return LoggedStep(entry.hash, str(entry.facts["when"]), person, **texts, answers=answers)


def _plain(value: Value, key: str = "") -> Any:
    """A value of a decisions file as JSON has it."""
    if value.kind == "map":
        return {name: _plain(child, name) for name, _, child in value.entries}
    if value.kind == "list":
        return [_plain(item) for item in value.items]
    if key == "pseudonymised":
        return value.text.lower() == "true"
    return int(value.text) if key == "disjoint_paths" else value.text
