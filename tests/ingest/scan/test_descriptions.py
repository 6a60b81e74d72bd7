"""Descriptions of nodes (NoDL) state channels at their lines and join the code that they speak of."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy.ingest.scan.checkout import chosen, read_checkout, systems_of
from rosprivacy.ingest.scan.code_roots import root_of
from tests.helpers.checkouts import put_checkout

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.ingest.scan.systems import ScannedSystem

HEAD = "nodl_version: 2\n"
QOS = "    qos: {history: SYSTEM_DEFAULT, reliability: SYSTEM_DEFAULT}\n"
IMAGE = HEAD + "publishers:\n  - name: image\n    type: sensor_msgs/Image\n" + QOS
ALL = HEAD + "".join(
    f"{section}:\n  - name: /{section}\n    type: a/{sort}/T\n"
    for section, sort in (
        ("publishers", "msg"),
        ("subscriptions", "msg"),
        ("service_servers", "srv"),
        ("service_clients", "srv"),
        ("action_servers", "action"),
        ("action_clients", "action"),
    )
)
FIRST = """<interface version="1">
  <node name="eye" executable="camera">
    <parameter name="rate" type="int"/>
    <topic name="image" type="sensor_msgs/msg/Image" role="publisher"/>
    <service name="~/save" type="a/srv/Save" role="both"/>
  </node>
  <node name="ear" executable="microphone"><action name="/hear" type="a/action/Hear" role="client"/></node>
