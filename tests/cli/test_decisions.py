"""``rosprivacy decisions``: a log is shown, verified, signed, joined by git, begun from an old file; none is lost."""

from __future__ import annotations

import json
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest
import yaml

from tests.helpers.command import Cli, refused
from tests.helpers.factory import BEFORE, RUN3
from tests.helpers.full_disk import full_disk

if TYPE_CHECKING:
    from pathlib import Path

ID, OTHER = "7ac677bf059b5beb", "0123456789abcdef"
SIGNED = ("--reason", "needed for safety", "--owner", "A. Person", "--legal-basis", "6(1)(f)")
PROGRAM = (sys.executable, "-m", "rosprivacy")


@pytest.fixture
def folder(cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a log of two entries."""
    monkeypatch.chdir(tmp_path)
    cli("analyze", BEFORE, "-l", RUN3, "-f", "json", "-o", "r.json")
    accept = ("accept", ID[:6], "--report", "r.json", "--expires", "2999-01-01")
    assert cli("decide", *accept, *SIGNED).returncode == 0
    assert cli("decide", "avoid", OTHER).returncode == 0
    return tmp_path


def entries(log: Path) -> list[dict[str, object]]:
    return [json.loads(line) for line in log.read_text("utf-8").splitlines()]


def head(cli: Cli) -> str:
    return cli("decisions", "show", "--head").stdout.strip()


def test_an_entry_says_who_wrote_it_when_and_what_was_there(
    cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    subprocess.run(["git", "init", "-q"], check=True)
    for key, value in (("user.name", "A. Person"), ("user.email", "a@example.org")):
        subprocess.run(["git", "config", key, value], check=True)
    cli("analyze", BEFORE, "-l", RUN3, "-f", "json", "-o", "r.json")
    done = cli("decide", "approve", ID[:6], "--report", "r.json", *SIGNED, SOURCE_DATE_EPOCH="1790000000")
    assert done.returncode == 0
    (entry,) = entries(tmp_path / "decisions.jsonl")
    assert (entry["when"], entry["before"]) == ("2026-09-21T14:13:20Z", [])
    account, about, decision = entry["account"], entry["about"], entry["decision"]
    assert isinstance(account, dict)
    assert isinstance(about, dict)
    assert isinstance(decision, dict)
    assert account["git"] == "A. Person <a@example.org>"
    assert account["user"]
    assert (decision["decision"], decision["id"], decision["owner"]) == ("accept", ID, "A. Person")
    document = json.loads((tmp_path / "r.json").read_text("utf-8"))
    assert about["law"] == document["assumptions"]["law_as_of"]
    assert {len(about[key]) for key in ("finding", "policies", "labels")} == {64}


@pytest.mark.usefixtures("folder")
def test_what_is_decided_counts_and_its_history_is_in_the_report(cli: Cli) -> None:
    cli("decide", "accept", ID, "--reason", "as before", "--owner", "B. Person", "--expires", "2998-01-01")
    document = json.loads(cli("analyze", BEFORE, "-l", RUN3, "--decisions", "decisions.jsonl", "-f", "json1").stdout)
    assert document["assumptions"]["decisions"]["head"] == head(cli)
    decision = next(f["decision"] for f in document["findings"] if f["id"] == ID)
    steps = [(step["decision"], step["owner"], step["expires"]) for step in decision["history"]]
    assert steps == [("accept", "A. Person", "2999-01-01"), ("accept", "B. Person", "2998-01-01")]
    text = cli("report", BEFORE, "-l", RUN3, "--decisions", "decisions.jsonl", "-f", "markdown").stdout
    assert head(cli) in text
    assert all(step["hash"][:16] in text for step in decision["history"])


def test_a_changed_log_is_named_and_decides_nothing(cli: Cli, folder: Path) -> None:
    log = folder / "decisions.jsonl"
    log.write_text(log.read_text("utf-8").replace("A. Person", "M. Mallory"), "utf-8")
    done = cli("decisions", "verify")
    assert (done.returncode, done.stderr.startswith("decisions.jsonl:1: ")) == (1, True)
    (line,) = refused(cli("analyze", BEFORE, "-l", RUN3, "--decisions", "decisions.jsonl"))
    assert line.startswith("decisions.jsonl:1: ")
    before = log.read_bytes()
    refused(cli("decide", "avoid", OTHER))
    assert log.read_bytes() == before


def test_a_cut_end_is_named_against_a_head_and_is_not_known_without(cli: Cli, folder: Path) -> None:
    log, earlier = folder / "decisions.jsonl", head(cli)
    log.write_bytes(log.read_bytes().splitlines(keepends=True)[0])
    assert cli("decisions", "verify", "--head", earlier).returncode == 1
    done = cli("decisions", "verify")
    assert (done.returncode, "--head" in done.stdout) == (0, True)
    assert cli("decisions", "verify", "--head", head(cli)[:16]).returncode == 0
    assert cli("decisions", "verify", "--head", "abc").returncode == 2
    assert cli("decisions", "verify", "nowhere.jsonl").returncode == 2


@pytest.mark.usefixtures("folder")
def test_a_condition_leaves_a_leak_until_it_is_confirmed(cli: Cli) -> None:
    def code() -> int:
        return cli("analyze", BEFORE, "-l", RUN3, "--decisions", "decisions.jsonl", "-q").returncode

    assert code() == 4  # accepted, and not all is reviewed
    assert cli("decide", "accept-on-condition", ID, *SIGNED).returncode == 2
    assert cli("decide", "accept-on-condition", ID, *SIGNED, "--condition", "a contract").returncode == 0
    assert code() == 1
    assert cli("decide", "confirm", ID, "--owner", "B. Person", "--reason", "signed on 1 May").returncode == 0
    assert code() == 4
    assert cli("decide", "withdraw", ID, "--owner", "B. Person", "--reason", "it ended").returncode == 0
    assert code() == 1
    assert cli("decide", "confirm", ID, *SIGNED, "--decisions", "d.yaml").returncode == 2


@pytest.mark.usefixtures("folder")
def test_an_acceptance_without_an_end_or_a_ground_is_told_before_it_is_written(cli: Cli) -> None:
    done = cli("decide", "accept", ID, "--report", "r.json", "--reason", "r", "--owner", "o")
    assert done.returncode == 0
    assert len([line for line in done.stderr.splitlines() if ID in line]) == 3  # Article 6, what may reveal, no end
    assert cli("decide", "accept", ID, "--report", "r.json", *SIGNED, "--expires", "2999-01-01").stderr.count(ID) == 1


def test_an_old_file_is_taken_over_with_its_history(cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "decisions.yaml").write_text(
        f"decisions: 1\nfindings:\n- id: {ID}  # Video\n  decision: accept\n  reason: why\n  owner: who\n"
        "  expires: 2999-01-01\n  legal_basis: [Art. 6(1)(f)]\n  answers: {processor: DMS 12}\n"
        "  history:\n  - {decision: mitigate, owner: me}\n"
        "  made_about: {view: declared, path: [/a, /b], disjoint_paths: 2}\n"
        "- {category: Video, leak: '/cloud*', pseudonymised: true, decision: avoid}\n"
        "doubts:\n- {doubt: no-reader, decision: accept, reason: r, owner: o, expires: 2999-01-01}\n",
        "utf-8",
    )
    assert cli("decisions", "take-over", "decisions.yaml").returncode == 0
    both = []
    for file in ("decisions.yaml", "decisions.jsonl"):
        done = cli("analyze", BEFORE, "-l", RUN3, "--decisions", file, "-f", "json1")
        document = json.loads(done.stdout)
        rows = [{k: v for k, v in row.items() if k not in ("file", "line", "history")} for row in document["decisions"]]
        both.append((done.returncode, document["verdict"], rows))
    assert both[0] == both[1]
    assert both[0][2][0]["answers"] == {"processor": "DMS 12"}
    assert [entry["decision"]["decision"] for entry in entries(tmp_path / "decisions.jsonl")] == [  # type: ignore[index]
        "mitigate", "accept", "avoid", "accept",
    ]  # fmt: skip
    (line,) = refused(cli("decisions", "take-over", "decisions.yaml"))  # a log is never replaced
    assert line.startswith("decisions.jsonl: is there already")
    assert cli("decisions", "take-over", "decisions.yaml", "-o", "log.yaml").returncode == 2


def test_git_joins_the_logs_of_two_branches(cli: Cli, folder: Path) -> None:
    """By the line of the documentation."""

    def git(*words: str) -> None:
        subprocess.run(["git", "-c", "user.name=A", "-c", "user.email=a@b.c", *words], check=True, capture_output=True)

    git("init", "-q", "-b", "main")
    git("config", "merge.rosprivacy.driver", f"{' '.join(PROGRAM)} decisions merge %A %B")
    (folder / ".gitattributes").write_text("*.jsonl merge=rosprivacy\n")
    git("add", ".")
    git("commit", "-qm", "begun")
    git("checkout", "-qb", "other")
    for branch, decided in (("other", "1" * 16), ("main", "2" * 16)):
        git("checkout", "-q", branch)
        assert cli("decide", "delegate", decided).returncode == 0
        git("commit", "-qam", branch)
    earlier = head(cli)
    git("merge", "-q", "other", "-m", "both")
    assert cli("decisions", "verify", "--head", earlier).returncode == 0
    assert [len(entry["before"]) for entry in entries(folder / "decisions.jsonl")] == [0, 1, 1, 1, 2]  # type: ignore[arg-type]


def test_what_both_decided_differently_is_open_again(cli: Cli, folder: Path) -> None:
    (folder / "other.jsonl").write_bytes((folder / "decisions.jsonl").read_bytes())
    cli("decide", "mitigate", ID)
    cli("decide", "avoid", ID, "--decisions", "other.jsonl")
    done = cli("decisions", "merge", "decisions.jsonl", "other.jsonl")
    assert (done.returncode, ID in done.stderr) == (0, True)
    assert cli("analyze", BEFORE, "-l", RUN3, "--decisions", "decisions.jsonl", "-q").returncode == 1
    assert "nothing is decided now" in cli("decisions", "show").stdout


def test_a_head_is_signed_and_verified_by_ssh(cli: Cli, folder: Path) -> None:
    def ssh(*words: str, text: str | None = None) -> int:
        return subprocess.run(
            ["ssh-keygen", *words], input=text, text=True, capture_output=True, check=False
        ).returncode

    (folder / "head").write_text(cli("decisions", "show", "--head").stdout)
    assert ssh("-q", "-t", "ed25519", "-N", "", "-f", "key") == 0
    (folder / "signers").write_text(f"dpo@example.org {(folder / 'key.pub').read_text()}")
    assert ssh("-Y", "sign", "-f", "key", "-n", "rosprivacy", "head") == 0
    verify = ("-Y", "verify", "-f", "signers", "-I", "dpo@example.org", "-n", "rosprivacy", "-s", "head.sig")
    assert ssh(*verify, text=(folder / "head").read_text()) == 0
    assert cli("decisions", "verify", "--head", (folder / "head").read_text().strip()).returncode == 0
    assert ssh(*verify, text="0" * 64 + "\n") != 0


def test_two_that_write_at_once_lose_nothing(cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    processes = [
        subprocess.Popen([*PROGRAM, "decide", "avoid", f"{number:016x}"], stdout=subprocess.DEVNULL)
        for number in range(4)
    ]
    assert [process.wait(240) for process in processes] == [0] * 4
    assert cli("decisions", "verify").returncode == 0
    assert len(entries(tmp_path / "decisions.jsonl")) == 4
    assert [file.name for file in tmp_path.iterdir()] == ["decisions.jsonl"]


def test_a_full_disk_leaves_the_log_as_it_was(cli: Cli, folder: Path) -> None:
    before = (folder / "decisions.jsonl").read_bytes()
    with full_disk(len(before) + 10):
        done = cli("decide", "avoid", "1" * 16)
    assert (done.returncode, (folder / "decisions.jsonl").read_bytes()) == (2, before)
    assert cli("decisions", "verify").returncode == 0


def test_page_one_says_what_accepted_paths_lack(cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Face templates without a ground, and no end."""
    monkeypatch.chdir(tmp_path)
    care = [str(BEFORE.parents[1] / "care-home" / f"care-home.{end}") for end in ("policy.xml", "labels.yaml")]
    (tmp_path / "d.yaml").write_text(
        yaml.safe_dump(
            {
                "decisions": 1,
                "findings": [
                    {"category": "FaceTemplate", "decision": "accept", "reason": "r", "owner": "o",
                     "legal_basis": ["6(1)(f)"]},
                ],
            }
        )
    )  # fmt: skip
    text = cli("report", care[0], "-l", care[1], "--decisions", "d.yaml", "-f", "markdown").stdout
    (line,) = [line for line in text.splitlines() if "Accepted, but" in line]
    assert "Article 9(2)" in line
