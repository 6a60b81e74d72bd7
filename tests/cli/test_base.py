"""``rosprivacy diff`` of source code, also with a revision of git: new ways out and new gaps, whatever the lines."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from typing import TYPE_CHECKING, Any

import pytest

from tests.helpers.ci_files import GIT, committed, planted
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

CODE = "guide_perception/guide_perception/"
LISTENER, UPLOADER, DOOR_SIGN = (f"{CODE}{name}.py" for name in ("listener", "uploader", "door_sign"))
PUBLISHED = '        self.speech.publish(String(data=heard["text"]))\n'
CLOUD = '        requests.post("https://voices.example.com/in", json=heard)\n'
MADE = '        self.speech = self.create_publisher(String, "~/speech", 10)\n'
OPEN = "        self.more = self.create_publisher(String, wanted, 10)\n"


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    """A small robot, committed."""
    return committed(shutil.copytree(ROOT / "examples" / "scan_robot", tmp_path / "robot"))


def edited(file: Path, old: str, new: str) -> None:
    text = file.read_text("utf-8")
    assert old in text
    file.write_text(text.replace(old, new), "utf-8")


def lines_of(file: Path, text: str) -> int:
    return file.read_text("utf-8").splitlines(keepends=True).index(text) + 1


def compared(cli: Cli, robot: Path, *words: str) -> tuple[int, dict[str, Any]]:
    done = cli("diff", ".", "--base", "HEAD", "--format", "json", *words, cwd=robot)
    assert not done.stderr, done.stderr
    return done.returncode, json.loads(done.stdout)


def commit(robot: Path) -> None:
    for words in (["add", "-A"], ["commit", "-qm", "more"]):
        subprocess.run([*GIT, *words], cwd=robot, check=True, capture_output=True)


def with_cloud(robot: Path) -> None:
    edited(robot / LISTENER, "import whisper\n", "import requests\nimport whisper\n")
    edited(robot / LISTENER, PUBLISHED, PUBLISHED + CLOUD)


def with_open_name(robot: Path) -> None:
    edited(robot / LISTENER, "def __init__(self)", "def __init__(self, wanted)")
    edited(robot / LISTENER, MADE, MADE + OPEN)


def test_what_is_as_it_was_passes_although_a_scan_is_undetermined(cli: Cli, robot: Path) -> None:
    code, found = compared(cli, robot)
    assert code == 0
    assert found["verdict"] == {"before": "undetermined", "after": "undetermined"}
    assert cli("diff", ".", "--base", "HEAD", "--fail-on", "any", cwd=robot).returncode == 0


def test_a_new_call_of_a_cloud_fails_at_its_line(cli: Cli, robot: Path) -> None:
    with_cloud(robot)
    code, found = compared(cli, robot)
    assert (code, found["worse"]) == (1, True)
    (row,) = found["ways_out"]["new"]
    assert (row["node"], row["sort"], row["name"]) == ("/guide/listener", "cloud", "voices.example.com")
    assert row["at"] == [f"{LISTENER}:{lines_of(robot / LISTENER, CLOUD)}"]
    assert row["at"][0] in cli("diff", ".", "--base", "HEAD", cwd=robot).stdout
    assert row["at"][0] in cli("diff", ".", "--base", "HEAD", "-f", "markdown", cwd=robot).stdout


def test_a_name_that_is_not_resolved_fails_as_a_gap(cli: Cli, robot: Path) -> None:
    with_open_name(robot)
    code, found = compared(cli, robot)
    assert code == 1
    assert not any(found["ways_out"].values())
    (row,) = found["gaps"]["new"]
    assert (row["sort"], row["file"]) == ("name", LISTENER)
    assert row["at"] == [f"{LISTENER}:{lines_of(robot / LISTENER, OPEN)}"]


def test_a_second_name_that_is_not_resolved_in_the_same_file_fails(cli: Cli, robot: Path) -> None:
    with_open_name(robot)
    commit(robot)
    edited(robot / LISTENER, OPEN, OPEN + OPEN.replace("more", "much"))
    code, found = compared(cli, robot)
    assert code == 1
    (row,) = found["gaps"]["changed"]
    assert (row["before"]["times"], row["after"]["times"]) == (1, 2)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("import rclpy\n", "import rclpy\n\n\n# a comment\n\n"),
        ("wanted", "asked"),
        ("heard", "understood"),
    ],
    ids=["a shifted line", "a name that a gap depends on", "a variable that is logged and sent"],
)
def test_what_means_the_same_passes(old: str, new: str, cli: Cli, robot: Path) -> None:
    with_cloud(robot)
    with_open_name(robot)
    commit(robot)
    edited(robot / LISTENER, old, new)
    code, found = compared(cli, robot)
    assert (code, found["worse"]) == (0, False)
    assert not any(found[section][what] for section in ("ways_out", "gaps") for what in ("new", "gone"))
    assert not found["ways_out"]["changed"]
    depends = [(row["before"]["depends_on"], row["after"]["depends_on"]) for row in found["gaps"]["changed"]]
    assert depends == ([tuple([f"argument {name} of __init__"] for name in (old, new))] if old == "wanted" else [])


def test_another_unknown_name_of_the_same_node_is_changed(cli: Cli, robot: Path) -> None:
    """As much is not known as before: what topic this node writes, with messages of this type (rule S16)."""
    with_open_name(robot)
    edited(robot / LISTENER, "wanted)", "wanted, other)")
    commit(robot)
    edited(robot / LISTENER, "String, wanted", "String, other")
    code, found = compared(cli, robot)
    assert (code, found["worse"], found["gaps"]["new"], found["gaps"]["gone"]) == (0, False, [], [])
    (row,) = found["gaps"]["changed"]
    assert row["about"] == "/guide/listener: the name of a topic (publish std_msgs/msg/String)"
    assert [row[side]["depends_on"] for side in ("before", "after")] == [
        [f"argument {name} of __init__"] for name in ("wanted", "other")
    ]
    assert cli("diff", ".", "--base", "HEAD", "--fail-on", "any", cwd=robot).returncode == 1


@pytest.mark.parametrize(
    ("now", "about"),
    [
        ("create_publisher(AudioStamped, wanted, 10)", "a topic (publish audio_common_msgs/msg/AudioStamped)"),
        ("create_subscription(String, wanted, print, 10)", "a topic (subscribe std_msgs/msg/String)"),
    ],
    ids=["of another type", "in the other direction"],
)
def test_an_unknown_name_of_something_else_is_new(now: str, about: str, cli: Cli, robot: Path) -> None:
    """A node that wrote text to an unknown topic and writes sound to one now lets out more, whatever the name."""
    with_open_name(robot)
    commit(robot)
    edited(robot / LISTENER, "create_publisher(String, wanted, 10)", now)
    code, found = compared(cli, robot)
    assert code == 1
    assert [row["about"] for row in found["gaps"]["new"]] == [f"/guide/listener: the name of {about}"]
    assert len(found["gaps"]["gone"]) == 1


def test_a_class_that_makes_channels_by_itself_in_place_of_another_is_new(cli: Cli, robot: Path) -> None:
    """Each has channels of its own, which are not known."""
    edited(robot / LISTENER, "import whisper\n", "import whisper\nfrom driving import Basic, Careful\n")
    edited(robot / LISTENER, MADE, f"{MADE}        self.drive = Basic(node=self)\n")
    commit(robot)
    edited(robot / LISTENER, "Basic(", "Careful(")
    code, found = compared(cli, robot)
    assert code == 1
    assert [[row["about"].split()[1] for row in found["gaps"][what]] for what in ("new", "gone")] == [
        ["Careful"], ["Basic"]
    ]  # fmt: skip


def test_a_way_out_that_is_gone_passes_and_is_named(cli: Cli, robot: Path) -> None:
    with_cloud(robot)
    with_open_name(robot)
    commit(robot)
    edited(robot / LISTENER, CLOUD, "")
    edited(robot / LISTENER, OPEN, "")
    code, found = compared(cli, robot)
    assert code == 0
    assert [row["name"] for row in found["ways_out"]["gone"]] == ["voices.example.com"]
    assert [row["file"] for row in found["gaps"]["gone"]] == [LISTENER]
    assert cli("diff", ".", "--base", "HEAD", "--fail-on", "any", cwd=robot).returncode == 1


def test_a_call_in_code_that_no_launch_file_starts_counts(cli: Cli, robot: Path) -> None:
    """Something else may start it; that some code is not in the system is an old gap."""
    edited(robot / "guide_bringup/launch/guide.launch.py", '"uploader"', '"camera"')
    commit(robot)
    edited(robot / UPLOADER, "pictures.example.org", "pictures.example.com")
    code, found = compared(cli, robot)
    assert code == 1
    assert [row["name"] for row in found["ways_out"]["new"]] == ["pictures.example.com"]


def test_a_topic_more_at_a_bridge_is_a_way_out(cli: Cli, robot: Path) -> None:
    bridge = "mqtt_client:\n  ros__parameters:\n    broker: {host: broker.example.org}\n    bridge:\n      ros2mqtt:\n"
    one = "        {0}: {{ros_topic: /{0}, mqtt_topic: {0}}}\n"
    names = "        ros_topics: [{}]\n"
    file = planted(robot / "guide_bringup/config/mqtt.yaml", bridge + names.format("speech") + one.format("speech"))
    commit(robot)
    file.write_text(bridge + names.format("speech, faces") + one.format("speech") + one.format("faces"), "utf-8")
    code, found = compared(cli, robot)
    assert code == 1
    assert found["ways_out"]["new"]


def test_two_folders_are_compared_as_a_revision_is(cli: Cli, robot: Path, tmp_path: Path) -> None:
    shutil.copytree(robot, tmp_path / "other", ignore=shutil.ignore_patterns(".git"))
    edited(tmp_path / "other" / LISTENER, "import rclpy\n", "\nimport rclpy\n")
    assert cli("diff", "robot", "other", "--fail-on", "any", cwd=tmp_path).returncode == 0
    with_cloud(tmp_path / "other")
    done = cli("diff", "robot", "other", cwd=tmp_path)
    assert done.returncode == 1
    assert f"other/{LISTENER}:" in done.stdout
    launch = "guide_bringup/launch/guide.launch.py"
    assert cli("diff", f"robot/{launch}", f"other/{launch}", cwd=tmp_path).returncode == 1
    assert cli("diff", launch, "--base", "HEAD", cwd=robot).returncode == 0


def test_code_against_a_policy_says_that_ways_out_are_not_compared(cli: Cli, robot: Path) -> None:
    cli("scan", ".", "-o", "../p.xml", cwd=robot)
    found = json.loads(cli("diff", "../p.xml", ".", "-f", "json", cwd=robot).stdout)
    assert found["ways_out"] is found["gaps"] is None
    assert "ways out: not compared" in cli("diff", "../p.xml", ".", cwd=robot).stdout


def test_labels_are_those_of_each_side(cli: Cli, robot: Path) -> None:
    """Labels of a node that the base has not would be refused there; a new leak is new although the code is old."""
    labels = "labels: 1\nnodes:\n  /guide/camera: {source: [Video]}\n"
    planted(robot / "labels.yaml", labels)
    commit(robot)
    planted(robot / "labels.yaml", f"{labels}  /guide/uploader: {{leak: [Video]}}\n")
    code, found = compared(cli, robot, "-l", "labels.yaml")
    assert code == 1
    assert [row["leak"] for row in found["findings"]["new"]] == ["node /guide/uploader"]


def test_the_files_of_a_revision_are_read_as_git_has_them(
    cli: Cli, robot: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No filter and no hook of the repository runs, and nothing is left behind or changed."""
    trace = tmp_path / "ran"
    planted(robot / ".gitattributes", "*.py filter=evil export-ignore\n")
    commit(robot)
    for name in ("post-checkout", "post-index-change", "reference-transaction"):
        planted(robot / ".git" / "hooks" / name, f"#!/bin/sh\ntouch {trace}\n").chmod(0o755)
    evil = f'[filter "evil"]\n\tsmudge = touch {trace}\n\tclean = touch {trace}\n\trequired = true\n'
    with (robot / ".git" / "config").open("a", encoding="utf-8") as config:
        config.write(f"{evil}[core]\n\tfsmonitor = touch {trace}\n\thooksPath = .git/hooks\n")
    monkeypatch.setenv("TMPDIR", str(planted(tmp_path / "temporary" / "file", "").parent))
    index = (robot / ".git" / "index").read_bytes()
    assert compared(cli, robot)[0] == 0
    assert not trace.exists()
    assert (robot / ".git" / "index").read_bytes() == index
    assert [path.name for path in (tmp_path / "temporary").iterdir()] == ["file"]


