"""``rosprivacy decide`` writes a decision and keeps what people wrote: comments, order, other decisions."""

from __future__ import annotations

import json
import re
from collections import Counter
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.model import Place
from rosprivacy.ingest.decisions.decision_writer import with_decision
from rosprivacy.ingest.decisions.decisions_file import parse_decisions
from rosprivacy.ontology.vocabulary import load
from tests.helpers.command import Cli, refused
from tests.helpers.factory import BEFORE, RUN3

if TYPE_CHECKING:
    from pathlib import Path

VOCABULARY = load()
ID, OTHER = "7ac677bf059b5beb", "0123456789abcdef"
SIGNED = ("--reason", "needed for safety", "--owner", "A. Person", "--legal-basis", "6(1)(f)")


NOT_CHECKED = "the ids were not checked; --report FILE checks them against an analysis\n"


def decide(cli: Cli, folder: Path, *arguments: str) -> str:
    done = cli("decide", *arguments, "--decisions", "decisions.yaml", cwd=folder)
    checked = bool({"--report", "--category", "--leak"} & {*arguments})
    assert (done.returncode, NOT_CHECKED in done.stderr) == (0, not checked)
    return (folder / "decisions.yaml").read_text("utf-8")


@pytest.fixture
def report(cli: Cli, tmp_path: Path) -> Path:
    file = tmp_path / "report.json"
    cli("analyze", BEFORE, "-l", RUN3, "-f", "json", "-o", file)
    return file


