"""How to get what an extra of the program brings, into the very environment that it runs in.

In: the name of an extra. Out: a command. It names the packages that the extra brings, which are on the package index;
``rosprivacy`` itself may have come from anywhere, and whoever has its name there is not us. Like the errors, it
stands where every room can use it.
"""

from __future__ import annotations

import re
import shlex
import sys
from pathlib import PurePath

PROGRAM = "rosprivacy"
_OF_EXTRA = re.compile(r"""extra\s*==\s*['"](?P<extra>[\w-]+)['"]""")


def packages(extra: str) -> list[str]:
    """Return what an extra needs, as the installed program says, sorted.

    >>> packages("no-such-extra")
    []
    """
    from importlib.metadata import PackageNotFoundError, requires  # noqa: PLC0415 - light start

    try:
        needed = requires(PROGRAM) or []
    except PackageNotFoundError:  # run from its sources
        return []
    pairs = (line.partition(";") for line in needed)
    return sorted(name.strip() for name, _, marker in pairs if _extra(marker) == extra)


def command_for(extra: str) -> str:
    """Return the command that installs what an extra brings.

    pipx and uv keep programs in environments of their own, which have no pip.

    >>> command_for("no-such-extra")
    'install the extra [no-such-extra] from where rosprivacy came from'
    """
    names = " ".join(shlex.quote(name) for name in packages(extra))
    if not names:
        return f"install the extra [{extra}] from where rosprivacy came from"
    parts = PurePath(sys.prefix).parts
    if "pipx" in parts:
        return f"pipx inject {PROGRAM} {names}"
    if parts[-3:-1] == ("uv", "tools"):
        return f"uv pip install --python {shlex.quote(sys.prefix)} {names}"
    return f"{shlex.quote(sys.executable)} -m pip install {names}"


def _extra(marker: str) -> str:
    told = _OF_EXTRA.search(marker)
    return told["extra"] if told else ""
