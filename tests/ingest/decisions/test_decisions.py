"""Decisions (S10, S12): which holds for which finding, until when, what it does not hide, what it lacks."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any

import jsonschema
import pytest

from rosprivacy.analysis.case import Case
from rosprivacy.analysis.decisions import Choice, Decisions, State
from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.analysis.model import Element
from rosprivacy.clock import today
from rosprivacy.ingest.decisions.decisions_file import parse_decisions
from rosprivacy.ontology.vocabulary import load
from tests.helpers.command import XI, Cli, refused, run
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

CARE: list[str | Path] = [
    ROOT / "examples/care-home/care-home.policy.xml",
    "-l",
    ROOT / "examples/care-home/care-home.labels.yaml",
]
SIGNED = "reason: why, owner: who, legal_basis: ['6(1)(f)', '9(2)(a)']"
ID = "0123456789abcdef"


# ---------------------------------------------------------------- which decision holds


def case(category: str = "Video", source: str = "/camera", leak: str = "/cloud", **more: Any) -> Case:
    facts = {"id": ID, "kind": "disclosure", "pseudonymised": False, **more}
    return Case(category=category, source=Element("node", source, "r1"), leak=Element("node", leak), **facts)


def decisions(*entries: str, day: str = "2026-11-20") -> Decisions:
    text = "decisions: 1\nfindings:\n" + "".join(f"- {{{entry}, reason: why, owner: who}}\n" for entry in entries)
    return parse_decisions("d.yaml", text, load(), day)


@pytest.mark.parametrize(
    ("entry", "about"),
    [
        (f"id: {ID}", True),
        ("id: fedcba9876543210", False),
        ("category: Video", True),
        ("category: PersonalData", True),  # stands for the narrower ones
        ("category: FaceImage", False),
        ("source: /camera", True),
        ("source: /cam", False),
        ("source: '/cam*'", True),
        ("leak: '/c[!l]*'", False),
        ("leak: '/c[^a]*'", True),
        ("leak: '*', robot: 'r?'", True),
        ("leak: '*', robot: r2", False),
        ("category: Video, kind: disclosure", True),
        ("category: Video, kind: storage-limitation", False),
        ("category: Video, pseudonymised: true", False),  # it arrives as it is
        ("category: Video, pseudonymised: false", True),
        (f"id: {ID}, category: Health", False),  # all that it says must hold
    ],
)
def test_what_a_decision_is_about(entry: str, about: bool) -> None:  # noqa: FBT001 - a column of the table
    assert decisions(f"{entry}, decision: accept").accepts(case()) == about


@pytest.mark.parametrize(
    ("entries", "choice"),
    [
        (["category: Video, decision: accept", f"id: {ID}, decision: mitigate"], Choice.MITIGATE),  # an id outranks
        (["leak: '/cl*', decision: accept", "leak: /cloud, decision: avoid"], Choice.AVOID),  # a name a glob
        (["leak: '/*', decision: accept", "leak: '/cl*', decision: avoid"], Choice.AVOID),  # the longer the shorter
        (["category: PersonalData, decision: accept", "category: Video, decision: delegate"], Choice.DELEGATE),
        (["source: /camera, decision: accept", "source: /camera, leak: /cloud, decision: avoid"], Choice.AVOID),
        (["category: Video, decision: accept", "category: Video, pseudonymised: false, decision: avoid"], Choice.AVOID),
        (["leak: /cloud, decision: accept", "source: /camera, decision: accept"], Choice.ACCEPT),  # they agree
    ],
)
@pytest.mark.parametrize("order", [1, -1])
def test_the_decision_that_spells_out_more_counts(entries: Sequence[str], choice: Choice, order: int) -> None:
    found = decisions(*entries[::order]).on(case())
    assert found is not None
    assert found.choice is choice


def test_a_decision_is_valid_to_the_end_of_its_last_day() -> None:
    entry = f"id: {ID}, decision: accept, expires: 2026-11-20"
    assert decisions(entry, day="2026-11-20").accepts(case())
    assert not decisions(entry, day="2026-11-21").accepts(case())


def test_an_expired_decision_about_a_finding_is_not_replaced_by_one_about_more() -> None:
    """A person decided on this very finding for a time: now a person has to look again."""
    entries = ("category: Video, decision: accept", f"id: {ID}, decision: accept, expires: 2026-01-01")
    assert not decisions(*entries).accepts(case())
    assert decisions(entries[0]).accepts(case())


def test_a_range_that_runs_backwards_accepts_nothing_more() -> None:
    """As in policies and labels: Python's ``fnmatch`` reads ``[d-c!x]loud`` as ``[!x]loud``."""
    signed = "decision: accept"
    assert not decisions(f"leak: '/[d-c!x]loud', {signed}").accepts(case())
    assert decisions(f"leak: '/[c!x]loud', {signed}").accepts(case())


