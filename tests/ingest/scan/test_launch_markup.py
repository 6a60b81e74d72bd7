"""Launch files in XML and in YAML start what one in Python would."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rosprivacy.ingest.scan.launch.launch_markup import substituted
from rosprivacy.ingest.scan.launch.launch_values import Open, Substitution
from rosprivacy.ingest.scan.scan_facts import StartedNode
from tests.ingest.scan.launches import full_name, names, system, systems

if TYPE_CHECKING:
    from pathlib import Path

XML, YAML = "care/launch/care.launch.xml", "care/launch/care.launch.yaml"
ONE_XML = """<launch>
  <arg name="ns" default="robot"/>
  <group>
    <push_ros_namespace namespace="$(var ns)"/>
    <node pkg="p" exec="e" name="camera" if="$(var go)">
      <remap from="image" to="$(var ns)/image"/>
      <param name="topic" value="/a"/>
      <param name="inner"><param name="rate" value="3"/></param>
    </node>
  </group>
</launch>"""
ONE_YAML = """
launch:
- arg: {name: ns, default: robot}
- group:
    - push_ros_namespace:
        namespace: $(var ns)
    - node:
        pkg: p
        exec: e
        name: camera
        if: $(var go)
        remap:
        - {from: image, to: $(var ns)/image}
        param:
        - {name: topic, value: /a}
        - name: inner
          param:
          - {name: rate, value: 3}
"""


@pytest.mark.parametrize(("file", "text", "line"), [(XML, ONE_XML, 5), (YAML, ONE_YAML, 7)])
def test_a_node_with_all_that_belongs_to_it(tmp_path: Path, file: str, text: str, line: int) -> None:
    read = system(tmp_path, text, file)
    started = read.started[0]
    assert started == StartedNode(
        started.place, "p", "e", "camera", "/robot", (("image", "robot/image"),),
        (("topic", "/a"), ("inner.rate", "3")), conditional=True, basis="default",
    )  # fmt: skip
    assert started.place == (file, line)


@pytest.mark.parametrize(
    ("element", "name"),
    [
        ('<node pkg="p" exec="e" name="a" namespace="b"/>', "/b/a"),
        ('<node pkg="p" exec="e" name="$(env HOST h)"/>', "/h"),
        ('<let name="x" value="a"/><node pkg="p" exec="e" name="$(var x)"/>', "/a"),
        ('<node pkg="p" exec="e" name="$(eval &quot;\'a\' + \'b\'&quot;)"/>', "/ab"),
        ('<executable cmd="ros2 run p e --ros-args -r __node:=a -r __ns:=/b"/>', "/b/a"),
        (
            '<load_composable_node target="k"><composable_node pkg="p" plugin="e" name="a"/></load_composable_node>',
            "/a",
        ),
        ('<timer period="1"><node pkg="p" exec="e" name="a"/></timer>', "/a"),
        ('<group scoped="false"><push-ros-namespace namespace="b"/></group><node pkg="p" exec="e" name="a"/>', "/b/a"),
        ('<group><push-ros-namespace namespace="b"/></group><node pkg="p" exec="e" name="a"/>', "/a"),
    ],
)
def test_what_an_element_starts(tmp_path: Path, element: str, name: str) -> None:
    read = system(tmp_path, f"<launch>{element}</launch>", XML)
    assert [(one.package, one.executable, full_name(one)) for one in read.started] == [("p", "e", name)]


def test_an_include_passes_its_arguments(tmp_path: Path) -> None:
    file = "$(find-pkg-share care)/launch/in.launch.xml"
    outer = f'<launch><include file="{file}"><arg name="n" value="a"/></include></launch>'
    inner = '<launch><arg name="n"/><node pkg="p" exec="e" name="$(var n)"/></launch>'
    read = system(tmp_path, outer, XML, {"care/launch/in.launch.xml": inner})
    assert (names(read), read.included, read.gaps) == (["/a"], ("care/launch/in.launch.xml",), ())


def test_an_element_that_nobody_knows_is_a_gap(tmp_path: Path) -> None:
    read = system(tmp_path, "<launch>\n<webots name='w'/>\n</launch>", XML)
    assert [(gap.sort, gap.place) for gap in read.gaps] == [("started", (XML, 2))]


def test_elements_that_are_nested_too_deeply_are_a_gap(tmp_path: Path) -> None:
    read = system(tmp_path, f"<launch>{'<group>' * 100}<node pkg='p' exec='e'/>{'</group>' * 100}</launch>", XML)
    assert [gap.sort for gap in read.gaps] == ["started"]


@pytest.mark.parametrize(
    "text",
    [
        '<launch><node pkg="p" type="e" name="a"/></launch>',
        '<launch><include file="$(find p)/launch/a.launch"/></launch>',
        '<launch><rosparam command="load" file="a"/></launch>',
        "<robot/>",
    ],
)
def test_what_is_no_launch_file_of_ros_2_is_no_system(tmp_path: Path, text: str) -> None:
    assert systems(tmp_path, {"care/launch/a.launch": text}) == ()


@pytest.mark.parametrize(("file", "text"), [(XML, "<launch><node>"), (YAML, "launch: [")])
def test_what_cannot_be_read_is_a_gap(tmp_path: Path, file: str, text: str) -> None:
    read = system(tmp_path, text, file)
    assert [(gap.place.file, gap.sort) for gap in read.gaps] == [(file, "file")]


def test_substitutions_stand_in_each_other() -> None:
    inner = Substitution("text", ("a_", Substitution("configuration", ("b",))))
    assert substituted("$(var a_$(var b))") == Substitution("configuration", (inner,))
    assert isinstance(substituted("$(var a"), Open)
    assert isinstance(substituted("$(var " * 1000), Open)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(st.text(alphabet="$()ar v'\"x"))
def test_no_text_ends_the_reader_of_substitutions(text: str) -> None:
    substituted(text)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(st.text(alphabet="<launchnode/>='\" -:\n[]{}") | st.text(alphabet=st.characters(codec="utf-8")))
def test_no_text_ends_the_reader(tmp_path: Path, text: str) -> None:
    systems(tmp_path, {XML: f"<launch{text}", YAML: f"launch:{text}"})
