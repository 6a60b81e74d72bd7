"""The log of decisions: what each change of it shows, what counts of its entries, how branches join, old files."""

from __future__ import annotations

import json
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.decisions import Choice
from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.decisions.decision_chain import (
    SECTIONS,
    canonical,
    examine,
    heads,
    log_text,
    read_chain,
    sealed,
)
from rosprivacy.ingest.decisions.decision_log import merged, parse_log, with_entry
from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rosprivacy.analysis.decisions import Decisions
    from rosprivacy.ingest.decisions.decision_chain import ChainEntry

VOCABULARY = load()
FACTS = {"account": {"user": "alice@desk"}, "when": "2026-11-28T12:00:00Z"}
ID, OTHER = "7ac677bf059b5beb", "0123456789abcdef"
SIGNED = {"reason": "needed", "owner": "A. Lee"}
ACCEPT = {"id": ID, "decision": "accept", **SIGNED}


def log(*decisions: dict[str, Any], begun: str | None = None) -> str:
    text = begun
    for decision in decisions:
        text = with_entry("d.jsonl", text, decision, "findings", FACTS, VOCABULARY)
    return text or ""


def read(text: str) -> Decisions:
    return parse_log("d.jsonl", text.encode(), VOCABULARY, "2026-11-28")


def head(text: str) -> str:
    return heads(read_chain("d.jsonl", text.encode()))


def named(data: bytes, head: str = "") -> set[int]:
    """The lines of which something is wrong."""
    return {problem.line for problem in examine(data, head)[1]}


def choices(text: str) -> dict[str, tuple[Choice, str]]:
    return {entry.id: (entry.choice, entry.expires) for entry in read(text).entries}


IDS = st.integers(1, 5).map("{:016x}".format)
DECISION = st.fixed_dictionaries(
    {"id": IDS, "decision": st.sampled_from(["accept", "mitigate", "avoid"]), "owner": st.just("Ä. Lee")},
    optional={"expires": st.just("2999-01-01"), "ticket": st.text('aü"\\\u2028', min_size=1).filter(str.strip)},
).map(lambda decision: {"reason": "why", **decision})
LOGS = st.lists(DECISION, min_size=2, max_size=6).map(lambda decisions: log(*decisions))


@given(LOGS, st.data())
def test_each_changed_byte_is_named(text: str, data: st.DataObject) -> None:
    whole = bytearray(text.encode())
    at = data.draw(st.integers(0, len(whole) - 1))
    line = whole.count(b"\n", 0, at) + 1
    whole[at] ^= data.draw(st.integers(1, 255))
    assert line in named(bytes(whole))


@given(LOGS, st.data())
def test_a_removed_entry_is_named_by_what_followed_on_it(text: str, data: st.DataObject) -> None:
    """The last one by an earlier head alone, and nobody else's line is named."""
    lines = _lines(text)
    at = data.draw(st.integers(0, len(lines) - 1))
    rest = b"".join([*lines[:at], *lines[at + 1 :]])
    assert named(rest) == ({at + 1} if at < len(lines) - 1 else set())
    assert named(rest, head(text))


def _lines(text: str) -> list[bytes]:
    return [line + b"\n" for line in text.encode().split(b"\n")[:-1]]


@given(LOGS, st.data())
def test_entries_in_another_order_are_named(text: str, data: st.DataObject) -> None:
    lines = _lines(text)
    first, second = data.draw(st.lists(st.integers(0, len(lines) - 1), min_size=2, max_size=2, unique=True).map(sorted))
    lines[first], lines[second] = lines[second], lines[first]
    assert named(b"".join(lines)) & {first + 1, second + 1}


@given(LOGS, st.data())
def test_an_entry_that_stands_twice_is_named(text: str, data: st.DataObject) -> None:
    lines = _lines(text)
    copy, place = (data.draw(st.integers(0, len(lines) - 1)) for _ in range(2))
    assert named(b"".join([*lines[:place], lines[copy], *lines[place:]]))


def test_what_an_editor_changes_is_named_with_what_it_says_now() -> None:
    text = log({**ACCEPT, "expires": "2027-11-01"}, {"id": OTHER, "decision": "avoid"})
    for was, is_now in (("A. Lee", "M. Mallory"), ("2027-11-01", "2029-11-01"), ("12:00:00Z", "11:00:00Z")):
        (problem,) = examine(text.replace(was, is_now, 1).encode())[1]
        assert problem.line == 1
        with pytest.raises(InputErrors):  # and nothing in it counts
            read(text.replace(was, is_now, 1))


def test_a_log_that_was_written_anew_is_seen_by_an_earlier_head_only() -> None:
    old, new = log(ACCEPT), log({**ACCEPT, "owner": "M. Mallory"})
    assert not named(new.encode())
    assert named(new.encode(), head(old))
    assert not named(log({"id": OTHER, "decision": "avoid"}, begun=old).encode(), head(old)[:16])  # it went on


