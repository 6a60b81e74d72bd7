"""Checkouts with launch files of our own, for tests."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.ingest.scan.checkout_files import checkout_files
from rosprivacy.ingest.scan.launch.launch_files import read_launches
from rosprivacy.ingest.scan.packages import read_packages

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.ingest.scan.scan_facts import LaunchedSystem, StartedNode

MANIFEST = "<package format='3'><name>{}</name></package>"
HEAD = """
import os
from pathlib import Path
import launch
import launch_ros
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import (DeclareLaunchArgument, ExecuteProcess, GroupAction, IncludeLaunchDescription, LogInfo,
    OpaqueFunction, RegisterEventHandler, SetEnvironmentVariable, SetLaunchConfiguration, TimerAction)
from launch.conditions import IfCondition, LaunchConfigurationEquals, UnlessCondition
from launch.event_handlers import OnProcessExit, OnProcessStart
from launch.launch_description_sources import AnyLaunchDescriptionSource, PythonLaunchDescriptionSource
from launch.substitutions import (EnvironmentVariable, LaunchConfiguration, PathJoinSubstitution, PythonExpression,
    TextSubstitution, ThisLaunchFileDir)
from launch_ros.actions import (ComposableNodeContainer, LifecycleNode, LoadComposableNodes, Node, PushRosNamespace,
    SetParameter, SetRemap)
from launch_ros.descriptions import ComposableNode, ParameterFile, ParameterValue
from launch_ros.substitutions import FindPackageShare
from nav2_common.launch import RewrittenYaml
"""
FILE = "care/launch/care.launch.py"


def checkout(root: Path, files: dict[str, str]) -> Path:
    """Write a checkout with a package ``care``."""
    for name, text in {"care/package.xml": MANIFEST.format("care"), **files}.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    return root


def systems(root: Path, files: dict[str, str]) -> tuple[LaunchedSystem, ...]:
    """Read the launch files of a checkout."""
    checkout(root, files)
    return read_launches(root, read_packages(checkout_files(root)))


def python(body: str) -> str:
    """Return a launch file whose function has a body; ``NODE(…)`` in it is a node of package p, executable e."""
    nodes = body.replace("NODE(", "Node(package='p', executable='e', ")
    inner = "\n".join(f"    {line}" for line in nodes.strip("\n").split("\n"))
    return f"{HEAD}\ndef generate_launch_description():\n{inner}\n"


def listed(actions: str) -> str:
    """Return a launch file with a list of actions."""
    return python(f"return LaunchDescription([{actions}])")


def system(root: Path, text: str, file: str = FILE, files: dict[str, str] | None = None) -> LaunchedSystem:
    """Read the only system of a checkout with a launch file that no other includes."""
    read = systems(root, {file: text, **(files or {})})
    assert len(read) == 1
    return read[0]


def names(read: LaunchedSystem) -> list[str]:
    """Return the full names of what a system starts, as far as launch files name them."""
    return [full_name(one) for one in read.started]


def full_name(one: StartedNode) -> str:
    """Return the full name of a node."""
    return f"{(one.namespace or '').rstrip('/')}/{one.name}"
