"""``rosprivacy annotations``: a developer annotates a package, CI checks the label file, ``analyze`` uses it."""

from __future__ import annotations

import os
import re
import shlex
from shutil import copytree
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.model import Place
from rosprivacy.ingest.code.annotation_text import WORDS, Annotation, read_annotation
from rosprivacy.ingest.code.code_names import code_evidence
from rosprivacy.ingest.code.source_files import read_sources
from rosprivacy.ontology.vocabulary import load
from tests.helpers.command import cli, refused
from tests.helpers.docs import CATEGORIES, blocks
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

__all__ = ["cli"]
EXAMPLE = ROOT / "examples" / "annotated"
NODE = "class A(Node):\n    def __init__(self):\n        super().__init__('a')  # privacy: {}\n"
LABELS = "robot.labels.yaml"

pytestmark = pytest.mark.usefixtures("cpp")


@pytest.fixture
def cpp() -> None:
    pytest.importorskip("tree_sitter_cpp", reason="without the [code] extra")


@pytest.fixture
def package(tmp_path: Path) -> Path:
    copytree(EXAMPLE, tmp_path / "src")
    (tmp_path / "src" / LABELS).unlink()
    return tmp_path


def changed(file: Path, old: str, new: str) -> None:
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))


def test_a_developer_annotates_ci_checks_analyze_uses(package: Path, cli: Cli) -> None:
    """The word at the publisher decides what the policy's answer is."""
    made = cli("annotations", "src", "-o", LABELS, cwd=package)
    assert (made.returncode, made.stdout, made.stderr) == (0, "", "7 annotations of 5 elements in 2 files\n")
    assert (package / LABELS).read_text() == (EXAMPLE / LABELS).read_text().replace("examples/annotated", "src")
    analyze = ("analyze", "src/robot.policy.xml", "-l", LABELS)
    assert cli(*analyze, cwd=package).returncode == 0
    check = ("annotations", "src", "--check", LABELS)
    assert (cli(*check, cwd=package).returncode, cli(*check, cwd=package).stdout) == (0, "")

    changed(package / "src" / "blur.cpp", "// A node", "// One line\n// more. A node")
    assert cli(*check, cwd=package).returncode == 0  # lines have moved, nothing else
    changed(package / "src" / "blur.cpp", "anonymise\n", "pseudonymise\n")
    changed(package / "src" / "camera.py", "  # privacy: mundane", "")
    changed(package / "src" / "camera.py", '        super().__init__("uplink")', '        super().__init__("link")')
    done = cli(*check, cwd=package)
    assert (done.returncode, done.stdout.splitlines()) == (1, [
        f"{LABELS}: /link (node) is not in it; src/camera.py:20 says it",
        f"{LABELS}:4: /blur (node) is not what src/blur.cpp:6 says",
        f"{LABELS}:6: /uplink (node) is in no annotation",
        f"{LABELS}:8: /camera_info (topic) is in no annotation",
    ])  # fmt: skip
    assert cli("annotations", "src", "-o", LABELS, cwd=package).returncode == 0
    assert cli(*check, cwd=package).returncode == 0
    left = cli(*analyze, cwd=package)
    assert left.returncode == 2
    assert f"{LABELS}:6: '/link' matches no node of the policies; did you mean" in left.stderr


def test_what_a_person_added_is_a_difference(package: Path, cli: Cli) -> None:
    assert cli("annotations", "src", "-o", LABELS, cwd=package).returncode == 0
    text = (package / LABELS).read_text()
    for more in ("limits: {Video: P1D}\n", "country: DE\n", "elements:\n  disk: {kind: storage}\n"):
        (package / LABELS).write_text(text + more)
        done = cli("annotations", "src", "--check", LABELS, cwd=package)
        assert (done.returncode, bool(done.stdout)) == (1, True)
    (package / LABELS).write_text("# mine\n" + text)
    done = cli("annotations", "src", "-o", LABELS, cwd=package)
    assert done.returncode == 2
    assert "was not written by annotations" in done.stderr
    assert (package / LABELS).read_text() == "# mine\n" + text