@pytest.mark.parametrize(
    "data", [b"", b"\n", b"{}\n", b"decisions: 1\n", b"[1]\n", b'{"log":1}\n', b"\xff\n", b"9" * 9_999 + b"\n"]
)
def test_what_is_no_log_is_refused(data: bytes) -> None:
    assert named(data) == {1}


@pytest.mark.parametrize(
    "facts",
    [
        {"section": "findings", "decision": {}, "before": ["x"]},
        {"section": "findings", "decision": {}, "before": [["0" * 64]]},
        {"section": "else", "decision": {}, "before": []},
        {"undecided": [1], "before": ["0" * 64, "1" * 64]},
        {"undecided": [], "before": []},
    ],
)
def test_an_entry_of_another_shape_is_refused(facts: dict[str, Any]) -> None:
    entry = {**FACTS, "hash": "0" * 64, "log": 1, **facts}
    assert named(f"{canonical(entry)}\n".encode()) == {1}


def test_the_last_entry_about_a_target_counts_whole() -> None:
    """Who decides anew says until when: no end is inherited."""
    text = log({**ACCEPT, "expires": "2027-11-01", "ticket": "T-1"}, {**ACCEPT, "owner": "B. Lee"})
    (entry,) = read(text).entries
    assert (entry.owner, entry.expires, entry.ticket, entry.place.line) == ("B. Lee", "", "", 2)
    assert [step.owner for step in entry.history] == ["A. Lee", "B. Lee"]
    assert entry.history[-1].hash == read(text).head


def test_robots_in_another_order_are_the_same_target() -> None:
    text = log({**ACCEPT, "robots": ["a", "b"]}, {**ACCEPT, "robots": ["b", "a"]}, {**ACCEPT, "robots": ["a"]})
    assert [entry.place.line for entry in read(text).entries] == [2, 3]


def test_a_condition_is_open_until_it_is_confirmed() -> None:
    conditional = {**ACCEPT, "decision": "accept-on-condition", "condition": "contract", "expires": "2999-01-01"}
    with pytest.raises(InputErrors, match="without condition"):
        log({**ACCEPT, "decision": "accept-on-condition"})
    text = log(conditional)
    assert choices(text) == {ID: (Choice.CONDITIONAL, "2999-01-01")}
    text = log({"id": ID, "decision": "confirm", **SIGNED}, begun=text)
    assert choices(text) == {ID: (Choice.ACCEPT, "2999-01-01")}
    assert choices(log(conditional, begun=text)) == {ID: (Choice.CONDITIONAL, "2999-01-01")}  # anew, and open again


def test_what_cannot_be_confirmed_or_withdrawn_is_refused() -> None:
    for step in ("confirm", "withdraw"):
        with pytest.raises(InputErrors, match="nothing is decided"):
            log({"id": ID, "decision": step, **SIGNED})
        with pytest.raises(InputErrors, match="without reason"):
            log({"id": ID, "decision": step, "owner": "A. Lee"}, begun=log(ACCEPT))
    with pytest.raises(InputErrors, match="no condition is open"):
        log({"id": ID, "decision": "confirm", **SIGNED}, begun=log(ACCEPT))
    assert not read(log(ACCEPT, {"id": ID, "decision": "withdraw", **SIGNED})).entries


ANSWERED = {**ACCEPT, "row": ID, "answers": {"processor": "DMS 12", "joint": "none"}}
OF_BEFORE = (  # an answer stood in the reason
    '{"account":{"user":"alice@desk"},"before":[],"decision":{"decision":"accept","owner":"A. Lee","reason":"agreed '
    'Where is the contract (Article 28)? DMS 12","row":"d8fe0ef97d4b673d"},"hash":'
    '"2735270892387e809193edf8381bd250e1c6dfdc87f039a772fd2f66728e335b","log":1,"section":"findings",'
    '"when":"2026-11-28T12:00:00Z"}\n'
)


def test_answers_are_held_by_the_hash_and_read_back() -> None:
    text = log(ANSWERED, {**ANSWERED, "answers": {"processor": "DMS 13"}})
    (entry,) = read(text).entries
    assert entry.answers == (("processor", "DMS 13"),)
    assert entry.history[0].answers == (("joint", "none"), ("processor", "DMS 12"))
    assert named(text.replace("DMS 12", "DMS 11").encode()) == {1}
    assert not read(log(ANSWERED, ACCEPT)).entries[-1].answers  # not inherited


def test_branches_that_answer_otherwise_decided_otherwise() -> None:
    base = log({"id": OTHER, "decision": "avoid"})
    ours, theirs = log(ANSWERED, begun=base), log({**ANSWERED, "answers": {"processor": "DMS 13"}}, begun=base)
    text, undecided = join(ours, theirs)
    assert len(undecided) == 1
    assert [entry.id for entry in read(text).entries] == [OTHER]
    same, undecided = join(ours, log(ANSWERED, {"id": OTHER, "decision": "delegate"}, begun=base))
    assert (undecided, {entry.answers for entry in read(same).entries if entry.row}) == (
        [], {(("joint", "none"), ("processor", "DMS 12"))},
    )  # fmt: skip


