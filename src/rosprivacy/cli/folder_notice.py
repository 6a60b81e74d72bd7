"""A notice for who names nothing: what lies in the working folder, and the one command to begin with.

In: a folder; its files are looked at by their beginning, a bounded number of them. Out: one line.
"""

from __future__ import annotations

import os
import shlex
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputErrors, shown

if TYPE_CHECKING:
    from rosprivacy.ingest.reading.file_kinds import FileKind

LOOKED_AT = 200  # files of a folder
PACKAGES = ("*/package.xml", "src/*/package.xml")  # of a workspace
NOTHING = "this folder has no policy and no text of `ros2 node info`; on the robot, or where its nodes run, begin with"
ROS2 = "rosprivacy try --ros2"


def folder_notice(folder: Path) -> str:
    """Return what lies in a folder and the command that takes it."""
    from rosprivacy.cli.project_file import nearest_project
    from rosprivacy.ingest.reading.file_kinds import BAG, NODE_INFO, POLICY

    try:
        project = nearest_project(folder)
    except (InputErrors, OSError):
        project = None  # who reads it says what is wrong with it
    if project:
        return f"the project file {shown(os.path.relpath(project, folder))} says what is looked at: rosprivacy analyze"
    kinds = _kinds(folder)
    for kind in (POLICY, NODE_INFO):
        names = [name for name, other in kinds.items() if other == kind]
        if len(names) > 1 and kind == POLICY:
            return f"{len(names)} files have lines of policies: rosprivacy try ."
        if names:
            return f"{shown(names[0])} is {kind.name}: rosprivacy try {shlex.quote(shown(names[0]))}"
    if (folder / "enclaves").is_dir():
        return "this folder looks like a keystore: rosprivacy try ."
    for name, other in kinds.items():
        if other.key in ("", BAG):
            instead = other.instead.replace("FILE", shlex.quote(shown(name))).replace("FOLDER", ".")
            return f"{shown(name)} is {other.name}: {instead}"
    workspace = any(True for pattern in PACKAGES for _ in folder.glob(pattern))
    return "packages of ROS 2 lie below this folder: rosprivacy try ." if workspace else f"{NOTHING} {ROS2}"


def _kinds(folder: Path) -> dict[str, FileKind]:
    """Files of a folder by name, with what they are by their content; in the order of names."""
    from rosprivacy.ingest.reading.file_kinds import kind_of_file

    found = {}
    try:
        names = sorted(entry.name for entry in islice(os.scandir(folder), LOOKED_AT) if entry.is_file())
    except OSError:
        return {}
    for name in names:
        try:
            kind = kind_of_file(str(folder / name))
        except (OSError, ValueError):
            continue
        if kind is not None:
            found[name] = kind
    return found