def test_odd_names_and_links_out_do_no_harm(cli: Cli, robot: Path, tmp_path: Path) -> None:
    victim = planted(tmp_path / "victim.py", "mine")
    planted(robot / CODE / "a\nb\t'c.py", "x = 1\n")
    planted(robot / CODE / "-q.py", "x = 1\n")
    for name, target in (("out.py", str(victim)), ("up.py", "../../../../victim.py"), ("loop", "loop")):
        (robot / CODE / name).symlink_to(target)
    commit(robot)
    code, found = compared(cli, robot)
    assert code == 0, found["gaps"]
    assert victim.read_text("utf-8") == "mine"


@pytest.mark.parametrize("name", ["..", ".git", ".GIT"])
def test_a_tree_that_no_checkout_can_have_is_refused(name: str, cli: Cli, robot: Path) -> None:
    blob = git(robot, "hash-object", "-w", "--stdin", text="x = 1\n")
    inner = raw_tree(robot, b"100644 evil.py", blob)
    outer = raw_tree(robot, f"40000 {name}".encode(), inner)
    revision = git(robot, "commit-tree", outer, "-m", "evil")
    done = cli("diff", ".", "--base", revision, cwd=robot)
    assert done.returncode == 2
    assert done.stderr.startswith(f"{revision}: ")


