"""A log of decisions: bytes -> entries, each of which names the hash of the one before; and what was changed in it.

In: the bytes of a log, one entry a line in canonical JSON (keys sorted, no spaces, UTF-8). Out: the entries, and a
problem for each that was changed, moved or removed. A branch of git that joins another is an entry that names two
before it. What nobody can tell from the log alone, a cut end or a log that was written anew, needs an earlier head.
"""

from __future__ import annotations

import hashlib
import json
import re
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.errors import DecisionError, InputError, InputErrors, shown
from rosprivacy.analysis.json_values import parsed

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

ENDING = ".jsonl"  # of the name of a log
VERSION = 1
RESTORE = "restore the log as it was, from git or a copy, and decide anew"
SECTIONS = ("findings", "doubts")
TEXTS = {"when": str, "account": dict, "before": list, "hash": str}
BRANCHES = 2  # that an entry joins
_HASH = re.compile(r"[0-9a-f]{64}")


class ChainEntry(NamedTuple):
    """One line of a log.

    Attributes
    ----------
    facts
        All that stands in it.
    """

    line: int
    facts: Mapping[str, Any]

    @property
    def hash(self) -> str:
        """Its own hash, as it states it."""
        return str(self.facts["hash"])

    @property
    def before(self) -> tuple[str, ...]:
        """Hashes of the entries before it: none of the first, two where branches join."""
        return tuple(self.facts["before"])

    @property
    def decision(self) -> Mapping[str, Any]:
        """What is decided, and about what; empty where branches join."""
        decision: Mapping[str, Any] = self.facts.get("decision", {})
        return decision


class ChainProblem(NamedTuple):
    """What is wrong with a line."""

    line: int
    problem: str


def canonical(facts: object) -> str:
    """Return JSON that is written in one way only.

    >>> canonical({"b": 1, "a": "ü"})
    '{"a":"ü","b":1}'
    """
    return json.dumps(facts, ensure_ascii=False, sort_keys=True, separators=(",", ":"), allow_nan=False)


def digest(facts: object) -> str:
    """Return the SHA-256 of facts in canonical JSON."""
    return hashlib.sha256(canonical(facts).encode()).hexdigest()


def sealed(facts: Mapping[str, Any], before: Sequence[str]) -> ChainEntry:
    """Return an entry that follows on others, with its hash; signs that cannot be written become question marks."""
    clean = json.loads(canonical({**facts, "log": VERSION, "before": list(before)}).encode("utf-8", "replace"))
    return ChainEntry(0, {**clean, "hash": digest(clean)})


def log_text(entries: Sequence[ChainEntry]) -> str:
    """Return entries as the text of a log."""
    return "".join(f"{canonical(entry.facts)}\n" for entry in entries)


def read_chain(file: str, data: bytes) -> list[ChainEntry]:
    """Return the entries of a log that nobody has changed.

    Raises
    ------
    InputErrors
        With every entry that was changed, moved or removed.
    """
    entries, problems = examine(data)
    if problems:
        raise InputErrors([DecisionError(file, line, problem, RESTORE) for line, problem in problems])
    return entries


def examine(data: bytes, head: str = "") -> tuple[list[ChainEntry], list[ChainProblem]]:
    """Return the entries of a log, and what was changed in it, by line.

    Parameters
    ----------
    head
        The hash of an entry that was the last one once, or the beginning of it; empty if nobody has it.

    Complexity: O(entries).
    """
    entries: list[ChainEntry] = []
    problems: list[ChainProblem] = []
    *lines, rest = data.split(b"\n")
    for number, line in enumerate(lines, 1):
        try:
            entry = _entry(number, line)
        except InputError as error:
            problems.append(ChainProblem(number, error.problem))
            continue
        entries.append(entry)
        if canonical(entry.facts).encode() != line or digest(_unsealed(entry.facts)) != entry.hash:
            problems.append(ChainProblem(number, f"was changed since it was written{_wording(entry)}"))
    if rest or not lines:
        what = "is not whole: the end of the line is not there" if rest else "the log is empty"
        problems.append(ChainProblem(len(lines) + 1, what))
    problems += _out_of_place(entries, {problem.line for problem in problems})
    if head and not any(entry.hash.startswith(head) for entry in entries):
        what = f"the entry {head} is not there: entries were removed from the end, or the log was written anew"
        problems.append(ChainProblem(len(lines) + 1, what))
    return entries, sorted(problems)