def test_all_problems_are_told_at_once_and_nothing_is_written(package: Path, cli: Cli) -> None:
    """One line each: unknown kind with the nearest name, attached to nothing, a conflict, a file that is no code."""
    src = package / "src"
    (src / "a.py").write_text("# privacy: leak Voise\nx = 1  # privacy: mundane\n")
    (src / "b.py").write_text(NODE.format("sanitizer Video drop") + "# privacy(/a): sanitizer Video aggregate\n")
    (src / "c.py").write_text("x = (\n")
    (src / "d.cpp").write_text("#define X y // privacy: leak Voice\n")
    done = cli("annotations", "src", "nope.cpp", "-o", LABELS, cwd=package)
    assert (done.returncode, done.stdout) == (2, "")
    lines = done.stderr.splitlines()
    starts = ["nope.cpp: file not found; correct the path",
              "src/a.py:1: unknown category 'Voise'; did you mean Voice",
              "src/a.py:2: an annotation attached to nothing",
              "src/b.py:4: /a is sanitizer (aggregate) for Video here and sanitizer (drop) at src/b.py:3",
              "src/c.py:1: not Python",
              "src/d.cpp:1: an annotation stands in a macro"]  # fmt: skip
    assert [line[: len(start)] for line, start in zip(lines, starts, strict=True)] == starts
    assert not (package / LABELS).exists()


@pytest.mark.parametrize(
    ("said", "problem"),
    [
        (("mundane", "sensitive"), "is sensitive for every category here and mundane at"),
        (("mundane", "never Video"), "is mundane of every kind here and never at"),
        (("only Video", "only Voice"), "only"),
        (("only Video", "never Video"), "never"),
        (("source Video", "sanitizer Video drop"), "source"),
        (("source Video", "source Voice through /v"), "a source through all channels here, and through some at"),
        (("conduit", "leak Voice"), "is conduit of every kind here and leak at"),
        (("leak none", "leak Voice"), "leak"),
        (("sanitizer FaceTemplate drop", "derives Biometric -> FaceTemplate"), "FaceTemplate"),
    ],
)
def test_contradictions_are_errors(said: tuple[str, str], problem: str, tmp_path: Path, cli: Cli) -> None:
    """Rules S7, S10: two annotations of one element in two places of the code are of one rank."""
    (tmp_path / "a.py").write_text("".join(f"# privacy(/x): {one}\n" for one in said))
    done = cli("annotations", "a.py", cwd=tmp_path)
    assert (done.returncode, len(done.stderr.splitlines())) == (2, 1)
    assert problem in done.stderr
    assert "a.py:1" in done.stderr
    assert "a.py:2" in done.stderr


def test_a_topic_of_two_calls_that_agree_is_one_entry(tmp_path: Path, cli: Cli) -> None:
    text = "a.create_publisher(I, '/t', 1)  # privacy: never Video\n"
    text += "a.create_subscription(I, '/t', f, 1)  # privacy: never Voice\n"
    (tmp_path / "a.py").write_text(
        text + "# privacy(/n): source Video through /b\n# privacy(/n): source Video through /a\n"
    )
    done = cli("annotations", "a.py", cwd=tmp_path)
    assert done.stdout.splitlines()[2:] == [
        "nodes:", "  /n: {source: {Video: [/a, /b]}} # a.py:3, a.py:4",
        "topics:", "  /t: {never: [Video, Voice]} # a.py:1, a.py:2",
    ]  # fmt: skip


