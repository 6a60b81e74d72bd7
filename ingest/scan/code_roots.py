"""What a user names -> the folder of sources to read, and the launch file in it; light, since every command asks it.

A folder with a policy or permissions in it is none: these are read, as they say what is granted.
"""

from __future__ import annotations

import os
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

from rosprivacy.ingest.deployed.deployed_paths import is_keystore
from rosprivacy.ingest.reading.file_kinds import ACCESS_LIST, DESCRIPTIONS, LAUNCH, PERMISSIONS, POLICY, kind_of_file
from rosprivacy.ingest.reading.path_kinds import is_dir, is_file

if TYPE_CHECKING:
    from collections.abc import Iterable

MANIFEST = "package.xml"
CODE = (".py", ".cpp", ".cc", ".cxx", ".hpp")
GRANTING = (POLICY, PERMISSIONS, ACCESS_LIST)
AMENT_INDEX = ["ament_index", "resource_index", "nodl"]
"""The folders of an ament index in which descriptions lie, as ``package__name``."""


def in_ament_index(file: str) -> bool:
    """Return whether a file is a description in an ament index, by its path.

    >>> in_ament_index("share/ament_index/resource_index/nodl/camera__driver")
    True
    """
    *folders, name = file.split("/")
    return "__" in name and folders[-3:] == AMENT_INDEX


def root_of(name: str, *, granted: bool = False) -> tuple[str, str] | None:
    """Return the folder to read and the launch file in it that a user names; None of what is no code.

    Of a launch file or a description it is the folder with its package, and with the packages that lie beside that.

    Parameters
    ----------
    granted
        Whether a folder with a policy or permissions in it counts, too: then only its code is read.
    """
    path = Path(name)
    try:
        if is_dir(path):
            return (name, "") if not is_keystore(name) and _is_code(name, granted=granted) else None
        if not is_file(path) or not (name.endswith(DESCRIPTIONS) or kind_of_file(name) == LAUNCH):
            return None
    except (OSError, ValueError):
        return None
    package = next((above for above in path.absolute().parents if is_file(above / MANIFEST)), path.absolute().parent)
    if any(is_file(other / MANIFEST) for other in package.parent.iterdir() if other != package and is_dir(other)):
        package = package.parent
    inner = path.absolute().relative_to(package).as_posix()
    return os.path.relpath(package), inner


def read_as_one(roots: Iterable[tuple[str, str]]) -> list[tuple[tuple[str, ...], str]]:
    """Return what is read together: (folders, launch file as the user would open it), for each launch file.

    All folders are one checkout: a launch file of one can start nodes of another. Where launch files are named, these
    count; the folders beside them hold code that they start.

    >>> read_as_one([("robot", ""), ("drivers", "")])
    [(('robot', 'drivers'), '')]
    >>> read_as_one([("robot", "a.launch.py"), ("drivers", "")])
    [(('robot', 'drivers'), 'robot/a.launch.py')]
    """
    listed = list(dict.fromkeys(roots))
    folders = tuple(folder for folder, launch in listed if not launch)
    started = [(folder, str(Path(folder, launch))) for folder, launch in listed if launch]
    if not started:
        return [(folders, "")] if folders else []
    return [(tuple(dict.fromkeys((folder, *folders))), launch) for folder, launch in started]


def _is_code(folder: str, *, granted: bool) -> bool:
    from rosprivacy.ingest.scan.checkout_files import checkout_files  # noqa: PLC0415 - light start

    checkout = checkout_files(folder)
    files = checkout.files
    endings = {file: PurePosixPath(file).suffix.lower() for file in files}
    has_code = any(
        ending in CODE
        or PurePosixPath(file).name == MANIFEST
        or file.endswith(DESCRIPTIONS)
        or in_ament_index(f"{checkout.root}/{file}")
        for file, ending in endings.items()
    )
    return has_code and (
        granted or not any(ending == ".xml" and _grants(Path(folder, file)) for file, ending in endings.items())
    )


def _grants(file: Path) -> bool:
    try:
        return kind_of_file(str(file)) in GRANTING
    except (OSError, ValueError):
        return False