def test_decisions_of_one_rank_that_differ_accept_nothing() -> None:
    found = decisions("leak: /cloud, decision: accept", "source: /camera, decision: mitigate")
    assert found.on(case()) is None
    assert not found.accepts(case())


# ---------------------------------------------------------------- the file


WHOLE = [  # line, text, words of the message
    (1, "", "the file is empty"),
    (1, "[]", "a decisions file is a map, not a list"),
    (1, "findings: []", "no 'decisions: 1'"),
    (1, "decisions: 2", "decisions format '2'"),
    (2, "decisions: 1\nfinding: []", "unknown key 'finding'; did you mean 'findings'?"),
    (2, "decisions: 1\nfindings: x", "findings takes a list, not a text"),
    (2, "decisions: 1\nfindings: [x]", "a decision is a map, not a text"),
]
ENTRIES = [  # what an entry says, words of the message
    (f"id: {ID}", "no decision"),
    (f"id: {ID}, decision: acept", "decision 'acept'; did you mean accept?"),
    (f"id: {ID}, decision: accept, owner: me", "an acceptance without reason"),
    (f"id: {ID}, decision: accept, reason: so", "an acceptance without owner"),
    ("id: 7ac, decision: avoid", "id '7ac'"),
    ("id: 0x12345678abcdef, decision: avoid", "id '0x12345678abcdef'"),
    ("decision: avoid", "a decision about everything"),
    ("decision: avoid, kind: disclosure", "a decision about everything"),
    ("category: Vidio, decision: avoid", "unknown category 'Vidio'; did you mean Video or Voice?"),
    ("category: qqqqqq, decision: avoid", "unknown category 'qqqqqq'; rosprivacy categories lists all of them"),
    (f"id: {ID}, decision: avoid, expires: 2026-02-30", "expires '2026-02-30'"),
    (f"id: {ID}, decision: avoid, expires: tomorrow", "expires 'tomorrow'"),
    (f"id: {ID}, decision: avoid, expires: ", "expires 'empty'"),
    (f"id: {ID}, decision: avoid, legal_basis: consent", "legal basis 'consent'"),
    (f"id: {ID}, decision: avoid, legal_basis: [6(1)(z)]", "legal basis '6(1)(z)'"),
    (f"id: {ID}, decision: avoid, legal_basis: [48]", "legal basis '48'"),
    (f"id: {ID}, decision: avoid, pseudonymised: maybe", "pseudonymised takes"),
    (f"id: {ID}, decision: avoid, reason: ''", "reason takes text"),
    (f"id: {ID}, decision: avoid, owner: {{a: b}}", "owner takes text"),
    (f"id: {ID}, decision: avoid, answers: yes", "answers are a map, not"),
    (f"id: {ID}, decision: avoid, answers: {{procesor: x}}", "unknown key 'procesor'; did you mean 'processor'?"),
    (f"id: {ID}, decision: avoid, answers: {{processor: ''}}", "processor takes text"),
    (f"id: {ID}, decision: avoid, resaon: x", "unknown key 'resaon'"),
    (f"id: {ID}, decision: avoid}}\n- {{id: {ID}, decision: avoid", f"{ID} again, first in line 3"),
    (f"id: {ID}, decision: avoid, reason: {'x' * 10_001}", "reason of 10001"),
]