def test_a_first_decision_makes_the_file(cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1790000000")
    text = decide(cli, tmp_path, "accept", ID, *SIGNED, "--expires", "2027-06-30")
    assert text == (
        "# What was decided about findings of rosprivacy: accept, mitigate, delegate or avoid.\n"
        "decisions: 1\n"
        "findings:\n"
        f"- id: {ID}\n"
        "  decision: accept\n"
        "  reason: needed for safety\n"
        "  owner: A. Person\n"
        "  legal_basis:\n"
        "  - 6(1)(f)\n"
        "  date: 2026-09-21\n"
        "  expires: 2027-06-30\n"
    )


def test_what_is_decided_counts_in_the_next_answer(cli: Cli, tmp_path: Path, report: Path) -> None:
    """With a report the beginning of an id does, and a reader of the file sees what it is about."""
    text = decide(cli, tmp_path, "accept", ID[:6], "--report", str(report), *SIGNED)
    assert f"- id: {ID}  # Video: /safety_camera -> /archive_server\n" in text
    done = cli("analyze", BEFORE, "-l", RUN3, "--decisions", tmp_path / "decisions.yaml")
    assert done.returncode == 4
    assert done.stdout.startswith("undetermined: no leak reached but what is accepted")


def test_a_pattern_is_a_decision_too(cli: Cli, tmp_path: Path) -> None:
    """A second one on it takes its place."""
    pattern = ("--category", "Video", "--leak", "/archive*")
    decide(cli, tmp_path, "avoid", *pattern)
    text = decide(cli, tmp_path, "mitigate", *pattern, "--ticket", "PRIV-7")
    (entry,) = yaml.safe_load(text)["findings"]
    assert {k: v for k, v in entry.items() if k not in ("date", "history")} == {
        "category": "Video", "leak": "/archive*", "decision": "mitigate", "ticket": "PRIV-7",
    }  # fmt: skip


WRITTEN = f"""\
---
# Decisions of the safety board.
# Ask before you change them.
decisions: 1   # the format

findings:
  # the archive: see the minutes of May
  - id: {OTHER}          # a finding
    decision: mitigate   # until autumn
    reason: "the filter is ordered"
    note: >-
      a long
      story

  # patterns
  - leak: '/cloud*'
    decision: avoid
# the end
"""


def test_comments_order_and_layout_stay(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "decisions.yaml"
    file.write_text(WRITTEN)
    text = decide(cli, tmp_path, "accept", ID, *SIGNED)
    lines = text.splitlines()
    assert [line for line in lines if line in WRITTEN.splitlines()] == WRITTEN.splitlines()  # all of them, in order
    entries = yaml.safe_load(text)["findings"]
    assert [entry.get("id", entry.get("leak")) for entry in entries] == [OTHER, "/cloud*", ID]


def test_an_entry_that_is_there_is_changed_where_it_stands(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "decisions.yaml"
    file.write_text(WRITTEN)
    text = decide(cli, tmp_path, "accept", OTHER, "--owner", "B. Person", "--reason", "a blind spot")
    first, second = yaml.safe_load(text)["findings"]
    assert (first["decision"], first["owner"], first["note"]) == ("accept", "B. Person", "a long story")
    assert first["history"][0]["reason"] == "the filter is ordered"
    assert second["leak"] == "/cloud*"
    for comment in re.findall(r"#.*", WRITTEN):
        assert comment in text


@pytest.mark.parametrize(
    "text",
    [
        "decisions: 1\n",
        "decisions: 1\nfindings:\n",
        "decisions: 1\nfindings: []  # none yet\n",
        "{decisions: 1, findings: []}\n",
        f'{{"decisions": 1, "findings": [{{"id": "{OTHER}", "decision": "avoid"}}]}}\n',
        f"decisions: 1\nfindings: [{{id: {OTHER}, decision: avoid}}]  # short\n",
        f"decisions: 1\r\nfindings:\r\n- id: {OTHER}  # a\r\n  decision: avoid\r\n",
        f"decisions: 1\nfindings:\n- decision: avoid\n  id: {OTHER}",  # no line feed at the end
        "findings:\n# nothing yet\ndecisions: 1\n",
        "\ufeffdecisions: 1\n",
    ],
)
def test_other_ways_to_write_the_file_are_taken(cli: Cli, tmp_path: Path, text: str) -> None:
    file = tmp_path / "decisions.yaml"
    file.write_bytes(text.encode())
    decide(cli, tmp_path, "accept", ID, *SIGNED)
    after = file.read_bytes().decode()
    entries = parse_decisions("d", after, VOCABULARY, "").entries
    assert entries[-1].id == ID
    assert [entry.id for entry in entries[:-1]] == ([OTHER] if OTHER in text else [])
    assert ("\r\n" in text) == ("\r\n" in after)
    for comment in re.findall(r"#[^\r\n]*", text):
        assert comment in after


COMMENTS = st.sampled_from(["", "  # a", " # b: c", "  # - d"])
LINES = st.sampled_from(["", "# whole", "  # indented", "#"])
ENTRY = st.fixed_dictionaries(
    {
        "id": st.from_regex("[0-9a-f]{16}", fullmatch=True),
        "decision": st.sampled_from(["mitigate", "delegate", "avoid"]),
    },
    optional={
        "reason": st.sampled_from(["plain", "'# quoted'", '"two: parts"', "ü – ẞ", "'yes'", "'12'"]),
        "owner": st.sampled_from(["me", "A: B".replace(": ", " "), '"x"']),
        "expires": st.sampled_from(["2030-01-31", "'2031-12-01'"]),
        "legal_basis": st.sampled_from(["[6(1)(f)]", "6(1)(c)", "[Art. 6(1)(a), '9(2)(h)']"]),
        "note": st.sampled_from(["text", "|\n      several\n      # no comment\n      lines"]),
    },
)


@st.composite
def files(draw: st.DrawFn) -> str:
    """Decisions files as people write them: two ways to indent, comments anywhere."""
    indent = draw(st.sampled_from(["", "  "]))
    rows = [draw(LINES), f"decisions: 1{draw(COMMENTS)}", draw(LINES), f"findings:{draw(COMMENTS)}"]
    for entry in draw(st.lists(ENTRY, max_size=4, unique_by=lambda entry: entry["id"])):
        rows.append(draw(LINES))
        for number, (key, value) in enumerate(entry.items()):
            comment = "" if "\n" in value else draw(COMMENTS)
            shown = value if key != "id" else f"'{value}'"
            rows.append(f"{indent}{'- ' if not number else '  '}{key}: {shown}{comment}")
    return "\n".join([*rows, draw(LINES), ""])


@given(files(), ENTRY)
def test_nothing_that_people_wrote_is_lost(text: str, entry: dict[str, str]) -> None:
    before = parse_decisions("d", text, VOCABULARY, "").entries
    new: dict[str, Any] = {"id": entry["id"], "decision": "accept", "reason": "r", "owner": "o"}
    after = with_decision("d", text, new, "Video: /a -> /b", VOCABULARY)
    entries = parse_decisions("d", after, VOCABULARY, "").entries
    nowhere = Place("", 0)
    others = [replace(e, place=nowhere) for e in before if e.id != entry["id"]]
    assert [replace(e, place=nowhere) for e in entries if e.id != entry["id"]] == others
    (mine,) = (e for e in entries if e.id == entry["id"])
    assert (mine.choice, mine.reason, mine.owner) == ("accept", "r", "o")
    lines = Counter(line.strip() for line in text.splitlines() if line.strip().startswith("#"))
    assert not lines - Counter(line.strip() for line in after.splitlines())
    assert with_decision("d", after, new, "", VOCABULARY) == after  # the second time changes nothing


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["accept", ID], "an acceptance without reason"),
        (["accept", "xyz", *SIGNED], "'xyz' is not the id"),
        (
            ["mitigate", ID[:4]],
            f"'{ID[:4]}' is not the id of a finding; write its 16 digits and letters",
        ),
        (["delegate", ID, "nope"], "'nope' is not the id"),  # and the first is not decided either
        (["avoid", ID, "--legal-basis", "consent"], "legal basis 'consent'"),
        (["avoid", "--category", "Vidio"], "unknown category 'Vidio'"),
        (["avoid", ID, "--reason", " "], "reason takes text"),
        (["avoid", ID, "--expires", "2020-01-01"], "2020-01-01 is over: it would decide nothing"),
        (["avoid", "--leak", "/x", "--expires", "soon"], "'soon' is not a date"),
        (["avoid"], "Usage:"),
        (["avoid", ID, "--leak", "/a"], "Usage:"),
        (["forget", ID], "Usage:"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_what_is_no_decision_is_refused_and_nothing_is_written(
    cli: Cli, tmp_path: Path, arguments: list[str], message: str
) -> None:
    done = cli("decide", *arguments, cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert message in " ".join(done.stderr.replace("│", "").split())
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("text", ["", "decisions: 2\n", "decisions: 1\nfindings: &a []\n", "a: [", "\xff\n"])
def test_a_file_that_is_no_decisions_file_is_left_as_it_is(cli: Cli, tmp_path: Path, text: str) -> None:
    file = tmp_path / "decisions.yaml"
    file.write_bytes(text.encode("latin-1"))
    refused(cli("decide", "avoid", ID, cwd=tmp_path))
    assert file.read_bytes() == text.encode("latin-1")


def test_an_id_that_the_report_does_not_have_is_refused(cli: Cli, tmp_path: Path, report: Path) -> None:
    (line,) = refused(cli("decide", "avoid", OTHER, "--report", report, cwd=tmp_path))
    assert f"'{OTHER}' is no finding and no doubt of the report; copy one: {ID}" in line
    for text in ("{}", "[]", "nothing", json.dumps({"findings": [1]})):
        report.write_text(text)
        refused(cli("decide", "avoid", ID, "--report", report, cwd=tmp_path))
    refused(cli("decide", "avoid", ID, "--report", tmp_path / "absent.json", cwd=tmp_path))
    assert not (tmp_path / "decisions.yaml").exists()


def test_a_decision_about_pseudonymised_data_says_so(cli: Cli, tmp_path: Path, report: Path) -> None:
    """So that it ends when the data arrives as it is."""
    report.write_text(report.read_text().replace('"pseudonymised": false', '"pseudonymised": true'))
    text = decide(cli, tmp_path, "accept", ID, "--report", str(report), *SIGNED)
    assert yaml.safe_load(text)["findings"][0]["pseudonymised"] is True


def test_the_file_keeps_its_rights_and_its_link(cli: Cli, tmp_path: Path) -> None:
    real = tmp_path / "kept" / "real.yaml"
    real.parent.mkdir()
    real.write_text("decisions: 1\n")
    real.chmod(0o640)
    (tmp_path / "decisions.yaml").symlink_to(real)
    decide(cli, tmp_path, "avoid", ID)
    assert (tmp_path / "decisions.yaml").is_symlink()
    assert real.stat().st_mode & 0o777 == 0o640
    assert ID in real.read_text()


def test_what_is_decided_anew_inherits_no_end(cli: Cli, tmp_path: Path) -> None:
    """Who decides anew says until when, on which basis, and where the work is tracked; or nobody does."""
    decide(cli, tmp_path, "accept", ID, *SIGNED, "--expires", "2999-01-01", "--ticket", "PRIV-7")
    text = decide(cli, tmp_path, "accept", ID, "--reason", "as before", "--owner", "B. Person")
    (entry,) = yaml.safe_load(text)["findings"]
    assert not entry.keys() & {"expires", "ticket", "legal_basis"}
    assert entry["history"][0]["ticket"] == "PRIV-7"


def test_several_findings_are_decided_at_once(cli: Cli, tmp_path: Path) -> None:
    text = decide(cli, tmp_path, "avoid", ID, OTHER)
    assert [entry["id"] for entry in yaml.safe_load(text)["findings"]] == [ID, OTHER]


def test_what_was_decided_before_stays_in_the_file(cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1790000000")
    decide(cli, tmp_path, "accept", ID, *SIGNED)
    decide(cli, tmp_path, "accept", ID, *SIGNED)  # says nothing new
    text = decide(cli, tmp_path, "mitigate", ID, "--ticket", "PRIV-7")
    (entry,) = yaml.safe_load(text)["findings"]
    (earlier,) = entry["history"]
    assert (entry["decision"], entry["ticket"]) == ("mitigate", "PRIV-7")
    assert (earlier["decision"], earlier["reason"], earlier["owner"]) == ("accept", "needed for safety", "A. Person")
    text = decide(cli, tmp_path, "delegate", ID, "--owner", "B. Person")
    (entry,) = yaml.safe_load(text)["findings"]
    assert [one["decision"] for one in entry["history"]] == ["accept", "mitigate"]
    (read,) = parse_decisions("decisions.yaml", text, VOCABULARY, "").entries
    assert (str(read.choice), read.owner) == ("delegate", "B. Person")