def test_names_and_notes_of_strangers_stay_text(tmp_path: Path, cli: Cli) -> None:
    """No line of YAML, no key and no terminal sequence comes of a comment or of a file's name."""
    file = tmp_path / "x: {y}\n\x1b[31m # 'z.py"
    file.write_text('# privacy(/a: {leak: [Voice]}): mundane\n# privacy("b"): mundane\n')
    done = cli("annotations", str(tmp_path), cwd=tmp_path)
    assert (done.returncode, len(done.stderr.splitlines())) == (2, 2)
    assert all(line.isprintable() for line in done.stderr.splitlines())
    note = 'why: "x" }\x1b]0;title\x07 # \u202e nodes: {/b: conduit} \\n - &a *a !!python/object'
    file.write_text(
        "# privacy(/a:b}): mundane\n# privacy(/c): conduit Video\n"
        f"# privacy(/c): note {note}\n# privacy(/d#x): mundane\n"
    )
    done = cli("annotations", str(tmp_path), "-o", "l.yaml", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "4 annotations of 3 elements in 1 file\n")
    text = (tmp_path / "l.yaml").read_text()
    assert all(line.isprintable() for line in text.splitlines())
    import yaml

    assert yaml.safe_load(text) == {
        "labels": 1,
        "channels": {"/a:b}": "mundane", "/d#x": "mundane"},
        "nodes": {"/c": {"conduit": ["Video"], "note": "".join(c if c.isprintable() else " " for c in note)}},
    }  # fmt: skip
    assert cli("annotations", str(tmp_path), "--check", "l.yaml", cwd=tmp_path).returncode == 0


NOT_READ = "not read, as code of others or not built here (name a folder by itself to have it read)"


def write(folder: Path, files: dict[str, str]) -> None:
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, "utf-8")


def test_code_of_others_below_what_is_named_is_left_out_and_told(tmp_path: Path, cli: Cli) -> None:
    """Unless its folder is named, too; where there is nothing else, that is an error."""
    write(tmp_path, {
        "p/own.py": "# privacy(/own): mundane\n", "p/vendor.py": "# privacy(/vendor): mundane\n",
        "p/third_party/lib/x.py": "# theirs\n", "p/deep/vendor/y.cpp": "// theirs\n",
    })  # fmt: skip
    done = cli("annotations", "p", cwd=tmp_path)
    assert done.stderr == f"2 annotations of 2 elements in 2 files; {NOT_READ}: p/deep/vendor, p/third_party\n"
    (line,) = refused(cli("annotations", "p/deep", cwd=tmp_path))
    assert line.startswith("p/deep: no Python and no C++ in it ")
    assert "p/deep/vendor" in line
    write(tmp_path, {"p/deep/vendor/y.cpp": "// privacy(/y): mundane\n"})
    done = cli("annotations", "p", "p/deep/vendor", cwd=tmp_path)
    assert (done.returncode, done.stderr.partition(";")[0]) == (0, "3 annotations of 3 elements in 3 files")


LOST = (
    "this annotation is not read, since p/{0} is taken for code of others; name that folder, too, to have it read; "
    "or put a file COLCON_IGNORE into it to leave it out"
)


@pytest.mark.parametrize(
    ("name", "line"),
    [
        ("build/demo/node.py", "# privacy(/camera): source Video"),
        ("vendor/driver.py", "self.pub = make()  # privacy: source Video"),
        ("vendor/driver.cpp", "  // privacy(/camera): source Video"),
        ("install/deep/site-packages/x.hpp", "/* privacy(/camera): source Video */"),
        ("third_party/old.py", "print 'no Python 3'  # privacy: leak Voice"),
        ("vendor/driver.py", "# privacy: source Vidoe"),
    ],
)
def test_an_annotation_in_code_of_others_is_an_error(tmp_path: Path, cli: Cli, name: str, line: str) -> None:
    """Somebody wrote it: dropped, it would hide a source."""
    write(tmp_path, {f"p/{name}": f"\n{line}\n", "p/own.py": "# privacy(/x): mundane\n"})
    done = cli("annotations", "p", cwd=tmp_path)
    folder = name.partition("/")[0]
    assert refused(done) == [f"p/{name}:2: {LOST.format(folder)}"]
    (tmp_path / "p").rename(tmp_path / "q")
    (tmp_path / "q" / folder / "COLCON_IGNORE").touch()
    assert cli("annotations", "q", cwd=tmp_path).returncode == 0


