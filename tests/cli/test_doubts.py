"""One list of doubts: what fails on it, what is accepted of it, what ``diff`` and every output say of it (S11, S12)."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

from tests.helpers.command import cli
from tests.helpers.hidden_leaks import SEEN, SEES, UP, enclaves, node_info

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

__all__ = ["cli"]
SPY = enclaves("/camera>/video", "/view</video", "/spy</video")
DEAD_END = enclaves("/camera>/video,/more", "/view</video")
ENDS = SEES.replace("{/video", "{/more: sensitive, /video")
SIGNED = ("--reason", "the test bench", "--owner", "A. Person", "--expires", "2999-01-01")


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A channel ends at no known reader; all else is reviewed."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "p.xml").write_text(DEAD_END)
    (tmp_path / "l.yaml").write_text(ENDS)
    return tmp_path


def document(cli: Cli, *arguments: str) -> dict[str, Any]:
    parsed: dict[str, Any] = json.loads(cli("analyze", *arguments, "--format", "json").stdout)
    return parsed


class TestFailOn:
    """The exit code 4 on what rides; the strictest word counts."""

    @pytest.mark.parametrize(
        ("words", "code"),
        [
            ((), 0), (("undetermined",), 0), (("leak",), 0), (("doubt",), 4), (("leak", "doubt"), 4),
            (("undecided", "doubt"), 4), (("undecided",), 0), (("never",), 0),
        ],
    )  # fmt: skip
    def test_doubts_that_ride(self, cli: Cli, robot: Path, words: tuple[str, ...], code: int) -> None:
        options = [word for one in words for word in ("--fail-on", one)]
        assert cli("analyze", "p.xml", "-l", "l.yaml", *options, cwd=robot).returncode == code

    def test_a_doubt_lets_no_leak_through(self, cli: Cli, robot: Path) -> None:
        (robot / "l.yaml").write_text(ENDS.replace("{leak: none, conduit: [Video]}", "{leak: [Video]}"))
        assert cli("analyze", "p.xml", "-l", "l.yaml", "--fail-on", "doubt", cwd=robot).returncode == 1

    def test_never_stands_alone(self, cli: Cli, robot: Path) -> None:
        done = cli("analyze", "p.xml", "-l", "l.yaml", "--fail-on", "never", "--fail-on", "doubt", cwd=robot)
        assert done.returncode == 2


class TestAccepting:
    """A person's word, with a reason, an owner and an end; by id or by names."""

    def test_by_id(self, cli: Cli, robot: Path) -> None:
        (robot / "r.json").write_text(json.dumps(document(cli, "p.xml", "-l", "l.yaml")))
        (doubt,) = document(cli, "p.xml", "-l", "l.yaml")["doubts"]
        assert cli("decide", "accept", doubt["id"][:5], "--report", "r.json", *SIGNED, cwd=robot).returncode == 0
        decided = ("p.xml", "-l", "l.yaml", "--decisions", "decisions.jsonl")
        assert cli("analyze", *decided, "--fail-on", "doubt", cwd=robot).returncode == 0
        (accepted,) = document(cli, *decided)["doubts"]
        assert accepted["accepted"]["owner"] == "A. Person"
        assert "; 1 doubt accepted" in cli("analyze", *decided, "-q").stdout
        (result,) = json.loads(cli("analyze", *decided, "-f", "sarif").stdout)["runs"][0]["results"]
        assert result["suppressions"][0]["justification"] == "the test bench"

    @pytest.mark.parametrize(("element", "code"), [("/mo*", 0), ("/more", 0), ("/other*", 4)])
    def test_by_names(self, cli: Cli, robot: Path, element: str, code: int) -> None:
        named = ("--doubt", "no-reader", "--element", element)
        assert cli("decide", "accept", *named, *SIGNED, cwd=robot).returncode == 0
        done = cli(
            "analyze", "p.xml", "-l", "l.yaml", "--decisions", "decisions.jsonl", "--fail-on", "doubt", cwd=robot
        )
        assert done.returncode == code
        assert ("it is orphaned" in done.stdout) == bool(code)

    def test_what_is_over_counts_no_longer(self, cli: Cli, robot: Path) -> None:
        entry = "{doubt: no-reader, decision: accept, reason: r, owner: o, expires: 2020-01-01}"
        (robot / "d.yaml").write_text(f"decisions: 1\ndoubts: [{entry}]\n")
        done = cli("analyze", "p.xml", "-l", "l.yaml", "--decisions", "d.yaml", "--fail-on", "doubt", cwd=robot)
        assert done.returncode == 4
        assert "expired on 2020-01-01" in done.stdout

    def test_what_was_decided_anew_counts_and_is_not_orphaned(self, cli: Cli, robot: Path) -> None:
        entry = "{{doubt: no-reader, decision: accept, reason: r, owner: o, expires: {}}}"
        both = ", ".join(map(entry.format, ("2020-01-01", "2999-01-01")))
        (robot / "d.yaml").write_text(f"decisions: 1\ndoubts: [{both}]\n")
        done = cli("analyze", "p.xml", "-l", "l.yaml", "--decisions", "d.yaml", "--fail-on", "doubt", cwd=robot)
        assert (done.returncode, "orphaned" in done.stdout) == (0, False)
        assert "expired on 2020-01-01" in done.stdout

    @pytest.mark.parametrize("left_out", ["reason", "owner", "expires"])
    def test_without_what_a_person_signs_it_is_an_error(self, cli: Cli, robot: Path, left_out: str) -> None:
        entry = {"doubt": "no-reader", "decision": "accept", "reason": "r", "owner": "o", "expires": "2999-01-01"}
        del entry[left_out]
        (robot / "d.yaml").write_text(json.dumps({"decisions": 1, "doubts": [entry]}))
        done = cli("analyze", "p.xml", "-l", "l.yaml", "--decisions", "d.yaml", cwd=robot)
        assert (done.returncode, f"without {left_out}" in done.stderr) == (2, True)

    def test_one_that_breaks_lifts_the_verdict_and_is_counted(self, cli: Cli, robot: Path) -> None:
        (robot / "d").mkdir()
        (robot / "d" / "p.xml").write_text(SEEN)
        (robot / "d" / "up.policy").write_text(UP)
        (robot / "l.yaml").write_text(SEES)
        assert document(cli, "d", "-l", "l.yaml")["verdict"] == "undetermined"
        assert cli("decide", "accept", "--doubt", "unread-file", "--file", "d/up*", *SIGNED, cwd=robot).returncode == 0
        done = cli("analyze", "d", "-l", "l.yaml", "--decisions", "decisions.jsonl", "-q", cwd=robot)
        assert (done.returncode, done.stdout.partition(":")[0]) == (0, "no-leak-found")
        assert "1 doubt accepted" in done.stdout