@pytest.mark.parametrize(
    ("line", "text", "words"),
    WHOLE + [(3 + said.count("\n"), f"decisions: 1\nfindings:\n- {{{said}}}", words) for said, words in ENTRIES],
)
def test_bad_decisions_are_refused_with_their_line(line: int, text: str, words: str) -> None:
    with pytest.raises((InputError, InputErrors)) as caught:
        parse_decisions("d.yaml", text, load(), "")
    assert f"d.yaml:{line}: {words}" in str(caught.value)


def test_all_problems_of_a_decisions_file_are_said_at_once(cli: Cli, tmp_path: Path) -> None:
    """By the command, with the line of each."""
    file = tmp_path / "d.yaml"
    file.write_text("decisions: 1\nfindings:\n- id: x\n- category: Vidio\n  decision: y\n  expires: z\n")
    lines = refused(cli("analyze", *CARE, "--decisions", file))
    assert [line.removeprefix(f"{file}:").partition(":")[0] for line in lines] == ["3", "3", "4", "5", "6"]


@pytest.mark.parametrize("id_", ["1234567812345678", "12345678e1234567"])
def test_an_id_that_yaml_takes_for_a_number_is_an_id(id_: str) -> None:
    text = f"decisions: 1\nfindings:\n- id: {id_}\n  decision: avoid\n"
    assert parse_decisions("d", text, load(), "").entries[0].id == id_


def test_today_can_be_fixed(monkeypatch: pytest.MonkeyPatch, cli: Cli, tmp_path: Path) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    assert today(os.environ) == "1970-01-01"
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "soon")
    (tmp_path / "d.yaml").write_text("decisions: 1")
    assert refused(cli("analyze", *CARE, "--decisions", tmp_path / "d.yaml"))[0].startswith("SOURCE_DATE_EPOCH: ")


# ---------------------------------------------------------------- what a decision does to an answer


def profile(node: str, **topics: str) -> str:
    groups = "".join(f"<topics {role}='ALLOW'><topic>{name}</topic></topics>" for role, name in topics.items())
    return f"<profile ns='/' node='{node}'>{groups}</profile>"


@pytest.fixture
def chain(tmp_path: Path) -> Path:
    """A camera, a relay that leaks, and behind it a cloud that leaks."""
    profiles = profile("camera", publish="a") + profile("relay", subscribe="a", publish="b")
    profiles += profile("cloud", subscribe="b")
    body = f"<enclave path='/e'><profiles>{profiles}</profiles></enclave>"
    (tmp_path / "p.xml").write_text(f"<policy version='0.2.0' {XI}><enclaves>{body}</enclaves></policy>")
    (tmp_path / "l.yaml").write_text(
        "labels: 1\nnodes: {/camera: {source: [Video]}, /relay: {leak: [Video]}, /cloud: {leak: [Video]}}\n"
        "channels: {/a: sensitive, /b: sensitive}\n"
    )
    return tmp_path


def answer(cli: Cli, folder: Path, *entries: str, options: Sequence[str] = ()) -> dict[str, Any]:
    text = "".join(f"- {{{entry}}}\n" for entry in entries)
    (folder / "d.yaml").write_text(f"decisions: 1\nfindings:\n{text}")
    arguments = ("p.xml", "-l", "l.yaml", "--decisions", "d.yaml", "-f", "json1", *options)
    done = cli("analyze", *arguments, cwd=folder)
    assert done.stderr == ""
    document: dict[str, Any] = json.loads(done.stdout)
    schema = json.loads((ROOT / "docs" / "analysis.schema.json").read_text())
    jsonschema.Draft202012Validator(schema).validate(document)
    return document


