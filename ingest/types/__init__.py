"""Message types that were observed: their file, and how it is joined to a graph (rules S15, S16)."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

TABLE = "rosprivacy:types"  # the shipped table of types, as a report names it


def types_path(policy: Path) -> Path:
    """Return where the types that were observed with a policy are written: in the same folder.

    >>> from pathlib import Path
    >>> str(types_path(Path("a/robot.policy.xml"))), str(types_path(Path("robot.xml")))
    ('a/robot.types.yaml', 'robot.types.yaml')
    """
    return named_after(policy, "types")


def named_after(policy: Path, content: str) -> Path:
    """Return the file in a policy's folder that has its name, and what it contains in the place of ``policy``.

    >>> from pathlib import Path
    >>> str(named_after(Path("robot.policy.xml"), "declared.labels"))
    'robot.declared.labels.yaml'
    """
    name = policy.name
    for ending in (".policy.xml", ".xml"):
        if name.lower().endswith(ending) and len(name) > len(ending):
            name = name[: -len(ending)]
            break
    return policy.with_name(f"{name}.{content}.yaml")
