"""A launch file that no other includes is a system: its nodes with their namespaces, remappings and parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from rosprivacy.ingest.scan.scan_facts import DEFAULT, LITERAL
from tests.ingest.scan.launches import FILE, full_name, listed, names, python, system, systems

if TYPE_CHECKING:
    from pathlib import Path

NODE = "NODE(name='c')"
SHARE = "get_package_share_directory('care')"
INNER = "care/launch/inner.launch.py"


def include(path: str, arguments: str = "") -> str:
    passed = f", launch_arguments={{{arguments}}}.items()" if arguments else ""
    return f"IncludeLaunchDescription(PythonLaunchDescriptionSource({path}){passed})"


@pytest.mark.parametrize(
    "path",
    [
        f"[{SHARE}, '/launch/inner.launch.py']",
        f"{SHARE} + '/launch/inner.launch.py'",
        f"os.path.join({SHARE}, 'launch', 'inner.launch.py')",
        "PathJoinSubstitution([FindPackageShare('care'), 'launch', 'inner.launch.py'])",
        "PathJoinSubstitution([FindPackageShare(package='care'), 'launch', 'inner.launch.py'])",
        "[FindPackageShare('care'), '/launch/inner.launch.py']",
        "[ThisLaunchFileDir(), '/inner.launch.py']",
        "os.path.join(os.path.dirname(__file__), 'inner.launch.py')",
        "str(Path(__file__).parent / 'inner.launch.py')",
        "str(Path(__file__).with_name('inner.launch.py'))",
        "os.path.join(FindPackageShare(package='care').find('care'), 'launch/inner.launch.py')",
        f"os.path.join({SHARE}, 'launch', LaunchConfiguration('f', default='inner') , '../inner.launch.py')",
        "'/home/me/ws/src/care/launch/inner.launch.py'",
    ],
)
def test_an_included_file_is_found_by_its_path(tmp_path: Path, path: str) -> None:
    read = system(tmp_path, listed(include(path)), files={INNER: listed(NODE)})
    assert (names(read), read.included, read.gaps) == (["/c"], (INNER,), ())
    assert read.file == FILE
    assert read.started[0].place.file == INNER


def test_a_file_that_is_installed_elsewhere_is_found_by_its_name(tmp_path: Path) -> None:
    inner = "care/launch/parts/inner.launch.py"
    read = system(tmp_path, listed(include(f"{SHARE} + '/launch/inner.launch.py'")), files={inner: listed(NODE)})
    assert read.included == (inner,)


@pytest.mark.parametrize(
    "path",
    [
        "'/opt/x.launch.py'",
        "get_package_share_directory('nav2') + '/launch/x.launch.py'",
        f"{SHARE} + '/x.launch.py'",
        "anything()",
    ],
)
def test_an_include_that_is_not_there_is_a_gap_at_its_line(tmp_path: Path, path: str) -> None:
    read = system(tmp_path, python(f"return LaunchDescription([\n\n{include(path)}])"))
    assert [(gap.sort, gap.place.file) for gap in read.gaps] == [("include", FILE)]
    assert read.gaps[0].place.line > 1


def test_an_include_passes_what_is_known_and_keeps_what_is_a_default(tmp_path: Path) -> None:
    inner = listed("DeclareLaunchArgument('n', default_value='x'), NODE(name=LaunchConfiguration('n'))")
    path = "[ThisLaunchFileDir(), '/inner.launch.py']"
    fixed, forwarded = include(path, "'n': 'z'"), include(path, "'n': LaunchConfiguration('m')")
    groups = f"GroupAction([{fixed}]), GroupAction([{forwarded}]), {include(path)}"
    outer = listed(f"DeclareLaunchArgument('m', default_value='y'), {groups}")
    read = system(tmp_path, outer, files={INNER: inner})
    assert [(one.name, one.basis) for one in read.started] == [("z", LITERAL), ("y", DEFAULT), ("x", DEFAULT)]


def test_a_condition_of_an_include_holds_for_what_it_starts(tmp_path: Path) -> None:
    path = "[ThisLaunchFileDir(), '/inner.launch.py']"
    action = include(path)[:-1] + ", condition=IfCondition(LaunchConfiguration('x')))"
    assert system(tmp_path, listed(action), files={INNER: listed(NODE)}).started[0].conditional


def test_a_condition_that_an_include_fixes_is_decided(tmp_path: Path) -> None:
    node = f"{NODE[:-1]}, condition=IfCondition(LaunchConfiguration('go')))"
    inner = listed(f"DeclareLaunchArgument('go', default_value='true'), {node}")
    path = "[ThisLaunchFileDir(), '/inner.launch.py']"
    never = system(tmp_path, listed(include(path, "'go': 'false'")), files={INNER: inner})
    assert never.started == ()
    always = system(tmp_path, listed(include(path, "'go': 'true'")), files={INNER: inner})
    assert [one.conditional for one in always.started] == [False]
    may = system(tmp_path, listed(include(path)), files={INNER: inner})
    assert [one.conditional for one in may.started] == [True]


def test_what_an_include_sets_stays_set_but_decides_nothing_after_it(tmp_path: Path) -> None:
    path = "[ThisLaunchFileDir(), '/inner.launch.py']"
    node = "NODE(name=LaunchConfiguration('go'), condition=IfCondition(LaunchConfiguration('go')))"
    passed = include(path, "'go': 'false'")
    read = system(tmp_path, listed(f"{passed}, {node}"), files={INNER: listed("LogInfo(msg='')")})
    assert [(one.name, one.conditional) for one in read.started] == [("false", True)]


def test_files_that_include_each_other_are_one_system(tmp_path: Path) -> None:
    paths = {name: f"[ThisLaunchFileDir(), '/{name}.launch.py']" for name in ("a", "b")}
    files = {
        f"care/launch/{name}.launch.py": listed(f"{NODE}, {include(paths[other])}") for name, other in ("ab", "ba")
    }
    (read,) = systems(tmp_path, files)
    assert read.file == "care/launch/a.launch.py"
    assert [one.place.file for one in read.started] == ["care/launch/a.launch.py", "care/launch/b.launch.py"]
    assert [gap.sort for gap in read.gaps] == ["include"]


def test_includes_that_double_at_each_step_end_with_a_gap(tmp_path: Path) -> None:
    files = {
        f"care/launch/f{number}.launch.py": listed(
            ", ".join([include(f"[ThisLaunchFileDir(), '/f{number + 1}.launch.py']")] * 2)
        )
        for number in range(40)
    }
    (read,) = systems(tmp_path, {**files, "care/launch/f40.launch.py": listed(NODE)})
    assert any(gap.sort == "started" for gap in read.gaps)


@pytest.mark.parametrize(
    ("actions", "space"),
    [
        ("PushRosNamespace('a'), NODE(name='c')", "/a/c"),
        ("PushRosNamespace('a'), PushRosNamespace('b'), NODE(name='c')", "/a/b/c"),
        ("PushRosNamespace('a'), NODE(name='c', namespace='b')", "/a/b/c"),
        ("PushRosNamespace('a'), NODE(name='c', namespace='/b')", "/b/c"),
        ("GroupAction([PushRosNamespace('a')]), NODE(name='c')", "/c"),
        ("GroupAction([PushRosNamespace('a')], scoped=False), NODE(name='c')", "/a/c"),
        ("NODE(name='x', arguments=['--ros-args', '-r', '__node:=c'])", "/c"),
        ("NODE(name='c', ros_arguments=['-r', '__ns:=/a'])", "/a/c"),
        ("ExecuteProcess(cmd=['ros2', 'run', 'p', 'e', '--ros-args', '-r', '__node:=c'])", "/c"),
        ("ExecuteProcess(cmd=['ros2 run p e --ros-args -r __ns:=/a -r __node:=c'], shell=True)", "/a/c"),
    ],
)
def test_namespaces_are_whole(tmp_path: Path, actions: str, space: str) -> None:
    read = system(tmp_path, listed(actions))
    assert [(one.package, one.executable, full_name(one)) for one in read.started] == [("p", "e", space)]


@pytest.mark.parametrize(
    "command",
    [
        "['ros2', 'bag', 'record', '-o', 'day', '/image']",
        "['ros2 bag record -o day /image']",
        "['bash', '-c', 'exec ros2 bag record -o day /image']",
    ],
)
def test_a_recording_is_a_recorder_with_its_words(tmp_path: Path, command: str) -> None:
    (one,) = system(tmp_path, listed(f"ExecuteProcess(cmd={command})")).started
    assert (one.package, full_name(one), one.arguments) == ("rosbag2", "/rosbag2_recorder", ("-o", "day", "/image"))


def test_a_word_that_is_open_is_one_word(tmp_path: Path) -> None:
    command = "['ros2', 'bag', 'record', '-o', '/bags/' + datetime.now().strftime('%Y'), '/image']"
    body = f"return LaunchDescription([ExecuteProcess(cmd={command})])"
    (one,) = system(tmp_path, "from datetime import datetime\n" + python(body)).started
    assert [word for word in one.arguments if not word.startswith("/bags/")] == ["-o", "/image"]
    assert len(one.arguments) == len(["-o", "day", "/image"])


def test_remappings_for_all_nodes_come_before_those_of_one(tmp_path: Path) -> None:
    read = system(tmp_path, listed(f"SetRemap('a', 'b'), {NODE[:-1]}, remappings=[('c', 'd')])"))
    assert read.started[0].remaps == (("a", "b"), ("c", "d"))


def test_lists_of_remappings_by_a_choice_go_together_with_what_chooses(tmp_path: Path) -> None:
    body = (
        "if anything():\n    n, r = 'x', [('a', 'x')]\nelse:\n    n, r = 'y', [('a', 'y'), ('b', 'y')]\n"
        "return LaunchDescription([NODE(name=n, remappings=r)])"
    )
    read = system(tmp_path, python(body))
    assert [(one.name, one.remaps) for one in read.started] == [
        ("x", (("a", "x"),)),
        ("y", (("a", "y"), ("b", "y"))),
    ]


def test_remappings_that_are_not_known_are_a_gap(tmp_path: Path) -> None:
    read = system(tmp_path, listed(f"{NODE[:-1]}, remappings=anything())"))
    assert [(gap.sort, gap.place) for gap in read.gaps] == [("remap", read.started[0].place)]


@pytest.mark.parametrize(
    ("parameters", "answer"),
    [
        ("[{'topic': '/a', 'rate': 3, 'on': True}]", (("topic", "/a"), ("rate", "3"), ("on", "true"))),
        ("[{'camera': {'topic': '/a'}}]", (("camera.topic", "/a"),)),
        ("[{'topic': ParameterValue('/a', value_type=str)}]", (("topic", "/a"),)),
        ("[{'topics': ['/a', '/b']}]", (("topics", "[/a, /b]"),)),
        (f"[{SHARE} + '/config/p.yaml']", (("topic", "/file"),)),
        (f"[ParameterFile(os.path.join({SHARE}, 'config', 'p.yaml'), allow_substs=True)]", (("topic", "/file"),)),
        (f"[{SHARE} + '/config/p.yaml', {{'topic': '/a'}}]", (("topic", "/a"),)),
        (
            f"[RewrittenYaml(source_file={SHARE} + '/config/p.yaml', param_rewrites={{'topic': '/new'}})]",
            (("topic", "/new"),),
        ),
    ],
)
def test_parameters_come_from_the_launch_file_and_from_files(
    tmp_path: Path, parameters: str, answer: tuple[tuple[str, str], ...]
) -> None:
    files = {
        "care/config/p.yaml": "c:\n  ros__parameters:\n    topic: /file\nother:\n  ros__parameters:\n    topic: /no\n"
    }
    read = system(tmp_path, listed(f"{NODE[:-1]}, parameters={parameters})"), files=files)
    assert (read.started[0].parameters, read.gaps) == (answer, ())


def test_parameters_for_all_nodes_come_first(tmp_path: Path) -> None:
    read = system(
        tmp_path, listed(f"SetParameter('a', '1'), SetParameter('b', '1'), {NODE[:-1]}, parameters=[{{'a': '2'}}])")
    )
    assert read.started[0].parameters == (("b", "1"), ("a", "2"))


def test_a_parameter_that_is_not_known_is_not_its_default(tmp_path: Path) -> None:
    read = system(tmp_path, listed(f"{NODE[:-1]}, parameters=[{{'topic': anything()}}])"))
    assert (read.started[0].parameters, read.started[0].open_parameters) == ((), ("topic",))


def test_a_file_of_parameters_that_is_not_there_is_a_gap(tmp_path: Path) -> None:
    read = system(tmp_path, listed(f"{NODE[:-1]}, parameters=[{SHARE} + '/config/no.yaml'])"))
    assert [(gap.sort, gap.place) for gap in read.gaps] == [("parameter", read.started[0].place)]


def test_parameters_of_a_node_without_a_name_stay_by_the_names_of_the_file(tmp_path: Path) -> None:
    node = f"NODE(parameters=[{SHARE} + '/config/p.yaml'])"
    files = {"care/config/p.yaml": "c:\n  ros__parameters:\n    topic: /file\n"}
    assert system(tmp_path, listed(node), files=files).started[0].parameters_by_node == (("/c", "topic", "/file"),)


def test_each_launch_file_that_no_other_includes_is_a_system(tmp_path: Path) -> None:
    files = {
        "care/launch/a.launch.py": listed(NODE),
        "care/launch/b_launch.py": listed(NODE),
        "care/launch/c.py": listed(NODE),
        "care/launch/helper.py": "def other(): pass",
        "care/test/d.launch.py": listed(NODE),
        "care/launch/test_e.launch.py": listed(NODE),
    }
    read = systems(tmp_path, files)
    assert [one.file for one in read] == ["care/launch/a.launch.py", "care/launch/b_launch.py", "care/launch/c.py"]


def test_a_launch_file_that_is_no_python_is_a_gap(tmp_path: Path) -> None:
    read = system(tmp_path, "def generate_launch_description(:\n")
    assert [(gap.place, gap.sort) for gap in read.gaps] == [((FILE, 1), "file")]
