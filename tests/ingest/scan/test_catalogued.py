"""A node whose code is not there has the interface that the catalogue states, under its names when it runs."""

from __future__ import annotations

import pytest

from rosprivacy.analysis.model import Place
from rosprivacy.analysis.suggesting.packages import NOTHING, Interface, Package, PackageNode, Source
from rosprivacy.ingest.known_packages.package_folders import catalogue
from rosprivacy.ingest.scan.scan_facts import CodeFacts, CodePlace, LaunchedSystem, StartedNode
from rosprivacy.ingest.scan.started_code import CodeIndex
from rosprivacy.ingest.scan.systems import ScannedSystem, launched_system
from rosprivacy.ontology.vocabulary import load

LAUNCH = "launch/robot.launch.py"


def started(package: str, executable: str, packages: tuple[Package, ...] = (), **more: object) -> ScannedSystem:
    start = StartedNode(CodePlace(LAUNCH, 2), package, executable, **more)  # type: ignore[arg-type]
    known = packages or catalogue(load())
    return launched_system(CodeFacts(), CodeIndex((), (), lambda _: ""), LaunchedSystem(LAUNCH, (start,)), known)


def ends(system: ScannedSystem) -> set[tuple[str, str, str]]:
    return {(end.node, end.role, end.name) for end in system.ends if end.name != "/rosout"}


def package(rest: str = "", **more: object) -> Package:
    node = PackageNode(("mixer",), (Interface("publishes", "out"),), (), rest=rest, **more)  # type: ignore[arg-type]
    return Package("mixer", "", (Source("", ""),), (node,), Place("", 0), packages=("mixer_ros",))


@pytest.mark.parametrize(
    ("of", "executable", "rest", "gaps"),
    [
        ("mixer", "mixer", "", ["package"]),
        ("mixer", "mixer", "what plugins do", ["package"]),
        ("mixer", "mixer", NOTHING, []),
        ("mixer_ros", "mixer", NOTHING, []),
        ("mixer_of_others", "mixer", NOTHING, ["package"]),  # called alike: perhaps another one
        ("others", "mixer", NOTHING, ["package"]),
    ],
)
def test_only_an_entry_of_that_package_that_says_so_is_whole(
    of: str, executable: str, rest: str, gaps: list[str]
) -> None:
    system = started(of, executable, (package(rest),), name="m")
    assert ends(system) == {("/m", "publish", "/out")}
    assert [gap.sort for gap in system.gaps] == gaps


def test_what_else_there_is_depends_on_is_said() -> None:
    (gap,) = started("mixer", "mixer", (package("what its plugins do"),), name="m").gaps
    assert "what its plugins do" in gap.text


def test_a_channel_whose_name_is_made_up_leaves_the_interface_open() -> None:
    made = package(NOTHING, further=(Interface("publishes", "clear_*"),))
    assert [gap.sort for gap in started("mixer", "mixer", (made,), name="m").gaps] == ["package"]


def test_parameters_name_channels() -> None:
    parameters = (("odom0", "wheels"), ("odom0_config", "[true]"), ("imu0", "/imu"))
    system = started("robot_localization", "ekf_node", name="ekf", namespace="/r", parameters=parameters)
    read = {name for _, role, name in ends(system) if role == "subscribe"}
    assert {"/r/wheels", "/imu"} <= read
    assert not [name for name in read if "true" in name]
    assert system.gaps == ()


def test_a_list_names_one_channel_each() -> None:
    parameters = (("node_names", "['amcl', 'map_server']"),)
    system = started("nav2_lifecycle_manager", "lifecycle_manager", name="manager", parameters=parameters)
    asked = {name for _, role, name in ends(system) if role == "request"}
    assert asked == {f"/{node}/{what}_state" for node in ("amcl", "map_server") for what in ("get", "change")}


def test_a_parameter_that_the_launch_file_leaves_open_is_a_gap() -> None:
    system = started("robot_localization", "ekf_node", name="ekf", parameters=(("odom0", "{topic}"),))
    assert [gap.sort for gap in system.gaps] == ["name"]