def findings(document: dict[str, Any]) -> dict[str, tuple[bool, bool]]:
    """Leak -> dismissed, accepted."""
    return {finding["leak"]["name"]: (finding["dismissed"], finding["accepted"]) for finding in document["findings"]}


def test_an_accepted_leak_no_longer_hides_what_lies_behind_it(cli: Cli, chain: Path) -> None:
    """Rule S10."""
    before = answer(cli, chain)
    assert findings(before) == {"/relay": (False, False), "/cloud": (True, False)}
    after = answer(cli, chain, f"leak: /relay, decision: accept, {SIGNED}")
    assert findings(after) == {"/relay": (False, True), "/cloud": (False, False)}
    assert after["verdict"] == "leak"
    both = answer(cli, chain, f"category: Video, decision: accept, {SIGNED}")
    assert findings(both) == {"/relay": (False, True), "/cloud": (False, True)}
    assert both["verdict"] == "no-leak-found"
    for other in ("mitigate", "delegate", "avoid"):
        document = answer(cli, chain, f"leak: /relay, decision: {other}")
        assert findings(document) == findings(before)
        assert document["verdict"] == "leak"


def test_the_document_says_from_which_robot_a_decision_is(cli: Cli, chain: Path) -> None:
    (entry,) = answer(cli, chain, "leak: /relay, from_robot: a, decision: mitigate")["decisions"]
    assert entry["target"] == {"leak": "/relay", "from_robot": "a"}


