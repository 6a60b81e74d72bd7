"""What commands that read a system do with their arguments."""

from __future__ import annotations

from typing import TYPE_CHECKING

import typer

if TYPE_CHECKING:
    from rosprivacy.settings import Settings


def named(policies: list[str] | None, settings: Settings) -> tuple[str, ...]:
    """Return the policies that are named; there has to be one, or a saved graph."""
    if not policies and not settings.add:
        raise typer.BadParameter("name at least one policy: a file, a folder or a glob", param_hint="POLICY")
    return tuple(policies or ())