def heads(entries: Sequence[ChainEntry]) -> str:
    """Return the hash of the last entry: it stands for all before it."""
    return entries[-1].hash if entries else ""


def joined(ours: Sequence[ChainEntry], theirs: Sequence[ChainEntry], facts: Mapping[str, Any]) -> list[ChainEntry]:
    """Return the entries of two logs in the one order that a new entry gives, which names both heads."""
    union = {entry.hash: entry for entry in (*theirs, *ours)}
    joint = sealed(facts, (heads(ours), heads(theirs)))
    before = {name: entry.before for name, entry in (*union.items(), (joint.hash, joint))}
    return [{**union, joint.hash: joint}[name] for name in _history(before, joint.hash)]


def _unsealed(facts: Mapping[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in facts.items() if key != "hash"}


def _entry(number: int, line: bytes) -> ChainEntry:
    def fail(_: int, problem: str, hint: str) -> InputError:
        return DecisionError("", number, f"is no entry of a log: {problem}", hint)

    facts = parsed(line, fail, RESTORE)
    shaped = isinstance(facts, dict) and all(isinstance(facts.get(key), kind) for key, kind in TEXTS.items())
    if not shaped or not all(isinstance(name, str) and _HASH.fullmatch(name) for name in facts["before"]):
        raise fail(0, "it lacks what every entry has", RESTORE)
    if facts.get("log") != VERSION:
        raise fail(0, f"this reads log: {VERSION}", RESTORE)
    if not (_joins(facts) if "undecided" in facts else _decides(facts)):
        raise fail(0, "it neither decides nor joins", RESTORE)
    return ChainEntry(number, facts)


def _decides(facts: Mapping[str, Any]) -> bool:
    shaped = isinstance(facts.get("decision"), dict) and facts.get("section") in SECTIONS
    return shaped and len(facts["before"]) < BRANCHES


def _joins(facts: Mapping[str, Any]) -> bool:
    names = facts["undecided"]
    shaped = isinstance(names, list) and all(isinstance(name, str) for name in names)
    return shaped and len(facts["before"]) == BRANCHES and "decision" not in facts


def _wording(entry: ChainEntry) -> str:
    """What an entry says of itself now, so that a person knows which it is."""
    facts = ((key, entry.decision.get(key)) for key in ("id", "decision", "owner", "date"))
    text = ", ".join(f"{key} {shown(value)}" for key, value in facts if isinstance(value, str))
    return f"; it says now: {text}" if text else ""


def _out_of_place(entries: Sequence[ChainEntry], changed: set[int]) -> Iterator[ChainProblem]:
    """Entries that do not follow on what they say that they follow on; where one is not there, on the line before."""
    lines: dict[str, int] = {}
    for entry in entries:
        first = lines.setdefault(entry.hash, entry.line)
        if first != entry.line:
            yield ChainProblem(entry.line, f"is the entry of line {first} again")
    single = [entry for entry in entries if lines[entry.hash] == entry.line]
    before: dict[str, list[str]] = {}
    last: list[str] = []
    for entry in single:
        gone = [name for name in entry.before if name not in lines]
        if gone and entry.line not in changed:
            yield ChainProblem(entry.line, f"follows on {gone[0]}, which is not there: it was removed or changed")
        before[entry.hash] = last if gone else list(entry.before)
        last = [entry.hash]
    order = _history(before, heads(single))
    for entry in single:
        if entry.hash not in order:
            yield ChainProblem(entry.line, "is before no later entry: it was moved, or what followed on it was removed")
    here = [entry.hash for entry in single if entry.hash in order]
    for name, place in zip(order, here, strict=True):
        if name != place:
            yield ChainProblem(lines[place], f"the order was changed: the entry of line {lines[name]} belongs here")
            return


def _history(before: Mapping[str, Sequence[str]], head: str) -> dict[str, None]:
    """The hashes of a head and all before it, in the one order that a log has: the first branch that joins first."""
    order: dict[str, None] = {}
    visited: set[str] = set()
    stack = [(head, False)]
    while stack:
        name, complete = stack.pop()
        if complete:
            order[name] = None
        elif name in before and name not in visited:
            visited.add(name)
            stack.append((name, True))
            stack += [(earlier, False) for earlier in reversed(before[name])]
    return order
