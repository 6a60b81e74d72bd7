"""A folder is read as a whole: what its launch files start, with names, externals, and what is not known."""

from __future__ import annotations

import gc
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.scan.checkout import chosen, read_checkout, scanned, systems_of
from rosprivacy.ingest.scan.code_roots import root_of
from rosprivacy.ingest.scan.outside.externals import UnitExternal
from rosprivacy.ingest.scan.outside.node_externals import with_externals
from rosprivacy.ingest.scan.scan_facts import CodeNode, CodePlace, External, Gap
from tests.helpers.checkouts import CAMERA, LAUNCH, UPLOADER, put_checkout

if TYPE_CHECKING:
    from pathlib import Path

THREE = LAUNCH.replace("    ])\n", '        Node(package="guide", executable="camera", name="more"),\n    ])\n')
ONE_NODE = LAUNCH.replace('        Node(package="guide", executable="camera", namespace="robot"),\n', "")


def test_a_launch_file_starts_its_nodes_with_their_final_names(tmp_path: Path) -> None:
    (system,) = systems_of(read_checkout(str(put_checkout(tmp_path))))
    assert [node.name for node in system.nodes] == ["/robot/camera", "/uploader"]
    ends = [(end.node, end.role, end.name, end.basis, end.place) for end in system.ends if end.name != "/rosout"]
    assert ends == [
        ("/robot/camera", "publish", "/robot/image", "launch", CodePlace("guide/camera.py", 11)),
        ("/uploader", "subscribe", "/robot/image", "launch", CodePlace("guide/uploader.py", 10)),
    ]


@pytest.mark.parametrize("enabled", [True, False])
def test_a_scan_leaves_the_collector_as_it_was(tmp_path: Path, *, enabled: bool) -> None:
    before = gc.isenabled()
    try:
        (gc.enable if enabled else gc.disable)()
        read_checkout(str(put_checkout(tmp_path)))
        assert gc.isenabled() is enabled
    finally:
        (gc.enable if before else gc.disable)()


def test_what_lies_outside_ros_stands_with_its_node_and_no_key_of_an_address(tmp_path: Path) -> None:
    (system,) = systems_of(read_checkout(str(put_checkout(tmp_path))))
    outside = [(node, one.name) for node, one in system.externals]
    assert ("/uploader", "cloud.example") in outside
    assert "hidden" not in repr(system)


def test_of_several_launch_files_the_one_that_starts_most_counts_and_the_others_are_a_gap(tmp_path: Path) -> None:
    put_checkout(tmp_path, launch__less_dot_launch_dot_py=ONE_NODE)
    checkout, systems = scanned(str(tmp_path))
    system = chosen(checkout, systems)
    assert (system.launch, len(systems)) == ("launch/guide.launch.py", 2)
    assert [(gap.sort, gap.place.file) for gap in system.gaps] == [("system", "launch/less.launch.py")]
    other = chosen(checkout, systems, "launch/less.launch.py")
    assert ([node.name for node in other.nodes], [node.name for node in other.idle]) == (["/uploader"], ["Camera"])
    with pytest.raises(InputErrors, match="name one of"):
        chosen(checkout, systems, "nope.launch.py")


def test_a_node_that_no_launch_file_starts_is_a_gap_at_its_line(tmp_path: Path) -> None:
    more = CAMERA.replace("Camera", "Lamp").replace('"camera"', '"lamp"')
    system = chosen(*scanned(str(put_checkout(tmp_path, guide__lamp_dot_py=more))))
    assert [(gap.sort, gap.place) for gap in system.gaps] == [("system", CodePlace("guide/lamp.py", 7))]
    assert [node.name for node in system.nodes] == ["/robot/camera", "/uploader"]


def test_a_class_of_the_same_name_in_another_file_is_another_node(tmp_path: Path) -> None:
    """As in a package of variants of one script: only what the executable's own file says is so."""
    variant = CAMERA.replace('"image"', '"other_image"')
    system = chosen(*scanned(str(put_checkout(tmp_path, guide__variant_dot_py=variant))))
    assert {end.name for end in system.ends if end.node == "/robot/camera"} == {"/robot/image", "/rosout"}


