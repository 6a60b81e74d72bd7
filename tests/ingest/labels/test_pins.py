"""The pins of a label file: what a glob takes away or calls reviewed holds for what a person has seen (rule S11)."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
import yaml

import rosprivacy
from rosprivacy.analysis.model import BY_GLOBS
from rosprivacy.explorer.session import Session
from rosprivacy.ingest.labels.pins import PIN_OF_NOTHING
from tests.helpers.docs import blocks
from tests.helpers.fleet_files import policy
from tests.helpers.label_files import validator
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from rosprivacy.result import Result
    from tests.helpers.command import Cli

SEEN = policy("/camera>/image", "/planner>/cmd</image", "/recorder</cmd")
MORE = policy("/camera>/image", "/planner>/cmd</image", "/recorder</cmd", "/uploader</image")
LABELS = """\
labels: 1
nodes:  # all of them
  /camera: {source: [Video]}
  /recorder: {leak: [Video]}
  "/*": conduit  # looked at
channels:
  /image: sensitive
  /cmd: mundane
"""


AT_NODE = """\
labels: 1
nodes: {/camera: {source: [Video]}, /recorder: {leak: [Video]}, "/p*": %s}
channels: {/image: sensitive, /cmd: sensitive}
"""
ENDS = "labels: 1\nnodes: {/camera: {source: [Video]}, /planner: conduit, /recorder: {leak: [Video]}}\n"
AT_CHANNEL = ENDS + 'topics: {/image: sensitive, "/c*": %s}\n'
AT_FLOW = ENDS + 'topics: {/image: sensitive, /cmd: sensitive}\nflows: [{from: "/p*", to: /cmd, never: [Video]}]\n'


def analysed(folder: Path, labels: str, text: str = SEEN, **options: Any) -> Result:
    (folder / "p.xml").write_text(text)
    (folder / "l.yaml").write_text(labels)
    return rosprivacy.analyze([str(folder / "p.xml")], [str(folder / "l.yaml")], **options)


def questions(result: Result) -> dict[str, tuple[str, ...]]:
    return {question.element.name: question.categories for question in result.analysis.open}


def ways(result: Result) -> set[tuple[str, str, str]]:
    return {(f.category, f.source.name, f.leak.name) for f in result.analysis.findings if not f.dismissed}


def pins_in(file: Path) -> Any:
    return yaml.safe_load(file.read_text("utf-8")).get("pins")


class TestMeaning:
    def test_what_nobody_has_seen_is_open(self, tmp_path: Path) -> None:
        assert analysed(tmp_path, LABELS, MORE).analysis.verdict == "no-leak-found"  # without pins as today
        pins = "pins: {nodes: {/planner: [Video]}}\n"
        assert not questions(analysed(tmp_path, LABELS + pins))
        assert questions(analysed(tmp_path, LABELS + pins, MORE)) == {"/uploader": ("Video",)}
        assert questions(analysed(tmp_path, LABELS + "pins: {}\n")) == {"/planner": ("Video",)}

    @pytest.mark.parametrize("kind", ["PersonImage", "PersonalData", "FaceImage", "Voice"])
    def test_a_pin_names_kinds_as_they_are_emitted(self, tmp_path: Path, kind: str) -> None:
        result = analysed(tmp_path, f"{LABELS}pins: {{nodes: {{/planner: [{kind}]}}}}\n")
        assert questions(result) == {"/planner": ("Video",)}

    @pytest.mark.parametrize(
        ("labels", "pin", "question"),
        [
            *((AT_NODE % label, "nodes: {/planner: [Video]}", "/planner")
              for label in ("{sanitizer: {Video: drop}}", "{absent: sold}", "{sanitizer: {PersonalData: drop}}")),
            *((AT_CHANNEL % label, "topics: {/cmd: [Video]}", "/cmd")
              for label in ("mundane", "{never: [Video]}", "{only: [Voice]}")),
            (AT_FLOW, "flows: [{from: {node: /planner}, to: {topic: /cmd}, kinds: [Video]}]", ""),
        ],
    )  # fmt: skip
    def test_what_a_glob_takes_away_goes_on_where_it_is_not_pinned(
        self, tmp_path: Path, labels: str, pin: str, question: str
    ) -> None:
        assert ways(analysed(tmp_path, labels)) == set()
        assert ways(analysed(tmp_path, f"{labels}pins: {{{pin}}}\n")) == set()
        others = ["nodes: {/cmd: [Video]}", "services: {/cmd: [Video]}", "topics: {/cmd: [Voice]}"]
        for other in ("", *(others if question == "/cmd" else [])):
            unseen = analysed(tmp_path, f"{labels}pins: {{{other}}}\n")
            assert ways(unseen) == {("Video", "/camera", "/recorder")}
            assert questions(unseen) == ({question: ("Video",)} if question else {})

    def test_a_source_a_leak_and_a_derivation_of_a_glob_need_no_pin(self, tmp_path: Path) -> None:
        labels = 'labels: 1\nnodes:\n  "/cam*": {source: [Video]}\n  "/rec*": {leak: [FaceTemplate]}\n'
        labels += '  "/plan*": {derives: [{from: Video, to: FaceTemplate}]}\npins: {}\n'
        assert ("FaceTemplate", "/camera", "/recorder") in ways(analysed(tmp_path, labels))

    def test_a_leak_that_a_longer_glob_takes_back(self, tmp_path: Path) -> None:
        labels = 'labels: 1\nnodes: {/camera: {source: [Video]}, "/*": {leak: [Video]}, "/plan*": {leak: none}}\n'
        assert ("Video", "/camera", "/planner") not in ways(analysed(tmp_path, labels))
        assert ("Video", "/camera", "/planner") in ways(analysed(tmp_path, labels + "pins: {}\n"))

    def test_a_glob_that_lets_through_what_a_shipped_file_closes_still_does(self, tmp_path: Path) -> None:
        """Otherwise a file with pins would hide what one without shows."""
        text = policy("/camera>/rosout", "/recorder</rosout")
        labels = "labels: 1\nnodes: {/camera: {source: [Video]}, /recorder: {leak: [Video]}}\n"
        labels += 'channels: {"*/rosout": sensitive}\n'
        assert ways(analysed(tmp_path, labels, text)) == {("Video", "/camera", "/recorder")}
        unseen = analysed(tmp_path, labels + "pins: {}\n", text)
        assert ways(unseen) == {("Video", "/camera", "/recorder")}
        assert questions(unseen) == {"/rosout": ("Video",)}

    def test_globs_of_another_file_hold_as_its_own_pins_say(self, tmp_path: Path) -> None:
        (tmp_path / "m.yaml").write_text('labels: 1\nnodes: {"/plan*": conduit}\n')
        (tmp_path / "l.yaml").write_text(LABELS + "pins: {}\n")
        (tmp_path / "p.xml").write_text(MORE)
        files = [str(tmp_path / name) for name in ("l.yaml", "m.yaml")]
        assert questions(rosprivacy.analyze([str(tmp_path / "p.xml")], files)) == {"/uploader": ("Video",)}

    def test_a_pin_that_matches_nothing_is_a_notice(self, tmp_path: Path) -> None:
        pins = "pins:\n  nodes:\n    /planner: [Video]\n    /gone: [Video]\n  topics:\n    /cmd: [Video]\n"
        told = [d for d in analysed(tmp_path, LABELS + pins).diagnostics if d.code == PIN_OF_NOTHING]
        assert [(d.place.line, d.severity) for d in told] == [(12, "notice"), (14, "notice")]


class TestCommand:
    """``labels --pin``."""

    @pytest.fixture(autouse=True)
    def _here(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.chdir(tmp_path)
        for name, text in (("p.xml", SEEN), ("g2.xml", MORE), ("l.yaml", LABELS)):
            Path(name).write_text(text)

    def pin(self, cli: Cli, file: str = "p.xml", *options: str) -> str:
        """What is said on standard error."""
        done = cli("labels", "--pin", file, "-l", "l.yaml", *options)
        assert (done.returncode, done.stdout) == (0, "")
        return done.stderr

    def test_a_new_node_is_no_longer_let_through(self, cli: Cli) -> None:
        assert self.pin(cli) == "l.yaml: 3 lines changed\n"
        assert Path("l.yaml").read_text() == LABELS + "pins:\n  nodes:\n    /planner: [Video]\n"
        assert cli("analyze", "p.xml", "-l", "l.yaml").returncode == 0
        assert cli("analyze", "g2.xml", "-l", "l.yaml").returncode == 4
        assert self.pin(cli) == "l.yaml: 0 lines changed\n"

    def test_the_next_pin_drops_what_matches_nothing_and_keeps_every_comment(self, cli: Cli) -> None:
        nodes = "  nodes:\n    /gone: [Video]\n    /planner: [Voice]  # why\n"
        pins = f"# seen in May\npins:\n{nodes}  topics: {{/x: [Video]}}\n"
        Path("l.yaml").write_text(LABELS + pins)
        assert "1 comment" in self.pin(cli, "g2.xml")
        text = Path("l.yaml").read_text()
        assert text.startswith(LABELS + "# seen in May\n")
        assert "# why" in text
        assert pins_in(Path("l.yaml")) == {"nodes": {"/planner": ["Video"], "/uploader": ["Video"]}}

    def test_what_ends_at_a_glob_is_pinned_there_and_nothing_behind_it(self, cli: Cli) -> None:
        Path("l.yaml").write_text('labels: 1\nnodes: {/camera: {source: [Video]}}\ntopics: {"/*": mundane}\n')
        self.pin(cli)
        assert pins_in(Path("l.yaml")) == {"topics": {"/image": ["Video"]}}

    def test_names_with_glob_signs_and_flows(self, cli: Cli) -> None:
        Path("p.xml").write_text(policy("/camera>/image/*", "/planner>/cmd</image/*"))
        labels = 'labels: 1\nnodes: {/camera: {source: [Video]}, "/p*": conduit}\ntopics: {"/image/*": sensitive}\n'
        labels += 'flows: [{from: /planner, to: "/c*", never: [Video]}, {from: /camera, to: "/im*", only: [Video]}]\n'
        Path("l.yaml").write_text(labels)
        self.pin(cli)
        assert pins_in(Path("l.yaml")) == {
            "nodes": {"/planner": ["Video"]},
            "topics": {"=/image/*": ["Video"]},
            "flows": [{"from": {"node": "/planner"}, "to": {"topic": "/cmd"}, "kinds": ["Video"]}],
        }
        assert validator().is_valid(yaml.safe_load(Path("l.yaml").read_text()))
        assert not questions(rosprivacy.analyze(["p.xml"], ["l.yaml"]))

    def test_a_file_without_such_globs_gets_none_and_loses_those_that_it_has(self, cli: Cli) -> None:
        Path("l.yaml").write_text("labels: 1\nnodes: {/camera: {source: [Video]}}\npins: {}\n")
        Path("m.yaml").write_text('labels: 1\nnodes: {"/rec*": {leak: [Video]}}\n')
        assert self.pin(cli, "p.xml", "-l", "m.yaml") == "l.yaml: 1 line changed\n"
        assert pins_in(Path("l.yaml")) is None

    def test_json_has_them_too_and_the_papers_six_lists_have_no_place(self, cli: Cli) -> None:
        Path("l.json").write_text(json.dumps(yaml.safe_load(LABELS), indent=1))
        assert cli("labels", "--pin", "p.xml", "-l", "l.json").returncode == 0
        assert json.loads(Path("l.json").read_text())["pins"] == {"nodes": {"/planner": ["Video"]}}
        Path("six.json").write_text('{"source": ["/camera"], "leak": ["/recorder"], "mundane": ["/c*"]}')
        done = cli("labels", "--pin", "p.xml", "-l", "six.json")
        assert done.returncode == 2
        assert "has no place for pins" in done.stderr

    def test_other_writers_keep_them(self, cli: Cli) -> None:
        pins = "pins:\n  nodes:\n    /planner: [Video]\n"
        Path("l.yaml").write_text(LABELS.replace("1\n", "1\nauthor: Ada\n", 1) + pins)
        for words in (["--next"], ["--update"]):
            assert cli("labels", *words, "g2.xml", "-l", "l.yaml").returncode == 0
        assert cli("suggest", "g2.xml", "-l", "l.yaml", "--into", "l.yaml").returncode == 0
        assert cli("labels", "--accept", "/uploader", "g2.xml", "-l", "l.yaml").returncode == 0
        text = Path("l.yaml").read_text()
        assert pins in text
        self.pin(cli, "g2.xml")
        assert pins_in(Path("l.yaml")) == {"nodes": {"/planner": ["Video"]}}  # a name answers for the other now


def test_a_session_of_the_explorer_keeps_them(tmp_path: Path) -> None:
    """In what it answers before it saves, and in the file."""
    pins = "pins:\n  nodes:\n    /planner: [Video]\n"
    (tmp_path / "g2.xml").write_text(MORE)
    (tmp_path / "l.yaml").write_text(LABELS + pins)
    session = Session.open([str(tmp_path / "g2.xml")], [str(tmp_path / "l.yaml")])
    session.label("/recorder", conduit=True)
    assert questions(session.result) == {"/uploader": ("Video",)}
    session.save()
    assert (tmp_path / "l.yaml").read_text() == LABELS.replace("{leak: [Video]}", "conduit") + pins
    assert questions(session.result) == {"/uploader": ("Video",)}


def test_the_example_of_the_documentation(cli: Cli, tmp_path: Path) -> None:
    """docs/labels.md: what ``--pin`` writes is what is shown, and the new node is open."""
    (shown,) = [block for block in blocks(ROOT / "docs" / "labels.md", "yaml") if "pins:\n  nodes" in block]
    (tmp_path / "robot.labels.yaml").write_text(shown[: shown.index("pins:")])
    (tmp_path / "robot.policy.xml").write_text(SEEN)
    (command,) = [one for one in blocks(ROOT / "docs" / "labels.md", "console") if "--pin" in one]
    assert cli(*command.split()[1:], cwd=tmp_path).returncode == 0
    assert (tmp_path / "robot.labels.yaml").read_text() == shown
    assert questions(analysed(tmp_path, shown, MORE)) == {"/uploader": ("Video",)}


def test_what_only_a_glob_answers_for_is_in_doubt_until_it_is_pinned(cli: Cli, tmp_path: Path) -> None:
    """Rules S11 and S12: ``diff`` ends with 1 where data gets to an element that was neither open nor doubted."""
    pins = "pins: {nodes: {/planner: [Video]}}\n"
    for name, text in (("g.xml", SEEN), ("g2.xml", MORE), ("l.yaml", LABELS), ("seen.yaml", LABELS + pins)):
        (tmp_path / name).write_text(text)

    def ends(*words: str) -> int:
        return cli(*words, cwd=tmp_path).returncode

    result = rosprivacy.analyze([str(tmp_path / "g2.xml")], [str(tmp_path / "l.yaml")])
    about = [(d.element.name, d.categories, d.rank) for d in result.doubts if d.name == BY_GLOBS and d.element]
    assert about == [("/planner", ("Video",), "rides"), ("/uploader", ("Video",), "rides")]
    assert "/uploader" in cli("analyze", "-q", "g2.xml", "-l", "l.yaml", cwd=tmp_path).stdout
    assert (ends("diff", "g.xml", "g2.xml", "-l", "l.yaml"), ends("diff", "g.xml", "g.xml", "-l", "l.yaml")) == (1, 0)
    for labels, code in (("l.yaml", 4), ("seen.yaml", 0)):
        assert ends("analyze", "g.xml", "-l", labels, "--fail-on", "doubt") == code
        assert ends("analyze", "g.xml", "-l", labels) == 0
    assert ends("diff", "g.xml", "g2.xml", "-l", "seen.yaml") == 1  # the verdict is worse