</interface>
"""


def put(folder: Path, **files: str) -> Path:
    """Write files, with ``__`` for ``/`` and ``_dot_`` for a dot."""
    for name, text in files.items():
        file = folder / name.replace("_at_", "__").replace("_in_", "/").replace("_dot_", ".")
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, "utf-8")
    return folder


def including(*references: str, text: str = HEAD) -> str:
    return text + "include:\n" + "".join(f"  - ref: {one}\n" for one in references)


def system_of(folder: Path) -> ScannedSystem:
    checkout = read_checkout(str(folder))
    return chosen(checkout, systems_of(checkout))


def ends(system: ScannedSystem) -> list[tuple[str, ...]]:
    return [(end.node, end.role, end.name, end.basis) for end in system.ends if end.name != "/rosout"]


def gaps(system: ScannedSystem) -> list[tuple[str, str, int]]:
    return [(gap.sort, gap.place.file, gap.place.line) for gap in system.gaps]


def test_each_section_is_a_right_at_its_line_with_its_type(tmp_path: Path) -> None:
    system = system_of(put(tmp_path, cam_dot_nodl_dot_yaml=ALL))
    stated = [(end.role, end.name, end.type, end.basis, end.place.line) for end in system.ends if end.name != "/rosout"]
    assert sorted(stated, key=lambda one: one[4]) == [
        ("publish", "/publishers", "a/msg/T", "description", 3),
        ("subscribe", "/subscriptions", "a/msg/T", "description", 6),
        ("reply", "/service_servers", "a/srv/T", "description", 9),
        ("request", "/service_clients", "a/srv/T", "description", 12),
        ("execute", "/action_servers", "a/action/T", "description", 15),
        ("call", "/action_clients", "a/action/T", "description", 18),
    ]


def test_of_a_node_that_only_a_description_speaks_of_what_is_not_told_is_a_gap(tmp_path: Path) -> None:
    system = system_of(put(tmp_path, cam_dot_nodl_dot_yaml=IMAGE))
    assert [(node.name, node.basis) for node in system.nodes] == [("/cam", "guessed")]
    assert gaps(system) == [("description", "cam.nodl.yaml", 1)]
    assert ("/cam", "/rosout", "package") in {(end.node, end.name, end.basis) for end in system.ends}


def test_a_launch_file_gives_a_described_node_its_name_its_namespace_and_its_remappings(tmp_path: Path) -> None:
    start = "<node pkg='eyes' exec='cam' name='left' namespace='/r'><remap from='image' to='/faces'/></node>"
    manifest = "<package format='3'><name>eyes</name></package>"
    put(
        tmp_path,
        cam_dot_nodl_dot_yaml=IMAGE,
        package_dot_xml=manifest,
        a_dot_launch_dot_xml=f"<launch>{start}</launch>",
    )
    system = system_of(tmp_path)
    assert ends(system) == [("/r/left", "publish", "/faces", "launch")]
    assert [(gap.sort, gap.place.file) for gap in system.gaps] == [("description", "cam.nodl.yaml")]


def test_a_description_adds_to_the_code_that_it_speaks_of(tmp_path: Path) -> None:
    more = IMAGE + "  - {name: ~/faces, type: a/msg/Faces}\n"
    system = system_of(put(put_checkout(tmp_path), camera_dot_nodl_dot_yaml=more))
    assert [node.name for node in system.nodes] == ["/robot/camera", "/uploader"]
    of_camera = [(end.name, end.place.file, end.place.line) for end in system.ends if end.node == "/robot/camera"]
    assert of_camera == [
        ("/robot/camera/faces", "camera.nodl.yaml", 6),
        ("/robot/image", "camera.nodl.yaml", 3),
        ("/robot/image", "guide/camera.py", 11),
        ("/rosout", "guide/camera.py", 7),
    ]
    assert "description" not in {gap.sort for gap in system.gaps}


def test_a_package_registers_a_description_under_a_name_of_its_own(tmp_path: Path) -> None:
    manifest = "<package format='3'><name>eyes</name></package>"
    cmake = "project(eyes)\nament_nodl_register(driver\n  FILE nodl/x.nodl.yaml)\n"
    put(tmp_path, package_dot_xml=manifest, CMakeLists_dot_txt=cmake, nodl_in_x_dot_nodl_dot_yaml=IMAGE)
    put(tmp_path, main_dot_nodl_dot_yaml=including("nodl://eyes/driver"))
    assert ends(system_of(tmp_path)) == [("/main", "publish", "/image", "description")]


def test_an_ament_index_is_read_by_its_keys_and_a_copy_beside_it_is_not_a_second_node(tmp_path: Path) -> None:
    index = tmp_path / "share" / "ament_index" / "resource_index" / "nodl"
    put(index, eyes_at_lens=IMAGE, eyes_at_driver=including("nodl://eyes/lens"))
    put(tmp_path / "share" / "eyes" / "nodl", lens_dot_nodl_dot_yaml=IMAGE)
    for folder in (tmp_path, index):
        assert root_of(str(folder)) == (str(folder), "")
        assert ends(system_of(folder)) == [("/driver", "publish", "/image", "description")]


def test_a_part_of_another_is_no_node_of_its_own_unless_something_runs_by_its_name(tmp_path: Path) -> None:
    put(tmp_path, base_dot_nodl_dot_yaml=IMAGE, cam_dot_nodl_dot_yaml=including("local://base.nodl.yaml"))
    system = system_of(tmp_path)
    assert [node.name for node in system.nodes] == ["/cam"]
    assert ("description", "base.nodl.yaml", 1) in gaps(system)
    cmake = "project(eyes)\nadd_executable(base src/base.cpp)\n"
    put(tmp_path, package_dot_xml="<package format='3'><name>eyes</name></package>", CMakeLists_dot_txt=cmake)
    assert [node.name for node in system_of(tmp_path).nodes] == ["/base", "/cam"]


@pytest.mark.parametrize(
    ("files", "expected"),
    [
        ({"a": including("local://a.nodl.yaml")}, [("include", "a.nodl.yaml", 3)]),
        ({"a": including("local://b.nodl.yaml"), "b": including("local://a.nodl.yaml")},
         [("include", "b.nodl.yaml", 3)]),
        ({"a": including("nodl://other/lens")}, [("include", "a.nodl.yaml", 3)]),
        ({"a": including("local://../../../etc/passwd")}, [("include", "a.nodl.yaml", 3)]),
        ({"a": including("https://nodes.example/x")}, [("include", "a.nodl.yaml", 3)]),
        ({"a": HEAD + "include: [{}]\n"}, [("include", "a.nodl.yaml", 2)]),
        ({"a": HEAD + "publisher: []\n"}, [("file", "a.nodl.yaml", 2)]),
        ({"a": HEAD + "publishers: {}\n"}, [("file", "a.nodl.yaml", 2)]),
        ({"a": HEAD + "publishers: [{type: a/msg/A}]\n"}, [("name", "a.nodl.yaml", 2)]),
        ({"a": HEAD + "publishers: [{name: 'a b', type: a/msg/A}]\n"}, [("name", "a.nodl.yaml", 2)]),
        ({"a": HEAD + "publishers: [{name: a, type: a/srv/A}]\n"}, [("file", "a.nodl.yaml", 2)]),
    ],
)  # fmt: skip
def test_what_is_not_understood_is_one_gap_at_its_line(
    tmp_path: Path, files: dict[str, str], expected: list[tuple[str, str, int]]
) -> None:
    system = system_of(put(tmp_path, **{f"{name}_dot_nodl_dot_yaml": text for name, text in files.items()}))
    assert [gap for gap in gaps(system) if gap[0] != "description"] == expected
    assert [node.name for node in system.nodes] == ["/a"]


BOMB = "".join(f"a{at}: &a{at} [{', '.join([f'*a{at - 1}'] * 8)}]\n" for at in range(1, 30))


@pytest.mark.parametrize(
    ("text", "line"),
    [("nodl_version: 1\n", 1), ("a: ]", 1), ("", 1), ("- 1\n", 1), (HEAD + BOMB, 2), ("[" * 9000, 1), ("\0", 1),
     ("nodl_version: '2'\n", 1), ("<interface/>", 1)],
)  # fmt: skip
def test_what_is_no_description_is_a_gap_and_no_node(tmp_path: Path, text: str, line: int) -> None:
    system = system_of(put(tmp_path, a_dot_nodl_dot_yaml=text))
    assert (gaps(system), system.nodes) == ([("file", "a.nodl.yaml", line)], ())


def test_a_long_chain_and_many_that_include_it_end(tmp_path: Path) -> None:
    for at in range(400):
        put(tmp_path, **{f"c{at:03}_dot_nodl_dot_yaml": including(f"local://c{at + 1:03}.nodl.yaml")})
    put(tmp_path, c400_dot_nodl_dot_yaml=IMAGE)
    for at in range(100):
        put(tmp_path, **{f"m{at:02}_dot_nodl_dot_yaml": including("local://c000.nodl.yaml")})
    assert len(ends(system_of(tmp_path))) == 100


def test_the_first_version_names_its_nodes(tmp_path: Path) -> None:
    system = system_of(put(tmp_path, a_dot_nodl_dot_xml=FIRST))
    assert [(node.name, node.basis, node.place.line) for node in system.nodes] == [
        ("/ear", "description", 7), ("/eye", "description", 2),
    ]  # fmt: skip
    assert ends(system) == [
        ("/ear", "call", "/hear", "description"),
        ("/eye", "publish", "/image", "description"),
        ("/eye", "reply", "/eye/save", "description"),
        ("/eye", "request", "/eye/save", "description"),
    ]


@pytest.mark.parametrize(
    "text",
    ["<interface version='2'/>", "<interface", '<!DOCTYPE a [<!ENTITY b "c">]><interface version="1"/>', "<a/>"],
)
def test_what_is_no_description_of_the_first_version_is_a_gap(tmp_path: Path, text: str) -> None:
    system = system_of(put(tmp_path, a_dot_nodl_dot_xml=text))
    assert (gaps(system), system.nodes) == ([("file", "a.nodl.xml", 1)], ())


def test_a_file_that_is_named_is_described_alone(tmp_path: Path) -> None:
    put(put_checkout(tmp_path), camera_dot_nodl_dot_yaml=IMAGE)
    folder, file = root_of(str(tmp_path / "camera.nodl.yaml")) or ("", "")
    checkout = read_checkout(folder)
    system = chosen(checkout, systems_of(checkout), file)
    assert ends(system) == [("/camera", "publish", "/image", "description")]
