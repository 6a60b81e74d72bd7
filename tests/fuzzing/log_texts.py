"""Choices -> a log of decisions and a branch of it, each now and then as another hand left it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rosprivacy.ingest.decisions.decision_chain import heads, joined, log_text, sealed
from tests.fuzzing.label_texts import decision
from tests.fuzzing.words import with_fault

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.ingest.decisions.decision_chain import ChainEntry
    from tests.fuzzing.choices import Choices

CHANGED = 4  # one log in so many is no more what the program wrote
DOUBTS = ("backups-not-stated", "no-reader", "dead-end", "analysed-in-parts", "no-such-doubt")


def decision_log(choices: Choices) -> dict[str, str]:
    """The log, and another one that begins as it does."""
    common: list[ChainEntry] = []
    _decide(choices, common, 1 + choices.below(4))
    ours, theirs = list(common), list(common)
    _decide(choices, ours, choices.below(3))
    _decide(choices, theirs, choices.below(3))
    if choices.once_in(3) and len(ours) > len(common) and len(theirs) > len(common):
        ours = joined(ours, theirs, {**_provenance(choices), "undecided": []})
        _decide(choices, ours, choices.below(2))
    return {"decisions.jsonl": _left(choices, ours), "theirs.jsonl": log_text(theirs)}


def _decide(choices: Choices, entries: list[ChainEntry], count: int) -> None:
    """Add entries, each sealed after the last."""
    for _ in range(count):
        facts = {**_provenance(choices), **_decided(choices, entries)}
        if choices.once_in(24):
            facts = with_fault(choices, facts)  # sealed all the same: a program of somebody else can do so
        if isinstance(facts, dict):
            entries.append(sealed(facts, [heads(entries)] if entries else []))


def _provenance(choices: Choices) -> dict[str, Any]:
    names = choices.pick((("ada", "Ada <ada@example.org>"), ("", ""), ("b\u202eo", "\u0130 \ud83d")))
    return {
        "account": dict(zip(("os", "git"), names, strict=True)),
        "when": choices.pick(("2026-01-01T00:00:00Z", "9999-12-31T23:59:59Z", "")),
        **({"about": {"finding": "0" * 64, "law": "2026-01-01"}} if choices.once_in(3) else {}),
    }


def _decided(choices: Choices, entries: Sequence[ChainEntry]) -> dict[str, Any]:
    """A decision about a finding or a doubt; or one that says something of an earlier one."""
    if choices.once_in(4):
        of_doubt = {"doubt": choices.pick(DOUBTS), "decision": "accept", "reason": "known", "owner": "A. Person"}
        return {"section": "doubts", "decision": {**of_doubt, "expires": choices.pick(("2099-12-31", "2026-01-01"))}}
    made = decision(choices)
    known = [entry.facts.get("decision") for entry in entries if entry.facts.get("section") == "findings"]
    earlier = [said for said in known if isinstance(said, dict)]  # else it has an odd place
    if earlier and choices.once_in(3):
        target = {
            key: value for key, value in choices.pick(earlier).items() if key in ("id", "category", "source", "leak")
        }
        made = {**target, "decision": choices.pick(("confirm", "withdraw")), "owner": "B", "reason": "done"}
    elif choices.once_in(4):
        made |= {"decision": "accept-on-condition", "condition": "when blurred", "owner": "B", "reason": "so"}
    return {"section": "findings", "decision": made}


def _left(choices: Choices, entries: Sequence[ChainEntry]) -> str:
    """The text of a log: as it was written, or cut, out of order, with lines gone or changed."""
    text = log_text(entries)
    if not choices.once_in(CHANGED):
        return text
    lines = text.splitlines(keepends=True)
    at = choices.below(max(1, len(lines)))
    return choices.pick(
        (
            text[:-1],
            text.replace("A. Person", "M. Other", 1),
            text.replace(":", ": ", 1),
            "".join([*lines[:at], *lines[at + 1 :]]),
            "".join(reversed(lines)),
            "".join([*lines, *lines[at : at + 1]]),
        )
    )