class TestMitigate:
    """What is proposed leaves doubts where they are: no verdict is better than they let it be."""

    def test_a_file_that_nobody_read_is_in_the_verdict_with_the_changes(self, cli: Cli, robot: Path) -> None:
        (robot / "d").mkdir()
        (robot / "d" / "p.xml").write_text(SEEN)
        (robot / "l.yaml").write_text(SEES.replace("{leak: none, conduit: [Video]}", "{leak: [Video]}"))
        assert "the verdict is then no-leak-found" in cli("mitigate", "d", "-l", "l.yaml", cwd=robot).stdout
        (robot / "d" / "up.policy").write_text(UP)
        done = cli("mitigate", "d", "-l", "l.yaml", cwd=robot)
        assert "the verdict is then undetermined" in done.stdout
        assert "in doubt before the changes: d/up.policy was not read" in done.stdout
        for then, expires in (("undetermined", "2020-01-01"), ("no-leak-found", "2999-01-01")):
            entry = f"{{doubt: unread-file, decision: accept, reason: r, owner: o, expires: {expires}}}"
            (robot / "d.yaml").write_text(f"decisions: 1\ndoubts: [{entry}]\n")
            done = cli("mitigate", "d", "-l", "l.yaml", "--decisions", "d.yaml", cwd=robot)
            assert f"the verdict is then {then}" in done.stdout

    def test_where_there_is_nothing_to_remove_the_doubts_are_named(self, cli: Cli, robot: Path) -> None:
        done = cli("mitigate", "p.xml", "-l", "l.yaml", cwd=robot)
        first, _, doubts = done.stdout.partition("\n")[0].partition("; ")
        assert first == "no-leak-found: no open finding, nothing to remove"
        assert document(cli, "p.xml", "-l", "l.yaml")["sentence"].endswith(f"; {doubts}")