def test_a_log_of_before_is_read_as_it_was_sealed() -> None:
    assert not named(OF_BEFORE.encode())
    (entry,) = read(OF_BEFORE).entries
    assert "DMS 12" in entry.reason
    assert not entry.answers
    assert not named(log({**ANSWERED, "row": entry.row}, begun=OF_BEFORE).encode(), head(OF_BEFORE))


def test_nothing_is_added_to_a_log_that_was_changed() -> None:
    with pytest.raises(InputErrors, match="was changed"):
        log({"id": OTHER, "decision": "avoid"}, begun=log(ACCEPT).replace("A. Lee", "B. Lee"))


def join(ours: str, theirs: str) -> tuple[str, list[str]]:
    return merged("ours", ours.encode(), "theirs", theirs.encode(), FACTS)


def test_branches_join_and_their_entries_stay_as_they_were() -> None:
    base = log(ACCEPT)
    ours = log({"id": OTHER, "decision": "avoid"}, begun=base)
    theirs = log({"id": "1" * 16, "decision": "delegate"}, {"id": "2" * 16, "decision": "avoid"}, begun=base)
    text, undecided = join(ours, theirs)
    assert (len(read(text).entries), undecided, named(text.encode(), head(theirs))) == (4, [], set())
    *_, last = read_chain("d", text.encode())
    assert last.before == (head(ours), head(theirs))
    assert join(text, theirs) == (text, [])  # one that is in the other already adds nothing
    assert join(base, ours) == (ours, [])
    again, _ = join(log(ACCEPT, begun=text), log({**ACCEPT, "id": "3" * 16}, begun=text))
    assert not named(again.encode(), head(text))


def test_of_what_branches_decided_differently_nothing_is_decided() -> None:
    base = log({"id": ID, "decision": "mitigate"})
    text, (target,) = join(log(ACCEPT, begun=base), log({"id": ID, "decision": "avoid"}, begun=base))
    assert json.loads(target) == {"id": ID}
    assert not read(text).entries
    assert choices(log(ACCEPT, begun=text)) == {ID: (Choice.ACCEPT, "")}
    same, undecided = join(log(ACCEPT, begun=base), log(ACCEPT, {**ACCEPT, "id": OTHER}, begun=base))
    assert (undecided, len(read(same).entries)) == ([], 2)
    one_side, undecided = join(log(ACCEPT, begun=base), log({"id": OTHER, "decision": "avoid"}, begun=base))
    assert (undecided, choices(one_side)[ID][0]) == ([], Choice.ACCEPT)


def test_logs_of_two_origins_are_not_joined() -> None:
    with pytest.raises(InputErrors, match="begins otherwise"):
        join(log(ACCEPT), log({**ACCEPT, "owner": "B. Lee"}))


SIDES = st.tuples(*(st.lists(DECISION, min_size=1, max_size=3) for _ in range(3)))


@given(SIDES, st.data())
def test_a_change_in_a_log_of_branches_is_named(sides: Iterable[list[dict[str, Any]]], data: st.DataObject) -> None:
    """A byte, an order, an entry that is gone, wherever it stood."""
    first, ours, theirs = sides
    base = log(*first)
    text, _ = join(log(*ours, begun=base), log(*[{**one, "ticket": "T"} for one in theirs], begun=base))
    lines = _lines(text)
    assert not named(text.encode())
    at = data.draw(st.integers(0, len(lines) - 2))
    assert named(b"".join([*lines[:at], *lines[at + 1 :]]))
    assert named(b"".join([*lines[:at], lines[at + 1], lines[at], *lines[at + 2 :]]))
    line = bytearray(lines[at])
    line[data.draw(st.integers(0, len(line) - 1))] ^= data.draw(st.integers(1, 255))
    assert at + 1 in named(b"".join([*lines[:at], bytes(line), *lines[at + 1 :]]))


JSON = st.recursive(
    st.none() | st.booleans() | st.integers(-9, 9) | st.floats(allow_nan=False, allow_infinity=False) | st.text(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(), inner, max_size=3),
    max_leaves=6,
)
KEYS = (
    "id",
    "row",
    "answers",
    "decision",
    "robots",
    "from_robots",
    "pseudonymised",
    "doubt",
    "legal_basis",
    "made_about",
    "expires",
)
ANY = st.dictionaries(st.sampled_from(KEYS), JSON | st.sampled_from([ID, "accept", "confirm", ["a"]]), max_size=6)


@given(st.lists(st.tuples(st.sampled_from(SECTIONS), ANY), min_size=1, max_size=4), st.dictionaries(st.text(), JSON))
def test_whatever_somebody_seals_is_read_or_refused(decided: Any, account: dict[str, Any]) -> None:
    """With right hashes, which anybody can compute."""
    entries: list[ChainEntry] = []
    for section, decision in decided:
        facts = {**FACTS, "account": account, "section": section, "decision": decision}
        entries.append(sealed(facts, [heads(entries)] if entries else []))
    with suppress(InputErrors):
        read(log_text(entries))


@given(st.binary(max_size=200))
def test_any_bytes_are_read_or_refused(data: bytes) -> None:
    assert named(data)