def test_a_screen_that_no_launch_file_starts_is_in_the_system(tmp_path: Path) -> None:
    """An operator starts it by hand; left out, the way from the camera to it would be lost."""
    screen = UPLOADER.replace("uploader", "screen").replace("Uploader", "Screen").replace('"video"', '"/robot/image"')
    screen = screen.replace("import requests", "import cv2").replace("requests.post(", "cv2.imshow(")
    lamp = CAMERA.replace("Camera", "Lamp").replace('"camera"', '"lamp"')
    put_checkout(tmp_path, guide__screen_dot_py=screen, guide__lamp_dot_py=lamp, launch__guide_dot_launch_dot_py=THREE)
    checkout, systems = scanned(str(tmp_path))
    system = chosen(checkout, systems)
    assert [node.name for node in system.nodes] == ["/more", "/robot/camera", "/screen", "/uploader"]
    assert ("/screen", "subscribe", "/robot/image") in {(end.node, end.role, end.name) for end in system.ends}
    assert [(gap.sort, gap.place.file) for gap in system.gaps] == [
        ("system", "guide/lamp.py"),
        ("system", "guide/screen.py"),
    ]
    assert "/screen" not in {node.name for node in chosen(checkout, systems, "launch/guide.launch.py").nodes}


def test_as_many_nodes_that_no_launch_file_starts_are_added_under_their_names_in_the_code(tmp_path: Path) -> None:
    put_checkout(tmp_path, launch__guide_dot_launch_dot_py=ONE_NODE)
    checkout, systems = scanned(str(tmp_path))
    system = chosen(checkout, systems)
    assert [(gap.sort, gap.place) for gap in system.gaps] == [("system", CodePlace("guide/camera.py", 7))]
    assert [(node.name, node.basis) for node in system.nodes] == [("/camera", "literal"), ("/uploader", "literal")]
    assert ("/camera", "/image") in {(end.node, end.name) for end in system.ends}
    assert system.idle == ()
    named = chosen(checkout, systems, "launch/guide.launch.py")
    assert ([node.name for node in named.nodes], named.gaps) == (["/uploader"], ())


def test_without_launch_files_all_nodes_are_one_system(tmp_path: Path) -> None:
    (put_checkout(tmp_path) / "launch" / "guide.launch.py").unlink()
    (system,) = systems_of(read_checkout(str(tmp_path)))
    assert [node.name for node in system.nodes] == ["/camera", "/uploader"]


def test_a_file_that_changes_is_read_again(tmp_path: Path) -> None:
    before = scanned(str(put_checkout(tmp_path)))
    assert scanned(str(tmp_path)) is before
    put_checkout(tmp_path, launch__guide_dot_launch_dot_py=ONE_NODE)
    assert len(scanned(str(tmp_path))[1][0].nodes) == 1


def test_other_languages_are_a_gap(tmp_path: Path) -> None:
    checkout = read_checkout(str(put_checkout(tmp_path, src__main_dot_rs="fn main() {}")))
    assert [(gap.sort, gap.place.file) for gap in checkout.facts.gaps] == [("file", "src/main.rs")]


def test_tests_are_left_out_and_listed(tmp_path: Path) -> None:
    checkout = read_checkout(str(put_checkout(tmp_path, test__test_camera_dot_py="import rclpy")))
    assert checkout.left_out == ("test",)


def test_a_launch_file_that_another_one_includes_is_a_system_where_it_is_named(tmp_path: Path) -> None:
    include = "<launch><include file='$(find-pkg-share guide)/launch/guide.launch.py'/></launch>"
    put_checkout(tmp_path, launch__all_dot_launch_dot_xml=include)
    assert [system.launch for system in scanned(str(tmp_path))[1]] == ["launch/all.launch.xml"]
    for name in ("launch/guide.launch.py", str(tmp_path / "launch/guide.launch.py")):
        system = chosen(*scanned(str(tmp_path), launch=name), name)
        assert (system.launch, len(system.nodes)) == ("launch/guide.launch.py", 2)


def test_a_folder_with_a_policy_is_no_folder_of_sources(tmp_path: Path) -> None:
    put_checkout(tmp_path)
    assert root_of(str(tmp_path)) == (str(tmp_path), "")
    policy = '<policy version="0.2.0"><enclaves/></policy>'
    (tmp_path / "robot.policy.xml").write_text(policy)
    assert root_of(str(tmp_path)) is None
    assert root_of(str(tmp_path), granted=True) == (str(tmp_path), "")


def test_a_launch_file_leads_to_its_package_and_those_beside_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    put_checkout(tmp_path / "src" / "guide")
    assert root_of("src/guide/launch/guide.launch.py") == ("src/guide", "launch/guide.launch.py")
    put_checkout(tmp_path / "src" / "other")
    assert root_of("src/guide/launch/guide.launch.py") == ("src", "guide/launch/guide.launch.py")


CLOUD = External(CodePlace("client.py", 3), "api.example", "cloud")
NODE = CodeNode(CodePlace("pkg/talk.py", 1), "Talk", "python", ())


