"""A label ages: it speaks of the code that a person has seen (rules S11, S16)."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

import rosprivacy
from rosprivacy.analysis.model import CODE_CHANGED, CODE_NOT_READ
from rosprivacy.ingest.labels.pins import PIN_OF_NOTHING
from rosprivacy.labelling.code_pinning import pinned_code
from rosprivacy.settings import Settings
from tests.helpers.label_files import validator

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.result import Result
    from tests.helpers.command import Cli

MANIFEST = "<package format='3'><name>home</name></package>\n"
NODE = """\
from rclpy.node import Node
from sensor_msgs.msg import Image


class {cls}(Node):
    def __init__(self):
        super().__init__("{name}")
{ends}

    def seen(self, image):
        return {body}
"""
ENDS = {  # node -> channels that it reads, and that it writes
    "camera": ((), ("raw",)),
    "blur": (("raw",), ("clean",)),
    "uploader": (("clean",), ()),
    "recorder": (("raw",), ()),
}
LABELS = """\
labels: 1  # of the home
nodes:
  /camera: {source: [Video]}  # the front
  /blur: {sanitizer: {Video: drop}}  # Ada looked
  /uploader: {leak: [Video]}
  /recorder: conduit
channels: {/raw: sensitive, /clean: sensitive}
"""


def code_of(name: str, body: str = "image") -> str:
    reads, writes = ENDS[name]
    ends = [f'        self.create_subscription(Image, "/{topic}", self.seen, 10)' for topic in reads]
    ends += [f'        self.out = self.create_publisher(Image, "/{topic}", 10)' for topic in writes]
    return NODE.format(cls=name.title(), name=name, ends="\n".join(ends), body=body)


@pytest.fixture
def home(tmp_path: Path) -> Path:
    return put_home(tmp_path)


def put_home(folder: Path, labels: str = LABELS) -> Path:
    (folder / "robot/home").mkdir(parents=True)
    (folder / "robot/package.xml").write_text(MANIFEST)
    for name in ENDS:
        (folder / f"robot/home/{name}.py").write_text(code_of(name))
    (folder / "l.yaml").write_text(labels)
    return folder


def pin(home: Path) -> None:
    (written,) = pinned_code((str(home / "robot"),), (str(home / "l.yaml"),), Settings())
    (home / "l.yaml").write_text(written.text)


def change(home: Path, name: str) -> None:
    (home / f"robot/home/{name}.py").write_text(code_of(name, body="self.send(image)"))


def answer(home: Path, system: str = "robot", **options: Any) -> Result:
    return rosprivacy.analyze([str(home / system)], [str(home / "l.yaml")], **options)


def ways(result: Result) -> set[tuple[str, str, str, str]]:
    return {(f.kind, f.category, f.source.name, f.leak.name) for f in result.analysis.findings}


def questions(result: Result) -> set[tuple[str, str]]:
    return {(question.element.name, kind) for question in result.analysis.open for kind in question.categories}


def told(result: Result, code: str) -> list[str]:
    return [f"{doubt.place}: {doubt.message}" for doubt in result.doubts if doubt.name == code]


class TestMeaning:
    def test_what_closed_a_way_does_so_no_more(self, home: Path) -> None:
        pin(home)
        assert not ways(answer(home))
        change(home, "blur")
        result = answer(home)
        assert ways(result) == {("disclosure", "Video", "/camera", "/uploader")}
        assert questions(result) == {("/blur", "Video")}

    def test_the_label_and_the_code_are_named(self, home: Path) -> None:
        pin(home)
        change(home, "blur")
        (line,) = told(answer(home), CODE_CHANGED)
        assert line.startswith(f"{home / 'l.yaml'}:4: /blur is open again: reviewed at another version of")
        assert f"home/home/blur.py:Blur ({home / 'robot/home/blur.py'}:5)" in line
        assert "another version" in str(answer(home))

    @pytest.mark.parametrize("name", ["camera", "uploader"])
    def test_what_brings_data_in_or_lets_it_out_does_so_still(self, home: Path, name: str) -> None:
        (home / "l.yaml").write_text(LABELS.replace("{sanitizer: {Video: drop}}", "conduit"))
        pin(home)
        change(home, name)
        result = answer(home)
        assert ways(result) == {("disclosure", "Video", "/camera", "/uploader")}
        assert questions(result) == {(f"/{name}", "Video")}  # and is open again

    def test_a_source_may_send_anywhere_now(self, home: Path) -> None:
        text = LABELS.replace("{source: [Video]}", "{source: {Video: [/raw]}}").replace("{Video: drop}", "[Voice]")
        (home / "l.yaml").write_text(text)
        file, more = home / "robot/home/camera.py", 'self.more = self.create_publisher(Image, "/more", 10)'
        file.write_text(code_of("camera").replace("self.out =", f"{more}\n        self.out ="))
        pin(home)
        assert "/more" not in {name for name, _ in questions(answer(home))}
        file.write_text(file.read_text().replace("return image", "self.more.publish(image)"))
        assert ("/more", "Video") in questions(answer(home))

    def test_no_other_label_answers_for_such_a_node(self, home: Path) -> None:
        """Nor does a glob, in whatever file: it was said of the other version too."""
        (home / "more.yaml").write_text('labels: 1\nnodes: {"/b*": {sanitizer: {Video: drop}}}\n')
        pin(home)
        change(home, "blur")
        both = rosprivacy.analyze([str(home / "robot")], [str(home / "l.yaml"), str(home / "more.yaml")])
        assert questions(both) == {("/blur", "Video")}

    def test_restrictions_of_flows_of_such_a_node_hold_no_more(self, home: Path) -> None:
        flow = "flows: [{from: /blur, to: /clean, never: [Video]}]\n"
        (home / "l.yaml").write_text(LABELS.replace("{sanitizer: {Video: drop}}", "conduit") + flow)
        pin(home)
        assert not ways(answer(home))
        change(home, "blur")
        assert ways(answer(home))

    def test_code_that_is_gone_is_another(self, home: Path) -> None:
        pin(home)
        file = home / "robot/home/blur.py"
        file.rename(home / "robot/home/blurring.py")
        result = answer(home)
        assert questions(result) == {("/blur", "Video")}
        assert "home/home/blur.py:Blur, which is not in the code that was read" in told(result, CODE_CHANGED)[0]

    def test_white_space_and_comments_change_nothing(self, home: Path) -> None:
        pin(home)
        before = answer(home)
        file = home / "robot/home/blur.py"
        file.write_text("# seen\n" + file.read_text().replace("return image", "return (  image  )"))
        after = answer(home)
        assert (ways(after), questions(after)) == (ways(before), questions(before))
        assert not told(after, CODE_CHANGED)

    def test_without_the_code_a_doubt_rides(self, home: Path, cli: Cli) -> None:
        cli("scan", "robot", "-o", "p.xml", cwd=home)
        plain = answer(home, "p.xml")
        pin(home)
        result = answer(home, "p.xml")
        assert (ways(result), questions(result)) == (ways(plain), questions(plain))
        (line,) = told(result, CODE_NOT_READ)
        assert "the code of 4 reviewed nodes was not read" in line
        assert str(next(one for one in result.doubts if one.name == CODE_NOT_READ).rank) == "rides"
        assert not told(plain, CODE_NOT_READ)

    def test_the_answer_of_a_database_is_the_same(self, home: Path) -> None:
        """What is stored of a statement says that it holds for no kind."""
        from rosprivacy.ingest.neo4j_graph.relationship_facts import add_roles, role_of, role_statements

        pin(home)
        change(home, "camera")
        result = answer(home)
        graph = result.analysis.graph
        vertex = next(v for v, element in enumerate(graph.elements) if element.name == "/camera")
        rows: dict[str, list[Any]] = {}
        add_roles(rows, "", "", result.bound.elements[vertex], result.vocabulary)
        (row,) = rows["source"]
        stored = role_of("source", "Video", row["properties"])
        (statement,) = role_statements([("Video", stored)], graph.elements[vertex], result.vocabulary)
        assert statement == result.bound.elements[vertex][0]


class TestCommand:
    def test_pins_go_into_the_file_in_place(self, home: Path, cli: Cli) -> None:
        done = cli("labels", "--pin-code", "robot", "-l", "l.yaml", cwd=home)
        assert done.returncode == 0, done.stderr
        text = (home / "l.yaml").read_text()
        assert text.startswith(LABELS)  # comments too
        document = yaml.safe_load(text)
        assert {name: [*units] for name, units in document["pins"]["code"].items()} == {
            f"/{name}": [f"home/home/{name}.py:{name.title()}"] for name in ENDS
        }
        assert not [*validator().iter_errors(document)]
        assert "0 lines changed" in cli("labels", "--pin-code", "robot", "-l", "l.yaml", cwd=home).stderr
        assert (home / "l.yaml").read_text() == text

    def test_a_review_anew_closes_it_again(self, home: Path, cli: Cli) -> None:
        pin(home)
        change(home, "blur")
        assert ways(answer(home))
        cli("labels", "--pin-code", "robot", "-l", "l.yaml", cwd=home)
        assert not ways(answer(home))

    def test_the_other_pins_stay(self, home: Path, cli: Cli) -> None:
        (home / "l.yaml").write_text(LABELS.replace("/recorder: conduit", '"/rec*": conduit'))
        for option in ("--pin", "--pin-code", "--pin"):
            assert cli("labels", option, "robot", "-l", "l.yaml", cwd=home).returncode == 0
        pins = yaml.safe_load((home / "l.yaml").read_text())["pins"]
        assert pins["nodes"] == {"/recorder": ["Video"]}
        assert "/recorder" in pins["code"]  # a glob speaks of it

    def test_a_file_whose_globs_need_no_pin_keeps_its_meaning(self, home: Path, cli: Cli) -> None:
        (home / "l.yaml").write_text(LABELS + "pins: {}\n")
        cli("labels", "--pin-code", "robot", "-l", "l.yaml", cwd=home)
        assert yaml.safe_load((home / "l.yaml").read_text())["pins"]["nodes"] == {}

    def test_a_pin_of_a_node_without_a_label_is_dropped(self, home: Path, cli: Cli) -> None:
        pin(home)
        file = home / "l.yaml"
        file.write_text(file.read_text().replace("  /recorder: conduit\n", ""))
        assert PIN_OF_NOTHING in {one.code for one in answer(home).diagnostics}
        cli("labels", "--pin-code", "robot", "-l", "l.yaml", cwd=home)
        assert "/recorder" not in file.read_text()

    def test_only_code_can_be_pinned(self, home: Path, cli: Cli) -> None:
        cli("scan", "robot", "-o", "p.xml", cwd=home)
        done = cli("labels", "--pin-code", "p.xml", "-l", "l.yaml", cwd=home)
        assert done.returncode == 2
        assert "p.xml: is no folder of source code and no launch file" in done.stderr

    @pytest.mark.parametrize(
        ("value", "line"),
        [
            ("[/blur]", "code of pins is a map, not a list"),
            ("{/blur: 93fe}", "the code of '/blur' is a map from a file or class to a hash"),
            ("{/blur: {}}", "the code of '/blur' is a map from a file or class to a hash"),
            ("{/blur: {a.py: 93fe}}", "'93fe' is no hash of 'a.py'"),
            ("{/blur: {a.py: [x]}}", "'list' is no hash of 'a.py'"),
            ('{"/b*": {a.py: "93fe1c2a77d0b1e4"}}', "'/b*' where an element is pinned"),
            ('{cloud: {a.py: "93fe1c2a77d0b1e4"}}', "'cloud' where an element is pinned"),
        ],
    )
    def test_wrong_values_are_told(self, home: Path, value: str, line: str) -> None:
        (home / "l.yaml").write_text(f"{LABELS}pins: {{code: {value}}}\n")
        with pytest.raises(rosprivacy.InputErrors, match=line.replace("*", r"\*").replace("[", r"\[")):
            answer(home)


NODES = st.sampled_from(
    [
        "conduit", "{conduit: [Video]}", "{source: [Video]}", "{source: {Video: [/%s]}}", "{source: none}",
        "{leak: [Video]}", "{leak: none}", "{sanitizer: {Video: drop}}", "{sanitizer: [Voice]}", "{absent: why}",
        "{derives: [{from: Video, to: FaceTemplate}]}", "{leak: [Voice], sanitizer: {Video: anonymise}}", "",
    ]
)  # fmt: skip
CHANNELS = st.sampled_from(["sensitive", "mundane", "{only: [Voice]}", "{never: [Video]}", ""])


@st.composite
def labels(draw: st.DrawFn) -> str:
    lines = ["labels: 1", "nodes:"]
    for name, (_, writes) in ENDS.items():
        said = draw(NODES)
        said = said if "%s" not in said else said % writes[0] if writes else "{source: [Video]}"
        lines += [f"  /{name}: {said}"] if said else []
    lines += [f'  "/{glob}*": {said}' for glob in ("b", "") if (said := draw(NODES)) and "%s" not in said]
    channels = [f"  /{name}: {said}" for name in ("raw", "clean") if (said := draw(CHANNELS))]
    flow = ["flows: [{from: /blur, to: /clean, never: [Video]}]"] if draw(st.booleans()) else []
    return "\n".join([*lines, "channels:", *channels, *flow, ""])


@pytest.fixture(scope="module")
def one_home() -> Iterator[Path]:
    with TemporaryDirectory() as folder:
        yield put_home(Path(folder))


@given(labels(), st.sets(st.sampled_from([*ENDS])))
def test_equal_hashes_change_nothing_and_others_lose_nothing(one_home: Path, text: str, changed: set[str]) -> None:
    file = one_home / "l.yaml"
    file.write_text(text)
    try:
        plain = answer(one_home)
    except rosprivacy.InputErrors:  # labels that contradict each other
        return
    before = without_hash(plain, file)
    pin(one_home)
    assert without_hash(answer(one_home), file) == before
    document = yaml.safe_load(file.read_text())
    pins = document.get("pins", {}).get("code", {})
    for name in changed:
        for unit in pins.get(f"/{name}", ()):
            pins[f"/{name}"][unit] = "0" * 16
    file.write_text(json.dumps(document))
    after = answer(one_home)
    assert ways(plain) <= ways(after)
    assert questions(plain) <= questions(after)
    assert len(told(after, CODE_CHANGED)) == len({f"/{name}" for name in changed} & pins.keys())
    reached = {one.element.name for one in after.analysis.carried}
    again = {f"/{name}" for name in changed} & pins.keys() & reached
    assert again <= {name for name, _ in questions(after)}


def without_hash(result: Result, file: Path) -> str:
    """The whole answer, but for the hash of the label file."""
    return json.dumps(result.document()).replace(hashlib.sha256(file.read_bytes()).hexdigest(), "")
