"""Labels on a system: names that match nothing, and which of two labels wins (rule S11)."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

import rosprivacy
from rosprivacy.ingest.labels.entries import specificity

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

from tests.helpers.label_files import SYSTEM, VIDEO, analyse, wrong


def roles(analysis: Any, name: str, category: str = "Video") -> set[str]:
    """The roles that hold of an element, its legs put together."""
    return {role for element, said in analysis.roles.items() if element.name == name for role in said.get(category, ())}


@pytest.mark.parametrize(
    ("section", "name", "message"),
    [
        ("nodes", "/camara", "matches no node of the policies; did you mean /camera?"),
        ("nodes", "/Camera", "did you mean /camera?"),
        ("nodes", "/cam", "did you mean /camera?"),
        ("nodes", "/camara*", "did you mean /camera?"),
        ("nodes", "/qqqqqqqqqqqqq", "see the names with rosprivacy labels --init"),
        ("channels", "/imaeg", "matches no topic or service or action of the policies; did you mean /image"),
        ("topics", "/claen", "matches no topic of the policies; did you mean /clean"),
        # a name in the wrong section: say which is the right one
        ("nodes", "/image", "there is a topic of that name: move it to the section for it"),
        ("nodes", "/snap", "there is a service of that name"),
        ("channels", "/camera", "there is a node of that name"),
        ("topics", "/snap", "there is a service of that name"),
        ("services", "/spin", "action of that name: move it"),
    ],
)
def test_a_name_that_matches_nothing_is_refused_with_the_nearest(
    tmp_path: Path, section: str, name: str, message: str
) -> None:  # S11: never silence
    (line,) = wrong(tmp_path, f"labels: 1\n{section}:\n  {json.dumps(name)}:\n")
    assert line.startswith(f"1.yaml:3: {name!r} ")
    assert message in line


@pytest.mark.parametrize(
    ("flow", "message"),
    [
        ("from: /camera, to: /clean", "no flow goes from '/camera' to '/clean'"),
        ("from: /image, to: /camera", "no flow goes from '/image' to '/camera'"),  # in its direction
        ("from: /camara, to: /image", "/camera"),  # S11: with the nearest existing names
        ("from: /camera, to: /imaeg", "/image"),
    ],
)
def test_a_flow_that_is_not_there_is_refused_with_the_nearest(tmp_path: Path, flow: str, message: str) -> None:
    (line,) = wrong(tmp_path, f"labels: 1\nflows:\n  - {{{flow}, never: [Video]}}")
    assert line.startswith("1.yaml:3: ")
    assert message in line


@pytest.mark.parametrize(
    ("channels", "message"),
    [
        ("[/imaeg]", "'/camera' writes to no channel '/imaeg'; did you mean /image"),
        ("[/image, /clean]", "'/camera' writes to no channel '/clean'"),
        ("['/x*']", "'/camera' writes to no channel '/x*'"),
    ],
)
def test_a_source_through_a_channel_that_it_does_not_write_is_refused(
    tmp_path: Path, channels: str, message: str
) -> None:
    (line,) = wrong(tmp_path, f"labels: 1\nnodes:\n  /camera: {{source: {{Video: {channels}}}}}")
    assert line.startswith(f"1.yaml:3: {message}")


def test_problems_of_all_label_files_are_reported_at_once(tmp_path: Path) -> None:
    found = wrong(tmp_path, "labels: 1\nnodes: {/x: conduit, /y: conduit}", "labels: 1\n\nnodes: {/z: conduit}")
    assert [line.split(": ")[0] for line in found] == ["1.yaml:2", "1.yaml:2", "2.yaml:3"]
    found = wrong(tmp_path, "labels: 2", "labels: 3")
    assert [line.split(": ")[0] for line in found] == ["1.yaml:1", "2.yaml:1"]


def test_a_shipped_file_may_name_what_is_not_there(tmp_path: Path) -> None:
    (tmp_path / "s.yaml").write_text("labels: 1\ntopics: {/none: mundane}")
    analyse(tmp_path, standard_channels=str(tmp_path / "s.yaml"))
    assert "matches no topic" in wrong(tmp_path, (tmp_path / "s.yaml").read_text())[0]


@pytest.mark.slow
def test_a_label_file_of_another_system_is_refused_soon(cli: Cli, tmp_path: Path) -> None:
    names = range(1500)
    profiles = "".join(f'<profile ns="/robot_{i:04}" node="camera_driver"/>' for i in names)
    enclave = f'<enclave path="/e"><profiles>{profiles}</profiles></enclave>'
    (tmp_path / "p.xml").write_text(f'<policy version="0.2.0"><enclaves>{enclave}</enclaves></policy>')
    lines = "".join(f"  /robt_{i:04}/camera_drver: conduit\n" for i in names)
    (tmp_path / "l.yaml").write_text(f"labels: 1\nnodes:\n{lines}")
    done = cli("analyze", "p.xml", "--labels", "l.yaml", cwd=tmp_path, seconds=30)
    assert done.returncode == 2
    first, *rest = done.stderr.splitlines()
    assert "another robot" in first
    assert len(rest) == len(names)


@pytest.mark.parametrize(
    ("labels", "role"),
    [
        (["nodes: {'*': conduit, /filter: {leak: [Video]}}"], "leak"),  # a specific name beats a glob
        (["nodes: {/filter: {leak: [Video]}}", "nodes: {'*': conduit}"], "leak"),  # in whatever file and order
        (["nodes: {'*': conduit}", "nodes: {/filter: {leak: [Video]}}"], "leak"),
        (["nodes: {'*': conduit, '/fil*': {leak: [Video]}}"], "leak"),  # the more that is spelt out
        (["nodes: {'/fil*': conduit, '*': {leak: [Video]}}"], "leak conduit"),  # which takes nothing away
        (["nodes: {/filter: {leak: [PersonalData], conduit: [Video]}}"], "leak conduit"),
        (["nodes: {/filter: {leak: [Video], conduit: [PersonalData]}}"], "leak"),  # S7: the nearest wins
        (["nodes: {'/fil*': {sanitizer: {Video: drop}}, /filter: conduit}"], "conduit"),
        (["nodes: {'/fil*': {leak: [Video]}, /filter: {leak: none, conduit: [Video]}}"], "conduit"),
    ],
)
def test_the_higher_rank_wins(tmp_path: Path, labels: list[str], role: str) -> None:
    texts = [f"labels: 1\n{text}" for text in labels]
    source = "labels: 1\nnodes: {/camera: {source: [Video]}}"
    assert roles(analyse(tmp_path, source, *texts), "/filter") == set(role.split())


@pytest.mark.parametrize(
    ("name", "role"), [("/rosout", "sensitive"), ("*/rosout", "sensitive"), ("*", "mundane"), ("/ros*", "mundane")]
)
def test_a_users_full_name_outranks_the_standard_file_and_so_does_a_glob_with_its_end_written_out(
    tmp_path: Path, name: str, role: str
) -> None:  # S13
    assert roles(analyse(tmp_path, VIDEO), "/rosout") == {"mundane"}
    assert roles(analyse(tmp_path, f"{VIDEO}\ntopics: {{'{name}': sensitive}}"), "/rosout") == {role}


def test_a_shipped_file_that_a_user_names_does_not_outrank_his_own(tmp_path: Path) -> None:
    (tmp_path / "p.xml").write_text(SYSTEM.replace("clean", "tf_static"))
    (tmp_path / "l.yaml").write_text(f"{VIDEO}\ntopics: {{'/*': sensitive}}")
    for files in (["l.yaml", "rosprivacy:infrastructure"], ["rosprivacy:infrastructure", "l.yaml"]):
        paths = [str(tmp_path / file) if file == "l.yaml" else file for file in files]
        result = rosprivacy.analyze([str(tmp_path / "p.xml")], paths)
        assert roles(result.analysis, "/tf_static") == {"sensitive"}


def test_a_name_outranks_every_glob() -> None:
    assert specificity("/a") > specificity("/" + "a" * 5000 + "*")


@pytest.mark.parametrize("glob", ["/[a-zA-Z0-9_]*", "/[!x]*", "/[abcdefghijk]*"])
def test_a_bracket_is_one_character_however_long_it_is_written(glob: str) -> None:  # it covers more, not less
    assert specificity(glob) < specificity("/cam*")