def test_nothing_is_written_through_a_link(cli: Cli, robot: Path, tmp_path: Path) -> None:
    """A tree that names a link and a folder by one name, as only a hostile one does."""
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    link = git(robot, "hash-object", "-w", "--stdin", text=str(elsewhere))
    blob = git(robot, "hash-object", "-w", "--stdin", text="x = 1\n")
    inner = raw_tree(robot, b"100644 evil.py", blob)
    both = b"120000 a\0" + bytes.fromhex(link) + b"40000 a\0" + bytes.fromhex(inner)
    tree = git(robot, "hash-object", "-w", "-t", "tree", "--literally", "--stdin", text=both)
    revision = git(robot, "commit-tree", tree, "-m", "evil")
    done = cli("diff", ".", "--base", revision, cwd=robot)
    assert done.returncode == 2
    assert done.stderr.startswith(f"{revision}: ")
    assert not [*elsewhere.iterdir()]


def raw_tree(robot: Path, head: bytes, object_: str) -> str:
    content = head + b"\0" + bytes.fromhex(object_)
    return git(robot, "hash-object", "-w", "-t", "tree", "--literally", "--stdin", text=content)


def git(robot: Path, *words: str, text: str | bytes = b"") -> str:
    given = text.encode() if isinstance(text, str) else text
    done = subprocess.run([*GIT, *words], cwd=robot, input=given, capture_output=True, check=True)
    return done.stdout.decode().strip()


