"""A system is what a launch file starts: final names, ends with their line, and a gap for what has no name."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.model import Place
from rosprivacy.analysis.suggesting.packages import Interface, Package, PackageNode, Source
from rosprivacy.ingest.scan.scan_facts import (
    CodeEndpoint,
    CodeFacts,
    CodeNode,
    CodePlace,
    CodeWrapper,
    Executable,
    Gap,
    LaunchedSystem,
    NamePiece,
    StartedNode,
)
from rosprivacy.ingest.scan.started_code import CodeIndex
from rosprivacy.ingest.scan.systems import ScannedSystem, launched_system, whole_system

FILE, LAUNCH = "cam/cam.py", "cam/launch/cam.launch.py"
IMAGE = "sensor_msgs/msg/Image"


def named(text: str | None, **more: str) -> tuple[NamePiece, ...]:
    return (NamePiece(text, **more),)


def camera(*ends: CodeEndpoint, name: str | None = "camera", **more: object) -> CodeNode:
    return CodeNode(CodePlace(FILE, 3), "Camera", "python", (named(name),), endpoints=ends, **more)  # type: ignore[arg-type]


def publisher(name: str | None, line: int = 5, role: str = "publish", **more: str) -> CodeEndpoint:
    return CodeEndpoint(CodePlace(FILE, line), role, (named(name, **more),), IMAGE)


def started(node: CodeNode, **launch: object) -> ScannedSystem:
    """The system of one node that a launch file starts."""
    facts = CodeFacts((node,))
    index = CodeIndex((node,), [Executable("cam", "cam", (FILE,), "main")], lambda _: "Camera()")
    start = StartedNode(CodePlace(LAUNCH, 7), "cam", "cam", **launch)  # type: ignore[arg-type]
    return launched_system(facts, index, LaunchedSystem(LAUNCH, (start,)))


def channels(system: ScannedSystem) -> list[tuple[str, str, str]]:
    return [(end.node, end.name, end.basis) for end in system.ends if end.name != "/rosout"]


@pytest.mark.parametrize(
    ("written", "launch", "node", "name", "known"),
    [
        ("image", {}, "/camera", "/image", "literal"),
        ("/image", {"namespace": "/robot"}, "/robot/camera", "/image", "literal"),
        ("image", {"namespace": "robot"}, "/robot/camera", "/robot/image", "launch"),
        ("~/image", {}, "/camera", "/camera/image", "literal"),
        ("~/image", {"name": "eye"}, "/eye", "/eye/image", "launch"),
        ("image", {"name": "eye"}, "/eye", "/image", "literal"),
        ("image", {"remaps": (("image", "video"),)}, "/camera", "/video", "launch"),
        ("image", {"remaps": (("/image", "/a"), ("image", "/b"))}, "/camera", "/a", "launch"),
        ("image", {"namespace": "/r", "remaps": (("image", "video"),)}, "/r/camera", "/r/video", "launch"),
        ("image", {"remaps": (("other:image", "/a"), ("camera:image", "/b"))}, "/camera", "/b", "launch"),
        ("image", {"remaps": (("__node", "eye"), ("__ns", "/r"))}, "/r/eye", "/r/image", "launch"),
        ("image", {"remaps": (("rosservice://image", "/a"),)}, "/camera", "/image", "literal"),
        ("image", {"namespace": "/r", "basis": "default"}, "/r/camera", "/r/image", "default"),
    ],
)
def test_names_are_those_of_the_running_node(
    written: str, launch: dict[str, object], node: str, name: str, known: str
) -> None:
    assert channels(started(camera(publisher(written)), **launch)) == [(node, name, known)]


def test_a_name_that_the_code_makes_of_the_name_of_the_node_follows_the_launch_file() -> None:
    end = publisher("camera", basis="default", parameter="__node")
    assert channels(started(camera(end), name="eye")) == [("/eye", "/eye", "launch")]
    assert channels(started(camera(end))) == [("/camera", "/camera", "default")]


def test_a_parameter_of_the_launch_file_fills_the_name() -> None:
    end = publisher("image", basis="default", parameter="topic")
    assert channels(started(camera(end))) == [("/camera", "/image", "default")]
    assert channels(started(camera(end), parameters=(("topic", "faces"),))) == [("/camera", "/faces", "launch")]


@pytest.mark.parametrize(("role", "kind"), [("reply", "service"), ("call", "action")])
def test_services_and_actions_are_renamed_too(role: str, kind: str) -> None:
    system = started(camera(publisher("go", role=role)), remaps=(("go", "/gone"),))
    assert [(end.kind, end.name) for end in system.ends if end.role == role] == [(kind, "/gone")]


def test_several_names_are_several_ends() -> None:
    end = CodeEndpoint(CodePlace(FILE, 5), "publish", (named("a"), named("b")))
    assert [name for _, name, _ in channels(started(camera(end)))] == ["/a", "/b"]


@pytest.mark.parametrize("name", [None, "", "a b", "{}"])
def test_what_has_no_name_is_a_gap_at_its_line(name: str | None) -> None:
    system = started(camera(publisher(name, 9)))
    assert channels(system) == []
    assert [(gap.sort, gap.place) for gap in system.gaps] == [("name", CodePlace(FILE, 9))]


NAMES = st.lists(st.one_of(st.none(), st.text(max_size=8)), max_size=3)


@given(st.lists(NAMES, max_size=4), st.text(max_size=5), st.lists(st.tuples(st.text(max_size=4), st.text(max_size=4))))
def test_each_call_gives_an_end_or_a_gap(
    calls: list[list[str | None]], space: str, rules: list[tuple[str, str]]
) -> None:
    ends = [CodeEndpoint(CodePlace(FILE, n), "publish", tuple(map(named, call))) for n, call in enumerate(calls, 10)]
    system = started(camera(*ends), namespace=space, remaps=tuple(rules))
    there = {end.place for end in system.ends} | {gap.place for gap in system.gaps}
    unnamed = any(gap.sort == "node" for gap in system.gaps)  # then all its ends hang on that gap
    assert unnamed or {end.place for end in ends} <= there


def test_what_a_launch_file_leaves_open_is_a_gap() -> None:
    renamed = started(camera(publisher("image")), remaps=(("image", "/{robot}/image"),))
    assert [gap.sort for gap in renamed.gaps] == ["name"]
    spaced = started(camera(publisher("image")), namespace="/{robot}")
    assert ([gap.sort for gap in spaced.gaps], channels(spaced)[0][1]) == (["node"], "/image")


def test_a_node_without_a_name_stands_under_its_class_and_is_a_gap() -> None:
    system = started(camera(publisher("image"), name=None))
    assert [(node.name, node.basis) for node in system.nodes] == [("/Camera", "guessed")]
    assert [gap.sort for gap in system.gaps] == ["node"]


def test_a_wrapper_is_a_gap() -> None:
    wrapper = CodeWrapper(CodePlace(FILE, 8), "BasicNavigator")
    system = started(camera(wrappers=(wrapper,)))
    assert [(gap.sort, gap.place.line) for gap in system.gaps] == [("wrapper", 8)]


def test_channels_below_a_name_are_those_that_others_use() -> None:
    image = publisher("image")._replace(below=True)
    reader = publisher("image/compressed", 6, "subscribe")
    assert ("publish", "/image/compressed") in {(end.role, end.name) for end in started(camera(image, reader)).ends}


def test_code_that_is_not_started_is_counted_and_its_gaps_are_not() -> None:
    other = CodeNode(CodePlace("other.py", 1), "Other", "python", (named("other"),))
    own, gap, shared = camera(), Gap(CodePlace("other.py", 4), "file", ""), Gap(CodePlace("lib.py", 1), "file", "")
    facts = CodeFacts((own, other), (gap, shared))
    index = CodeIndex(facts.nodes, [Executable("cam", "cam", (FILE,))], lambda _: "")
    system = launched_system(facts, index, LaunchedSystem(LAUNCH, (StartedNode(CodePlace(LAUNCH, 1), "cam", "cam"),)))
    assert (system.idle, system.gaps) == ((other,), (shared,))


def test_without_a_launch_file_all_nodes_are_one_system() -> None:
    system = whole_system(CodeFacts((camera(publisher("image")),), (Gap(CodePlace(FILE, 1), "file", ""),)))
    assert (system.launch, channels(system), len(system.gaps)) == ("", [("/camera", "/image", "literal")], 1)


def without_code(package: str, executable: str, *packages: Package, name: str | None = None) -> ScannedSystem:
    start = StartedNode(CodePlace(LAUNCH, 2), package, executable, name, "/r")
    return launched_system(CodeFacts(), CodeIndex((), (), lambda _: ""), LaunchedSystem(LAUNCH, (start,)), packages)


def test_a_node_of_a_package_that_is_catalogued_has_its_interface() -> None:
    node = PackageNode(("amcl",), (Interface("subscribes", "scan", "sensor_msgs/msg/LaserScan"),), ())
    package = Package("nav2", "", (Source("", ""),), (node,), Place("", 0))
    system = without_code("nav2_amcl", "amcl", package)
    assert [node.name for node in system.nodes] == ["/r/amcl"]
    assert channels(system) == [("/r/amcl", "/r/scan", "package")]
    assert [gap.sort for gap in system.gaps] == ["package"]  # the catalogue does not state all


def test_a_node_of_which_nothing_is_known_stands_with_a_gap() -> None:
    system = without_code("vendor", "driver", name="lidar")
    assert ([node.name for node in system.nodes], channels(system)) == (["/r/lidar"], [])
    assert [(gap.sort, gap.place.line) for gap in system.gaps] == [("started", 2)]


TWO = "cam/other.py"


@pytest.mark.parametrize(
    ("text", "classes"),
    [
        ("class Camera(Node): ...\ndef main(): Camera()", ["Camera"]),
        ("def main(): from other import Lens; Lens()", ["Lens"]),
        ("std::make_shared<Lens>()", ["Lens"]),
        ("no class is named", ["Camera"]),
    ],
)
def test_an_executable_runs_what_its_files_create(text: str, classes: list[str]) -> None:
    lens = CodeNode(CodePlace(TWO, 1), "Lens", "python", ())
    own = [camera()] if "Lens" not in text else []
    index = CodeIndex([*own, lens], [Executable("cam", "cam", (FILE,))], lambda _: text)
    start = StartedNode(CodePlace(LAUNCH, 1), "cam", "cam")
    assert [node.name for node in index.code_of(start)] == classes


def test_a_class_with_a_second_node_stands_with_both() -> None:
    end = CodeEndpoint(CodePlace("src/robot.cpp", 9), "publish", (named("image"),), IMAGE)
    header = CodeNode(CodePlace("include/robot.hpp", 3), "Robot", "c++", (), endpoints=(end,))
    second = CodeNode(CodePlace("src/robot.cpp", 5), "Robot", "c++", ())
    index = CodeIndex(
        [header, second], [Executable("p", "robot", ("src/robot.cpp",))], lambda _: "make_shared<Robot>()"
    )
    places = [node.place for node in index.code_of(StartedNode(CodePlace(LAUNCH, 1), "p", "robot"))]
    assert sorted(places) == [header.place, second.place]


def test_a_node_of_ros_is_no_class_of_the_code_that_is_called_alike() -> None:
    other = CodeNode(CodePlace("lib/node.hpp", 1), "Node", "c++", ())
    text = 'Camera() : rclcpp::Node("camera") {}'
    index = CodeIndex([camera(), other], [Executable("cam", "cam", (FILE,))], lambda _: text)
    assert [node.name for node in index.code_of(StartedNode(CodePlace(LAUNCH, 1), "cam", "cam"))] == ["Camera"]


def test_a_component_is_known_by_its_plugin() -> None:
    talker = CodeNode(CodePlace("src/talker.cpp", 1), "demo::Talker", "c++", (), plugin="demo::Talker")
    index = CodeIndex([talker], [], lambda _: "")
    assert index.code_of(StartedNode(CodePlace(LAUNCH, 1), "demo", "demo::Talker")) == (talker,)