class TestDiff:
    """Verdicts and doubts are compared; what is no comparison is said (S12)."""

    def test_a_new_element_that_nobody_has_reviewed_is_worse(self, cli: Cli, robot: Path) -> None:
        (robot / "p.xml").write_text(SEEN)
        (robot / "q.xml").write_text(SPY)
        (robot / "l.yaml").write_text(SEES)
        done = cli("diff", "p.xml", "q.xml", "-l", "l.yaml", "-f", "markdown", cwd=robot)
        assert done.returncode == 1
        assert "`node /spy`" in done.stdout

    def test_a_new_doubt_is_worse_but_not_on_what_was_open(self, cli: Cli, robot: Path) -> None:
        (robot / "old.xml").write_text(SEEN)
        (robot / "one.yaml").write_text(SEES)
        named = ("--old-labels", "one.yaml", "-l", "l.yaml")
        assert cli("diff", "old.xml", "p.xml", *named, cwd=robot).returncode == 1
        assert cli("diff", "p.xml", "old.xml", "--old-labels", "l.yaml", "-l", "one.yaml", cwd=robot).returncode == 0
        assert cli("diff", "p.xml", "p.xml", "--old-labels", "one.yaml", "-l", "l.yaml", cwd=robot).returncode == 0

    def test_labels_that_were_forgotten_are_no_comparison(self, cli: Cli, robot: Path) -> None:
        (robot / "r.json").write_text(json.dumps(document(cli, "p.xml", "-l", "l.yaml")))
        done = cli("diff", "r.json", "p.xml", cwd=robot)
        assert done.returncode == 4
        assert "no data was followed now" in done.stdout

    def test_without_any_label_grants_are_compared(self, cli: Cli, robot: Path) -> None:
        done = cli("diff", "p.xml", "p.xml", cwd=robot)
        assert done.returncode == 0
        assert "no label is given, so no data was followed" in done.stdout

    def test_a_base_without_doubts_is_compared_without_them(self, cli: Cli, robot: Path) -> None:
        base = document(cli, "p.xml", "-l", "l.yaml")
        del base["doubts"], base["sentence"]
        (robot / "r.json").write_text(json.dumps(base))
        done = cli("diff", "r.json", "p.xml", "-l", "l.yaml", cwd=robot)
        assert (done.returncode, "doubts: not compared" in done.stdout) == (0, True)