@pytest.mark.parametrize(
    ("words", "problem"),
    [
        (("--base", "nowhere"), "nowhere: "),
        (("new", "--base", "HEAD"), "HEAD:new: "),
        (("..", "--base", "HEAD"), "..: is in no checkout: "),
    ],
)
def test_what_the_base_has_not_is_named(words: tuple[str, ...], problem: str, cli: Cli, robot: Path) -> None:
    shutil.copytree(robot / "guide_perception", robot / "new")
    done = cli("diff", *words, cwd=robot)
    assert done.returncode == 2
    assert done.stderr.startswith(problem)
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize("from_folder", [".", "here", "here/below", "robot/guide_perception"])
def test_the_repository_is_that_in_which_the_state_lies(from_folder: str, cli: Cli, robot: Path) -> None:
    """Wherever somebody works, in another repository or in none; lines lead to the files from there."""
    committed(planted(robot.parent / "here" / "below" / "a.txt", "other").parents[1])
    edited(robot / LISTENER, "import whisper\n", "import requests\nimport whisper\n")
    commit(robot)  # of two commits the other repository has none
    with_calls = robot / LISTENER
    edited(with_calls, PUBLISHED, PUBLISHED + CLOUD)
    folder = robot.parent / from_folder
    name = os.path.relpath(robot, folder)
    for revision in ("HEAD", "HEAD~1"):
        done = cli("diff", name, "--base", revision, "--format", "json", cwd=folder)
        assert (done.returncode, done.stderr) == (1, "")
        (row,) = json.loads(done.stdout)["ways_out"]["new"]
        file, _, line = row["at"][0].rpartition(":")
        assert ((folder / file).resolve(), int(line)) == (with_calls, lines_of(with_calls, CLOUD))
    edited(with_calls, CLOUD, "")
    assert cli("diff", name, "--base", "HEAD", "--fail-on", "any", cwd=folder).returncode == 0
    done = cli("diff", name, "--base", "HEAD~2", cwd=folder)
    assert done.returncode == 2
    assert done.stderr.startswith(f"HEAD~2: is no commit of the checkout {name}; ")