@pytest.mark.parametrize("imported", ["client.Client", "client", ".client.Client", "pkg.helper"])
def test_what_a_file_uses_is_of_the_node_whose_file_imports_it(imported: str) -> None:
    imports = {"pkg/talk.py": [imported], "pkg/helper.py": ["client.Client"], "client.py": []}
    if imported.startswith("."):
        imports = {"pkg/talk.py": [imported], "pkg/client.py": []}
    external = CLOUD if "client.py" in imports else CLOUD._replace(place=CodePlace("pkg/client.py", 3))
    (node,), gaps = with_externals([NODE], [UnitExternal("Client", external)], imports)
    assert (node.externals, gaps) == ((external,), [])


def test_what_no_node_uses_is_a_gap_at_its_line() -> None:
    (node,), (gap,) = with_externals([NODE], [UnitExternal("", CLOUD)], {"pkg/talk.py": ["os"], "client.py": []})
    assert node.externals == ()
    assert gap == Gap(CLOUD.place, "outside", gap.text)


def test_a_class_keeps_what_it_uses_beside_another_of_its_file() -> None:
    other = NODE._replace(name="Other")
    nodes, _ = with_externals(
        [NODE, other], [UnitExternal("Talk", CLOUD._replace(place=CodePlace("pkg/talk.py", 9)))], {}
    )
    assert [len(node.externals) for node in nodes] == [1, 0]


def test_what_many_nodes_may_use_is_a_gap_and_not_many_times_many_facts() -> None:
    nodes = [NODE._replace(name=f"Talk{number}") for number in range(33)]
    external = CLOUD._replace(place=CodePlace("pkg/talk.py", 1))
    with_them, gaps = with_externals(nodes, [UnitExternal("", external)], {})
    assert not any(node.externals for node in with_them)
    assert [(gap.sort, gap.place) for gap in gaps] == [("node-of", external.place)]


APART = LAUNCH.replace('package="guide", executable="camera"', 'package="lens", executable="camera"')


def test_a_launch_file_of_one_folder_starts_nodes_of_another(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    put_checkout(tmp_path / "app", launch__guide_dot_launch_dot_py=APART)
    put_checkout(tmp_path / "drivers" / "lens")
    for file in ("package.xml", "setup.py"):
        path = tmp_path / "drivers" / "lens" / file
        path.write_text(path.read_text().replace('"guide"', '"lens"').replace("<name>guide", "<name>lens"))
    (tmp_path / "drivers" / "lens" / "launch" / "guide.launch.py").unlink()
    monkeypatch.chdir(tmp_path)
    checkout, systems = scanned("app", "drivers")
    system = chosen(checkout, systems)
    code = {node.name: node.place.file for node in system.nodes}
    assert code["/robot/camera"] == "drivers/lens/guide/camera.py"
    assert (checkout.folder, system.launch) == (".", "app/launch/guide.launch.py")


def test_of_several_folders_each_brings_the_launch_file_that_starts_most(tmp_path: Path) -> None:
    for name in ("one", "two"):
        put_checkout(tmp_path / name, launch__less_dot_launch_dot_py=ONE_NODE)
    system = chosen(*scanned(str(tmp_path / "one"), str(tmp_path / "two")))
    assert (system.launch, system.besides) == ("one/launch/guide.launch.py", ("two/launch/guide.launch.py",))
    assert [gap.place.file for gap in system.gaps if gap.sort == "system"] == ["one/launch/less.launch.py"]


@pytest.mark.parametrize("started", ["flash.py", "flash"])
def test_a_file_that_nothing_installs_is_guessed_with_its_place(tmp_path: Path, started: str) -> None:
    code = CAMERA.replace("Camera", "Flash").replace('"camera"', '"flash"').replace('"image"', '"light"')
    launch = LAUNCH.replace('executable="camera"', f'executable="{started}"')
    put_checkout(tmp_path, scripts__flash_dot_py=code, launch__guide_dot_launch_dot_py=launch)
    system = chosen(*scanned(str(tmp_path)))
    assert [end.basis for end in system.ends if end.name == "/robot/light"] == ["guessed"]
    (gap,) = (gap for gap in system.gaps if gap.sort == "started")
    assert "scripts/flash.py" in gap.text


def test_a_binary_file_that_is_called_as_source_is_a_gap_by_its_name(tmp_path: Path) -> None:
    put_checkout(tmp_path)
    for name in ("firmware.cpp", "model.py"):
        (tmp_path / name).write_bytes(b"int x;\0\xff\xfe")
    gaps = read_checkout(str(tmp_path)).facts.gaps
    assert [(gap.place.file, gap.sort) for gap in gaps] == [("firmware.cpp", "file"), ("model.py", "file")]