class TestNothingEnforced:
    """An observed robot: the direct way in the enforced view, and the network (S6)."""

    @pytest.fixture
    def observed(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, cli: Cli) -> Path:
        monkeypatch.chdir(tmp_path)
        text = (
            node_info("/camera", "/image") + node_info("/blur", "/clean", "/image") + node_info("/uplink", "", "/clean")
        )
        (tmp_path / "g.txt").write_text(text)
        (tmp_path / "l.yaml").write_text(
            "labels: 1\nnodes: {/camera: {source: [Video]}, /blur: {sanitizer: {Video: anonymise}}, "
            "/uplink: {leak: [PersonalData]}}\nchannels: {/image: sensitive}\n"
        )
        assert cli("observe", "--text", "g.txt", "--at", "2026-11-22T10:00:00Z", "-o", "r.xml").returncode == 0
        return tmp_path

    def test_the_verdict_line_counts_the_nodes(self, cli: Cli, observed: Path) -> None:
        (doubt,) = (
            row for row in document(cli, "r.xml", "-l", "l.yaml")["doubts"] if row["doubt"] == "nothing-enforced"
        )
        assert (doubt["count"], doubt["rank"]) == (3, "rides")
        assert "nothing is enforced for 3 nodes" in cli("analyze", "r.xml", "-l", "l.yaml", "-q", cwd=observed).stdout

    @pytest.mark.usefixtures("observed")
    def test_both_views_have_the_direct_way_and_the_network(self, cli: Cli) -> None:
        enforced = document(cli, "r.xml", "-l", "l.yaml", "--view", "enforced")
        assert [(row["source"]["name"], row["leak"]["name"]) for row in enforced["findings"]] == [
            ("/camera", "/uplink")
        ]
        assert ("participant", "network") in {
            (row["element"]["kind"], row["element"]["name"]) for row in enforced["open"]
        }
        both = document(cli, "r.xml", "-l", "l.yaml", "--view", "both")["enforced"]
        assert [row["finding"]["leak"]["name"] for row in both["added"]] == ["/uplink"]
        assert both["open"][0] == {"robot": "", "kind": "participant", "name": "network"}
        assert "(network, " in cli("analyze", "r.xml", "-l", "l.yaml", "--view", "both").stdout
        assert "network" not in json.dumps(document(cli, "r.xml", "-l", "l.yaml")["carries"])

    def test_labels_may_speak_of_the_network_in_both_views(self, cli: Cli, observed: Path) -> None:
        with (observed / "l.yaml").open("a") as file:
            file.write("elements: {network: {kind: participant, leak: [Video]}}\n")
        assert document(cli, "r.xml", "-l", "l.yaml")["verdict"] == "no-leak-found"
        found = document(cli, "r.xml", "-l", "l.yaml", "--view", "enforced")["findings"]
        assert "network" in [row["leak"]["name"] for row in found]

    def test_another_name_of_the_only_policy_is_no_new_doubt(self, cli: Cli, observed: Path) -> None:
        (observed / "later.xml").write_text((observed / "r.xml").read_text())
        done = cli("diff", "r.xml", "later.xml", "-l", "l.yaml", cwd=observed)
        assert (done.returncode, "made-without-warnings" in done.stdout) == (0, False)
        (observed / "more.txt").write_text((observed / "g.txt").read_text() + node_info("/new", "", "/clean"))
        cli("observe", "--text", "more.txt", "--at", "2026-11-22T10:00:00Z", "-o", "more.xml", cwd=observed)
        done = cli("diff", "r.xml", "more.xml", "-l", "l.yaml", cwd=observed)  # of one node more nothing is enforced
        assert (done.returncode, "+ nothing-enforced" in done.stdout) == (1, True)

    def test_a_policy_of_a_person_for_the_enclave_secures_it(self, cli: Cli, observed: Path) -> None:
        text = enclaves("/camera>/image").replace("/e0", "/camera")
        (observed / "mine.xml").write_text(text)
        (doubt,) = (
            row
            for row in document(cli, "r.xml", "mine.xml", "-l", "l.yaml")["doubts"]
            if row["doubt"] == "nothing-enforced"
        )
        assert doubt["count"] == 2

    def test_robots_of_one_domain_are_one_enclave(self, cli: Cli, observed: Path) -> None:
        """What one robot sends, a node of the other may read, too: nothing keeps it (S6)."""
        (observed / "s.txt").write_text(node_info("/sink", "", "/clean"))
        assert cli("observe", "--text", "s.txt", "--at", "2026-11-22T10:00:00Z", "-o", "s.xml").returncode == 0
        (observed / "s.yaml").write_text("labels: 1\nnodes: {/sink: {leak: [Video]}}\n")
        (observed / "f.yaml").write_text(
            "fleet: 1\nrobots:\n  a: {policies: [r.xml], labels: [l.yaml], domain: 3}\n"
            "  b: {policies: [s.xml], labels: [s.yaml], domain: 3}\n"
        )
        declared = document(cli, "--fleet", "f.yaml")
        assert declared["findings"] == []
        assert "nothing is enforced for 4 nodes" in declared["sentence"]
        enforced = document(cli, "--fleet", "f.yaml", "--view", "enforced")
        findings = enforced["findings"]
        ends = {(row["source"]["robot"], row["leak"]["robot"], row["leak"]["name"]) for row in findings}
        assert ends == {("a", "a", "/uplink"), ("a", "b", "/sink")}
        unlabelled = [row["element"] for row in enforced["open"]]
        assert {row["robot"] for row in unlabelled if row["name"] == "network"} == {"a", "b"}
