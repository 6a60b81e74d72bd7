"""What a scan of a checkout costs: it grows with the checkout and no faster, and is some times parsing alone.

A workspace of packages in Python and C++ (``source_code.py`` says which), each with its manifest, what it installs and
a launch file that starts its nodes. A scan is all from the folder to its systems. Parsing alone is what Python's own
parser and tree-sitter take for the code and the launch files.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from source_code import rows_of, workspace

from rosprivacy.ingest.scan.checkout import read_checkout, systems_of

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from measure import Row

TIMES_PARSING = 15.0
FEW, TIMES = 13, 10  # packages of eight files; the large workspace has so many times more
MANIFEST = "<package><name>p{0}</name><exec_depend>rclpy</exec_depend><depend>rclcpp</depend></package>\n"
SETUP = "from setuptools import setup\nsetup(name='p{0}', entry_points={{'console_scripts': ['node = p.node:main']}})\n"
CMAKE = "add_executable(show src/show.cpp)\ninstall(TARGETS show DESTINATION lib/p{0})\n"
LAUNCH = (
    "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n"
    "def generate_launch_description():\n"
    "    return LaunchDescription([\n"
    "        Node(package='p{0}', executable='node', namespace='robot', remappings=[('image', 'image{0}')]),\n"
    "        Node(package='p{0}', executable='show', name='show{0}'),\n    ])\n"
)
FILES = (
    ("package.xml", MANIFEST),
    ("setup.py", SETUP),
    ("CMakeLists.txt", CMAKE),
    ("launch/robot.launch.py", LAUNCH),
)


def rows(*, quick: bool) -> Iterator[Row]:
    """Declare what is measured."""
    yield from rows_of(f"scanning {FEW * TIMES} packages", checkout, scan, (FEW, TIMES), TIMES_PARSING, quick=quick)


def checkout(folder: Path, packages: int) -> str:
    """Write so many packages."""
    workspace(folder, packages)
    for number in range(packages):
        for name, text in FILES:
            file = folder / f"p{number}" / name
            file.parent.mkdir(exist_ok=True)
            file.write_text(text.format(number), "utf-8")
    return str(folder)


def scan(folder: str) -> object:
    """All that a folder says, as if nothing had been read before."""
    return systems_of(read_checkout(folder))