def test_a_repository_in_another_is_the_one_that_counts(cli: Cli, robot: Path) -> None:
    """And of labels each is read as its repository has it, or as it is where it lies in none or in another one."""
    outer = committed(planted(robot.parent / "outer" / "a.txt", "outer").parent)
    inner = committed(shutil.copytree(robot, outer / "inner", ignore=shutil.ignore_patterns(".git")))
    planted(outer / "l.yaml", "labels: 1\nnodes:\n  /guide/camera: {source: [Video]}\n")
    own = planted(inner / "l.yaml", "labels: 1\nnodes:\n  /guide/uploader: conduit\n")
    commit(inner)
    own.write_text("labels: 1\nnodes:\n  /guide/uploader: {leak: [Video]}\n", "utf-8")
    words = ("inner", "--base", "HEAD", "-l", "l.yaml", "-l", "inner/l.yaml", "--format", "json")
    done = cli("diff", *words, cwd=outer)
    assert (done.returncode, done.stderr) == (1, "")
    assert [row["leak"] for row in json.loads(done.stdout)["findings"]["new"]] == ["node /guide/uploader"]


def test_a_repository_that_the_environment_names_is_not_that_of_the_state(
    cli: Cli, robot: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A hook of git runs with such variables."""
    other = committed(planted(robot.parent / "other" / "a.txt", "other").parent)
    monkeypatch.setenv("GIT_DIR", str(other / ".git"))
    done = cli("diff", "robot", "--base", "HEAD", "--fail-on", "any", cwd=robot.parent)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize("words", [(".", ".."), (".", "--old-labels", "l.yaml"), (".", "--as", "usage")])
def test_a_base_is_for_one_state(words: tuple[str, ...], cli: Cli, robot: Path) -> None:
    assert cli("diff", "--base", "HEAD", *words, cwd=robot).returncode == 2
