"""Launch files in Python say which nodes they start, whatever way their lists are made; what stays open is a gap."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rosprivacy.ingest.scan.scan_facts import DEFAULT, LITERAL
from tests.ingest.scan.launches import FILE, HEAD, full_name, listed, names, python, system

if TYPE_CHECKING:
    from pathlib import Path

NODE = "NODE(name={})"
LATE = """
def late(context):
    if LaunchConfiguration('x').perform(context) == 'a':
        return [NODE(name='c')]
    return []
"""
ARGUMENT = "DeclareLaunchArgument('x', default_value='robot')"


@pytest.mark.parametrize(
    "body",
    [
        "return LaunchDescription([NODE(name='camera')])",
        "return launch.LaunchDescription([launch_ros.actions.Node(package='p', executable='e', name='camera')])",
        "ld = LaunchDescription()\nld.add_action(NODE(name='camera'))\nreturn ld",
        "nodes = []\nnodes.append(NODE(name='camera'))\nreturn LaunchDescription(nodes)",
        "nodes = []\nnodes += [NODE(name='camera')]\nreturn LaunchDescription(nodes)",
        "return LaunchDescription([LogInfo(msg='x')] + [NODE(name='camera')])",
        "return LaunchDescription([*[NODE(name='camera')]])",
        "return LaunchDescription([NODE(name=n) for n in ['camera']])",
        "def make(name):\n    return NODE(name=name)\nreturn LaunchDescription([make('camera')])",
        "keys = dict(package='p', executable='e')\nreturn LaunchDescription([Node(name='camera', **keys)])",
        "return LaunchDescription([GroupAction([NODE(name='camera')])])",
        "return LaunchDescription([TimerAction(period=3.0, actions=[NODE(name='camera')])])",
        "late = lambda context: [NODE(name='camera')]\nreturn LaunchDescription([OpaqueFunction(function=late)])",
        "after = OnProcessExit(on_exit=[NODE(name='camera')])\nreturn LaunchDescription([RegisterEventHandler(after)])",
        "return LaunchDescription([LifecycleNODE(name='camera', namespace='')])",
        "part = 'cam'\nreturn LaunchDescription([NODE(name=f'{part}era')])",
        "return LaunchDescription([NODE(name='cam%s' % 'era')])",
        "return LaunchDescription([NODE(name='{}era'.format('cam'))])",
        "return LaunchDescription([NODE(name=['cam', TextSubstitution(text='era')])])",
        "return LaunchDescription([Node(package='p', node_executable='e', node_name='camera')])",
        "with open('x') as f:\n    node = NODE(name='camera')\nreturn LaunchDescription([node])",
    ],
)
def test_a_node_is_started(tmp_path: Path, body: str) -> None:
    read = system(tmp_path, python(body))
    assert [(one.package, one.executable, one.name, one.conditional, one.basis) for one in read.started] == [
        ("p", "e", "camera", False, LITERAL)
    ]
    assert read.gaps == ()


def test_a_node_stands_at_the_line_of_its_call(tmp_path: Path) -> None:
    read = system(tmp_path, python("return LaunchDescription([\n    Node(package='p',\n         executable='e')])"))
    first = HEAD.count("\n") + 4
    assert [(one.place.file, one.place.line, one.name) for one in read.started] == [(FILE, first, None)]


@pytest.mark.parametrize(
    ("argument", "name", "known"),
    [
        ("DeclareLaunchArgument('x', default_value='robot')", "LaunchConfiguration('x')", DEFAULT),
        ("DeclareLaunchArgument(name='x', default_value='robot')", "[LaunchConfiguration('x')]", DEFAULT),
        ("LogInfo(msg='')", "LaunchConfiguration('x', default='robot')", DEFAULT),
        ("SetLaunchConfiguration('x', 'robot')", "LaunchConfiguration('x')", LITERAL),
        ("LogInfo(msg='')", "EnvironmentVariable('X', default_value='robot')", DEFAULT),
        ("LogInfo(msg='')", "os.environ.get('X', 'robot')", DEFAULT),
        ("SetEnvironmentVariable('X', 'robot')", "EnvironmentVariable('X')", LITERAL),
        (
            "DeclareLaunchArgument('x', default_value='ROBOT')",
            "PythonExpression([\"'\", LaunchConfiguration('x'), \"'.lower()\"])",
            DEFAULT,
        ),
    ],
)
def test_a_name_is_that_of_its_argument(tmp_path: Path, argument: str, name: str, known: str) -> None:
    read = system(tmp_path, listed(f"{argument}, {NODE.format(name)}"))
    assert [(one.name, one.basis) for one in read.started] == [("robot", known)]


@pytest.mark.parametrize(
    ("argument", "name"),
    [
        ("DeclareLaunchArgument('x')", "LaunchConfiguration('x')"),
        ("LogInfo(msg='')", "LaunchConfiguration('x')"),
        ("LogInfo(msg='')", "EnvironmentVariable('X')"),
        ("LogInfo(msg='')", "os.environ['X']"),
        ("LogInfo(msg='')", "anything('x')"),
        ("LogInfo(msg='')", "PythonExpression(['1 +', LaunchConfiguration('x')])"),
    ],
)
def test_a_name_that_the_sources_do_not_fix_is_a_gap_at_its_line(tmp_path: Path, argument: str, name: str) -> None:
    read = system(tmp_path, listed(f"{argument}, {NODE.format(name)}"))
    started = read.started[0]
    assert started.name is not None
    assert "{" in started.name
    assert [(gap.sort, gap.place) for gap in read.gaps] == [("node", started.place)]


def test_the_values_of_an_argument_are_all_kept_and_go_together(tmp_path: Path) -> None:
    node = "NODE(name='c', namespace=x, remappings=[('a', [x, '/a'])])"
    argument = "DeclareLaunchArgument('x', choices=['r', 's'])"
    body = f"x = LaunchConfiguration('x')\nreturn LaunchDescription([{argument}, {node}])"
    read = system(tmp_path, python(body))
    assert [(one.namespace, one.remaps) for one in read.started] == [("/r", (("a", "r/a"),)), ("/s", (("a", "s/a"),))]


def test_more_values_than_can_be_told_are_open(tmp_path: Path) -> None:
    choices = [f"r{number}" for number in range(40)]
    node = NODE.format("LaunchConfiguration('x')")
    read = system(tmp_path, listed(f"DeclareLaunchArgument('x', choices={choices}), {node}"))
    assert len(read.started) == 1
    assert [gap.sort for gap in read.gaps] == ["node"]


@pytest.mark.parametrize(
    "body",
    [
        "return LaunchDescription([NODE(name='c', condition=IfCondition(LaunchConfiguration('x')))])",
        "return LaunchDescription([NODE(name='c', condition=UnlessCondition(LaunchConfiguration('x')))])",
        "return LaunchDescription([NODE(name='c', condition=LaunchConfigurationEquals('x', 'a'))])",
        "return LaunchDescription([GroupAction([NODE(name='c')], condition=IfCondition(anything()))])",
        "nodes = []\nif os.path.exists('/x'):\n    nodes.append(NODE(name='c'))\nreturn LaunchDescription(nodes)",
        f"{LATE}return LaunchDescription([OpaqueFunction(function=late)])",
        "node = NODE(name='c')\nreturn LaunchDescription([node] if anything() else [])",
    ],
)
def test_a_node_under_a_condition_says_so(tmp_path: Path, body: str) -> None:
    read = system(tmp_path, python(body))
    assert [(one.name, one.conditional) for one in read.started] == [("c", True)]


def test_both_branches_of_an_open_condition_are_kept(tmp_path: Path) -> None:
    body = f"if anything():\n    name = 'a'\nelse:\n    name = 'b'\nreturn LaunchDescription([{NODE.format('name')}])"
    assert names(system(tmp_path, python(body))) == ["/a", "/b"]


def test_a_condition_that_the_text_fixes_is_decided(tmp_path: Path) -> None:
    nodes = f"[{NODE.format(repr('a'))}] if DEBUG else [{NODE.format(repr('b'))}]"
    body = f"DEBUG = False\nreturn LaunchDescription({nodes})"
    assert names(system(tmp_path, python(body))) == ["/b"]


def test_a_loop_over_constants_gives_each(tmp_path: Path) -> None:
    body = (
        "nodes = []\nfor number, (name, space) in enumerate([('a', 'x'), ('b', 'y')]):\n"
        "    nodes.append(NODE(name=f'{name}{number}', namespace=space))\n"
        "return LaunchDescription(nodes)"
    )
    assert names(system(tmp_path, python(body))) == ["/x/a0", "/y/b1"]


def test_a_loop_over_what_a_file_of_the_checkout_lists(tmp_path: Path) -> None:
    body = (
        "import yaml\npath = os.path.join(get_package_share_directory('care'), 'config', 'robots.yaml')\n"
        "with open(path) as f:\n    robots = yaml.safe_load(f)['robots']\n"
        "return LaunchDescription([NODE(name=r['name']) for r in robots])"
    )
    files = {"care/config/robots.yaml": "robots:\n  - name: a\n  - name: b\n"}
    assert names(system(tmp_path, python(body), files=files)) == ["/a", "/b"]


def test_helpers_of_other_modules_of_the_checkout_are_followed(tmp_path: Path) -> None:
    node = "Node(package='p', executable='e', name=NAME, namespace=space)"
    helper = f"{HEAD}\nNAME = 'camera'\ndef camera(space):\n    return {node}\n"
    text = "from care.helpers import camera\n" + listed("camera('front')")
    read = system(tmp_path, text, files={"care/care/helpers.py": helper, "care/care/__init__.py": ""})
    assert names(read) == ["/front/camera"]
    assert read.started[0].place.file == "care/care/helpers.py"


def test_all_names_of_a_module_are_imported(tmp_path: Path) -> None:
    text = python("return LaunchDescription([NODE(name='c')])")
    stars = text.replace(
        "from launch import LaunchDescription", "from launch import *\nfrom launch_ros.actions import *"
    )
    own = stars.replace(
        "ComposableNodeContainer, LifecycleNode, LoadComposableNodes, Node, PushRosNamespace", "SetRemap"
    )
    assert names(system(tmp_path, own)) == ["/c"]


def test_what_another_package_makes_is_a_gap(tmp_path: Path) -> None:
    text = "from elsewhere import make\n" + listed("make()")
    read = system(tmp_path, text)
    assert [gap.sort for gap in read.gaps] == ["started"]
    assert read.gaps[0].place.file == FILE


def test_what_an_unknown_action_holds_is_kept_and_said(tmp_path: Path) -> None:
    read = system(tmp_path, listed(f"anything(actions=[{NODE.format(repr('c'))}])"))
    assert [(one.name, one.conditional) for one in read.started] == [("c", True)]
    assert [gap.sort for gap in read.gaps] == ["started"]


def test_components_are_nodes_beside_their_container(tmp_path: Path) -> None:
    component = "ComposableNode(package='p', plugin='p::Camera', name='c', namespace='n', remappings=[('a', 'b')])"
    program = "package='rclcpp_components', executable='component_container', name='k', namespace=''"
    container = f"ComposableNodeContainer({program}, composable_node_descriptions=[{component}])"
    read = system(tmp_path, listed(container))
    assert [(one.executable, full_name(one)) for one in read.started] == [
        ("component_container", "/k"),
        ("p::Camera", "/n/c"),
    ]
    loaded = f"LoadComposableNodes(target_container='k', composable_node_descriptions=[{component}])"
    assert [one.remaps for one in system(tmp_path, listed(loaded)).started] == [(("a", "b"),)]


@pytest.mark.parametrize(
    "before",
    [
        ["given = dict([a.split(':=') for a in anything()])", "if 'x' not in given:", "    return None"],
        ["given = {}", "given[anything()] = 1", "if not given.get('x'):", "    return None"],
        ["given = [a for a in anything()]", "if len(given) == 1:", "    return None"],
        ["try:", "    return LaunchDescription(anything())", "except OSError:", "    pass"],
        ["try:", "    raise OSError", "except OSError:", "    if anything():", "        return None"],
        ["while anything():", "    if anything():", "        return None"],
        ["match anything():", "    case 1:", "        return None", "    case _:", "        pass"],
    ],
)
def test_a_node_is_not_lost_where_it_is_open_which_way_the_code_goes(tmp_path: Path, before: list[str]) -> None:
    read = system(tmp_path, python("\n".join([*before, "return LaunchDescription([NODE(name='c')])"])))
    assert [(one.name, one.conditional) for one in read.started] == [("c", True)]


def test_a_node_that_starts_when_another_ends(tmp_path: Path) -> None:
    assert names(system(tmp_path, listed("NODE(name='a', on_exit=[NODE(name='b')])"))) == ["/a", "/b"]


def test_names_that_a_loop_without_an_end_counts_are_open(tmp_path: Path) -> None:
    body = "n, i = [], 0\nwhile i < 3:\n    n.append(NODE(name=f'r{i}'))\n    i += 1\nreturn LaunchDescription(n)"
    read = system(tmp_path, python(body))
    assert [gap.sort for gap in read.gaps] == ["node"]


@pytest.mark.parametrize(
    "bomb",
    [
        "x = 'a'\n" + "x = x + x\n" * 60 + "return LaunchDescription([NODE(name=x)])",
        "x = [1]\n" + "x = x + x\n" * 60 + "return LaunchDescription(x)",
        "x = LaunchConfiguration('x')\n" + "x = [x, x]\n" * 60 + "return LaunchDescription([NODE(name=x)])",
        "x = LaunchConfiguration('x')\n" + "x = Path(x) / x\n" * 60 + "return LaunchDescription([NODE(name=x)])",
        "n = NODE()\n" + "n = GroupAction([n, n])\n" * 40 + "return LaunchDescription([n])",
        "def f(x):\n    return f(x) + f(x)\nreturn LaunchDescription(f(1))",
        "r = range(10**9)\nreturn LaunchDescription([a for a in r for b in r for c in r])",
        "while True:\n    pass\nreturn LaunchDescription([])",
        "x = " + "(" * 90 + "1" + ")" * 90 + "\nreturn LaunchDescription([])",
        "x = " + "1 + " * 5000 + "1\nreturn LaunchDescription([])",
        "x = 2 ** 2 ** 2 ** 2 ** 2 ** 2\nreturn LaunchDescription(['a' * 10 ** 10])",
        "x = 0x" + "f" * 9000 + "\nreturn LaunchDescription([NODE(name=f'{x}')])",
    ],
)
def test_what_grows_without_end_ends(tmp_path: Path, bomb: str) -> None:
    system(tmp_path, python(bomb))


WAYS = st.sampled_from(
    ["[{}]", "GroupAction([{}])", "([{}] if anything() else [])", "TimerAction(period=1.0, actions=[{}])"]
)
NAMES = st.sampled_from(
    ["'a'", "LaunchConfiguration('x')", "LaunchConfiguration('y')", "anything()", "f'{anything()}b'", "None"]
)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(ways=st.lists(WAYS, max_size=4), name=NAMES, space=NAMES)
def test_each_node_has_a_name_or_a_gap_at_its_line(tmp_path: Path, ways: list[str], name: str, space: str) -> None:
    action = f"NODE(name={name}, namespace={space})"
    for way in ways:
        action = way.format(action)
    read = system(tmp_path, listed(f"{ARGUMENT}, {action}"))
    assert read.started
    for one in read.started:
        open_texts = [text for text in (one.name, one.namespace) if text and "{" in text]
        assert not open_texts or any(gap.place == one.place and gap.sort == "node" for gap in read.gaps)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(st.text(alphabet="abN()[]{}=:,.'\"\n +*forinlambdaif") | st.text())
def test_no_text_ends_the_reader(tmp_path: Path, body: str) -> None:
    with suppress(UnicodeEncodeError):  # half a character cannot be written
        system(tmp_path, f"{HEAD}\ndef generate_launch_description():\n    return LaunchDescription([{body}])\n")