@pytest.mark.parametrize(
    "line",
    ["# Privacy matters: source code", "# privacy: we keep nothing", "privacy: source Video", "x = 'privacy: 1'"],
)
def test_words_of_others_about_privacy_are_no_annotation(tmp_path: Path, cli: Cli, line: str) -> None:
    write(tmp_path, {"p/vendor/x.py": f"{line}\n", "p/own.py": "# privacy(/y): mundane\n"})
    (tmp_path / "p" / "vendor" / "broken.py").write_bytes(b"privacy \xff\x00 (((\n")
    assert cli("annotations", "p", cwd=tmp_path).returncode == 0


def test_what_a_folder_holds(tmp_path: Path, cli: Cli) -> None:
    """Rule S11: links are followed, scripts without an ending count; hidden and ignored folders do not."""
    read = ["a.py", "deep/B.CPP", "deep/c.hpp", "script"]
    unread = [".venv/d.py", "off/e.py", "off/deep/f.cpp", "g.txt", "h"]
    for number, name in enumerate([*read, *unread]):
        file = tmp_path / "p" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        sign = "//" if file.suffix.lower() in (".cpp", ".hpp") else "#"
        start = "#!/usr/bin/env python3\n" if name == "script" else ""
        file.write_text(f"{start}{sign} privacy(/x{number}): mundane\n")
    (tmp_path / "p" / "off" / "COLCON_IGNORE").touch()
    (tmp_path / "far").mkdir()
    (tmp_path / "far" / "i.py").write_text("# privacy(/far): mundane\n")
    (tmp_path / "p" / "linked").symlink_to(tmp_path / "far", target_is_directory=True)
    done = cli("annotations", "p", cwd=tmp_path)
    assert done.stderr == f"5 annotations of 5 elements in 5 files; {NOT_READ}: p/off\n"
    assert [line.split(":")[0].strip() for line in done.stdout.splitlines()[3:]] == ["/far", "/x0", "/x1", "/x2", "/x3"]
    (tmp_path / "p" / "dangling.py").symlink_to(tmp_path / "nowhere")
    for arguments in (["p"], ["p/g.txt"], ["far/nope.py"], ["p/off/nope"], ["no*such.py"]):
        assert cli("annotations", *arguments, cwd=tmp_path).returncode == 2
    assert cli("annotations", "p/.venv/..", cwd=tmp_path).returncode == 2
    assert cli("annotations", "p/off", cwd=tmp_path).stderr == "2 annotations of 2 elements in 2 files\n"  # named


def test_the_namespace_is_that_of_the_option(tmp_path: Path, cli: Cli) -> None:
    (tmp_path / "a.py").write_text("from rclpy.node import Node\n" + NODE.format("conduit"))
    assert "/r1/a: conduit" in cli("annotations", "a.py", "--namespace", "/r1", cwd=tmp_path).stdout
    for wrong in ("r1", "", "/r 1", "~/x"):
        assert cli("annotations", "a.py", "--namespace", wrong, cwd=tmp_path).returncode == 2


def test_cpp_without_its_library_is_told(tmp_path: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "a.cpp").touch()
    monkeypatch.setitem(__import__("sys").modules, "tree_sitter_cpp", None)
    done = cli("annotations", "a.cpp", cwd=tmp_path)
    assert done.returncode == 2
    assert "install the extra [code]" in done.stderr


def test_types_and_literal_names_are_evidence() -> None:
    found = code_evidence(read_sources([str(EXAMPLE)]).codes)
    assert {one.kind for one in found} == {"topic"}
    assert [(one.role, one.name, one.type, one.node) for one in found] == [
        ("publish", "/image_blurred", "sensor_msgs/msg/Image", "/blur"),
        ("publish", "/image", "sensor_msgs/msg/Image", "/camera"),
        ("publish", "/camera_info", "sensor_msgs/msg/CameraInfo", "/camera"),
        ("subscribe", "/image_blurred", "sensor_msgs/msg/Image", "/uplink"),
    ]