def test_nodes_in_the_same_process_stand_with_their_own_names_and_parameters() -> None:
    by_node = (("/global_costmap/global_costmap", "obstacle_layer.scan.topic", "/laser"),)
    system = started("nav2_planner", "planner_server", name="planner_server", parameters_by_node=by_node)
    assert [node.name for node in system.nodes] == ["/global_costmap/global_costmap", "/planner_server"]
    of_map = {(role, name) for node, role, name in ends(system) if node == "/global_costmap/global_costmap"}
    assert {("subscribe", "/laser"), ("subscribe", "/map"), ("publish", "/global_costmap/costmap")} <= of_map


def test_a_component_is_known_by_its_class() -> None:
    system = started("nav2_amcl", "nav2_amcl::AmclNode", name="where", parameters=(("scan_topic", "laser"),))
    assert ("/where", "subscribe", "/laser") in ends(system)
    assert system.gaps == ()


@pytest.mark.parametrize(
    ("word", "made"),
    [
        ("/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan", {("publish", "/scan")}),
        ("/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist", {("subscribe", "/cmd_vel")}),
        ("/odom@nav_msgs/msg/Odometry@gz.msgs.Odometry", {("publish", "/odom"), ("subscribe", "/odom")}),
        ("/world/w/control@ros_gz_interfaces/srv/ControlWorld", {("reply", "/world/w/control")}),
        ("--help", set()),
    ],
)
def test_a_bridge_to_a_simulator_has_what_its_command_line_bridges(word: str, made: set[tuple[str, str]]) -> None:
    system = started("ros_gz_bridge", "parameter_bridge", name="bridge", arguments=(word,))
    assert {(role, name) for _, role, name in ends(system)} == made


def test_options_of_a_command_line_name_channels() -> None:
    system = started(
        "gazebo_ros", "spawn_entity.py", arguments=("-topic", "robot_description", "-entity", "r", "-z", "1")
    )
    assert ("/spawn_entity", "subscribe", "/robot_description") in ends(system)
    assert ("/spawn_entity", "request", "/spawn_entity") in ends(system)
    assert system.gaps == ()


def test_the_nodes_that_launch_files_start_most_have_their_channels() -> None:
    wanted = {
        ("robot_state_publisher", "robot_state_publisher"): "/tf",
        ("tf2_ros", "static_transform_publisher"): "/tf_static",
        ("joint_state_publisher_gui", "joint_state_publisher_gui"): "/joint_states",
        ("nav2_map_server", "map_server"): "/map",
        ("joy", "joy_node"): "/joy",
        ("rplidar_ros", "rplidar_composition"): "/scan",
    }
    for (of, executable), channel in wanted.items():
        system = started(of, executable, namespace="")
        assert channel in {name for _, _, name in ends(system)}
        assert system.gaps == ()


@pytest.mark.parametrize(
    ("words", "topics"),
    [
        ("-o day /image /scan", {"/image", "/scan"}),  # before topics had an option
        ("--topics image scan -o day", {"/image", "/scan"}),
        ("--compression-mode file --compression-format zstd /image", {"/image"}),
        ("/image --qos-profile-overrides-path qos.yaml", {"/image"}),
        ("--exclude-topics /scan /odom --all-topics", {"/*"}),  # what is taken out may be in it all the same
        ("--regex .*image.*", {"/*"}),
        ("--services /ask", set()),
    ],
)
def test_a_recorder_reads_what_its_words_name(words: str, topics: set[str]) -> None:
    system = started("rosbag2", "recorder", name="rosbag2_recorder", arguments=tuple(words.split()))
    assert {name for _, role, name in ends(system) if role == "subscribe"} == topics


def test_a_recorded_topic_that_is_open_is_a_gap() -> None:
    system = started("rosbag2", "recorder", name="rosbag2_recorder", arguments=("{topic}",))
    assert "name" in [gap.sort for gap in system.gaps]