def test_an_expired_acceptance_counts_no_more_and_shows(cli: Cli, chain: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1800000000")  # 15 January 2027
    document = answer(cli, chain, f"category: Video, decision: accept, expires: 2026-12-31, {SIGNED}")
    assert document["verdict"] == "leak"
    assert findings(document) == {"/relay": (False, False), "/cloud": (True, False)}
    assert {finding["decision"]["state"] for finding in document["findings"]} == {"expired"}
    assert document["assumptions"]["decisions"]["today"] == "2027-01-15"
    (warning,) = document["diagnostics"]
    assert (warning["file"], warning["line"], warning["severity"]) == ("d.yaml", 3, "warning")
    assert "expired on 2026-12-31" in warning["message"]


def test_an_orphaned_decision_shows(cli: Cli, chain: Path) -> None:
    entries = (f"id: {ID}, decision: mitigate", f"leak: /relay, decision: accept, {SIGNED}, expires: 2999-01-01")
    document = answer(cli, chain, *entries)
    assert [entry["state"] for entry in document["decisions"]] == [State.ORPHANED, State.VALID]
    (warning,) = document["diagnostics"]
    assert (warning["line"], "orphaned" in warning["message"]) == (3, True)
    some = answer(cli, chain, *entries, options=("-c", "Health"))  # of what was not asked for, nothing is said
    assert [entry["state"] for entry in some["decisions"]] == [State.VALID, State.VALID]


def test_decisions_that_contradict_each_other_about_a_finding_are_refused(cli: Cli, chain: Path) -> None:
    (chain / "d.yaml").write_text(
        f"decisions: 1\nfindings:\n- {{leak: /relay, decision: accept, {SIGNED}}}\n"
        "- {source: /camera, decision: avoid}\n"
    )
    (line,) = refused(cli("analyze", "p.xml", "-l", "l.yaml", "--decisions", "d.yaml", cwd=chain))
    assert line.startswith("d.yaml:4: to avoid ")
    assert "contradicts line 3: to accept" in line


def test_missing_legal_bases_are_flagged_where_a_category_is_special(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "d.yaml"
    file.write_text(
        "decisions: 1\nfindings:\n"
        "- {category: FaceTemplate, decision: accept, reason: why, owner: who, legal_basis: [Art. 6(1)(a)]}\n"
        "- {category: Voice, decision: accept, reason: why, owner: who}\n"
    )
    document = json.loads(cli("analyze", *CARE, "--decisions", file, "-f", "json1").stdout)
    said = sorted((d["line"], d["message"]) for d in document["diagnostics"] if d["file"] == str(file))
    assert [line for line, _ in said] == [3, 3, 4, 4, 4]  # and neither has an end
    for words in ("FaceTemplate can fall under", "under Article 6(1)", "Voice may reveal"):
        assert len([message for _, message in said if words in message]) == 1


def test_an_acceptance_of_pseudonymised_data_ends_when_it_arrives_as_it_is(cli: Cli, chain: Path) -> None:
    """The id is the same, so only the form tells."""
    labels = (chain / "l.yaml").read_text()
    hidden = labels.replace("/relay: {leak: [Video]}", "/relay: {sanitizer: {Video: pseudonymise}}")
    (chain / "l.yaml").write_text(hidden)
    entry = f"category: Video, pseudonymised: true, decision: accept, {SIGNED}"
    assert findings(answer(cli, chain, entry)) == {"/cloud": (False, True)}
    (chain / "l.yaml").write_text(labels.replace("/relay: {leak: [Video]}", "/relay: conduit"))
    document = answer(cli, chain, entry)
    assert findings(document) == {"/cloud": (False, False)}
    assert document["verdict"] == "leak"


ACCEPT_RELAY = f"leak: /relay, decision: accept, {SIGNED}"
MITIGATE_CLOUD = "leak: /cloud, decision: mitigate"
ACCEPT_ALL = f"category: Video, decision: accept, {SIGNED}"


@pytest.mark.parametrize(
    ("entries", "codes"),
    [  # never, undecided, leak, undetermined
        ([], (0, 1, 1, 1)),
        ([ACCEPT_RELAY], (0, 1, 1, 1)),  # the cloud is open now
        ([ACCEPT_RELAY, MITIGATE_CLOUD], (0, 0, 1, 1)),
        ([ACCEPT_ALL], (0, 0, 0, 0)),
        (["category: Video, decision: delegate"], (0, 0, 1, 1)),
        ([ACCEPT_ALL.replace("accept,", "accept, expires: 2020-01-01,")], (0, 1, 1, 1)),
    ],
)
def test_fail_on_looks_at_what_is_decided(cli: Cli, chain: Path, entries: list[str], codes: tuple[int, ...]) -> None:
    answer(cli, chain, *entries)
    levels = ("never", "undecided", "leak", "undetermined")
    arguments = ("analyze", "p.xml", "-l", "l.yaml", "--decisions", "d.yaml", "--fail-on")
    assert tuple(cli(*arguments, level, cwd=chain).returncode for level in levels) == codes


def test_mitigate_leaves_accepted_findings_alone(cli: Cli, chain: Path) -> None:
    answer(cli, chain, ACCEPT_RELAY)
    done = cli("mitigate", "p.xml", "-l", "l.yaml", "--decisions", "d.yaml", "-f", "json", cwd=chain)
    (proposal,) = json.loads(done.stdout)["proposals"]
    (step,) = proposal["steps"]
    assert [(one["from"]["name"], one["to"]["name"]) for one in step["between"]] == [("/b", "/cloud")]
    assert proposal["proven"]


def test_the_same_decisions_give_the_same_bytes_on_the_same_day(chain: Path) -> None:  # S14
    (chain / "d.yaml").write_text(f"decisions: 1\nfindings:\n- {{{ACCEPT_RELAY}}}\n")
    arguments = ("analyze", "p.xml", "-l", "l.yaml", "--decisions", "d.yaml", "-f", "json1")
    seeds = ("0", "1")
    assert len({run(*arguments, cwd=chain, PYTHONHASHSEED=s, SOURCE_DATE_EPOCH="0").stdout for s in seeds}) == 1