def test_own_kinds_take_part(tmp_path: Path, cli: Cli) -> None:
    (tmp_path / "o.ttl").write_text(blocks(CATEGORIES, "turtle")[0])
    (tmp_path / "a.py").write_text("# privacy(/n): source PulseCurve\n")
    assert cli("annotations", "a.py", cwd=tmp_path).returncode == 2
    done = cli("annotations", "a.py", "--ontology", "o.ttl", cwd=tmp_path)
    assert "  /n: {source: [PulseCurve]} # a.py:1" in done.stdout.splitlines()


def test_hostile_names_of_files_reach_no_terminal(tmp_path: Path, cli: Cli) -> None:
    """What stands in a folder was named by anybody; conflicts and differences tell it too."""
    for number, name in enumerate((b"\x1b[31m\n.py", b"\xff\xe2\x80\xae.py")):
        words = ("leak Voice", "conduit Voice")[number]
        (tmp_path / os.fsdecode(name)).write_text(f"# privacy(/n): {words}\n# privacy(/only{number}): mundane\n")
    done = cli("annotations", str(tmp_path), cwd=tmp_path)
    assert (done.returncode, len(done.stderr.splitlines())) == (2, 1)
    assert "/n is" in done.stderr
    assert all(line.isprintable() for line in done.stderr.splitlines())
    (tmp_path / os.fsdecode(b"\xff\xe2\x80\xae.py")).write_text("# privacy(/only1): mundane\n")
    done = cli("annotations", str(tmp_path), "-o", "l.yaml", cwd=tmp_path)
    assert done.returncode == 0
    assert all(line.isprintable() for line in (tmp_path / "l.yaml").read_text().splitlines())
    (tmp_path / "l.yaml").write_text("labels: 1\nchannels: {/only1: sensitive}\n")
    done = cli("annotations", str(tmp_path), "--check", "l.yaml", cwd=tmp_path)
    assert (done.returncode, len(done.stdout.splitlines())) == (1, 3)
    assert all(line.isprintable() for line in done.stdout.splitlines())


def test_one_that_states_its_method_beside_one_that_does_not(tmp_path: Path, cli: Cli) -> None:
    said = ["sanitizer Video", "sanitizer Video pseudonymise"]
    for some in (said, said[::-1]):
        (tmp_path / "a.py").write_text("".join(f"# privacy(/x): {one}\n" for one in some))
        assert "{sanitizer: {Video: pseudonymise}}" in cli("annotations", "a.py", cwd=tmp_path).stdout


def test_long_names_are_told_at_their_line(tmp_path: Path, cli: Cli) -> None:
    (tmp_path / "a.py").write_text(f"# privacy(/{'x' * 1500}): mundane\n")
    assert cli("annotations", "a.py", "-o", "l.yaml", cwd=tmp_path).returncode == 0
    assert cli("annotations", "a.py", "--check", "l.yaml", cwd=tmp_path).returncode == 0
    (tmp_path / "a.py").write_text(f"# privacy(/{'x' * 20_000}): mundane\n")
    assert cli("annotations", "a.py", cwd=tmp_path).stderr.startswith("a.py:1: a name of more than 2000 characters")


def test_the_page_shows_what_is_so(tmp_path: Path, cli: Cli) -> None:
    """Its commands run and write what it shows of code that it shows; its table has every word, in what is read."""
    page = ROOT / "docs" / "annotations.md"
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    for line in (line for block in blocks(page, "console") for line in block.splitlines()):
        assert cli(*shlex.split(line)[1:], cwd=tmp_path).returncode == 0, line
    assert blocks(page, "yaml") == [(tmp_path / LABELS).read_text("utf-8")]
    for language, file in (("python", "camera.py"), ("cpp", "blur.cpp")):
        code = (EXAMPLE / file).read_text("utf-8")
        assert [block for block in blocks(page, language) if block not in code] == []
    shown = re.findall(r"`(privacy(?:\(/\w+\))?: [^`]+)`", page.read_text("utf-8").partition("## What it is about")[0])
    read = [read_annotation(text, Place("a.py", 1), load()) for text in shown]
    assert {one.word for one in read if isinstance(one, Annotation)} == set(WORDS)
    assert all(isinstance(one, Annotation) for one in read)
