"""What pre-commit runs: ``analyze``; in CI with what decides as the base revision has it.

In: words of ``analyze``, and from pre-commit the revision that changes are compared with (``pre-commit run --from-ref
REVISION --to-ref HEAD``). Out: what ``analyze`` ends with. A person's own commit has no such revision: it is analysed
as it stands.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import RosPrivacyError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rosprivacy.cli.project_file import Project

BASE = "PRE_COMMIT_FROM_REF"  # pre-commit sets it


def main() -> None:
    """Run ``analyze`` with the words of the command line, and end with its exit code."""
    from rosprivacy.cli.app import main as run

    words = sys.argv[1:]
    if revision := os.environ.get(BASE, ""):
        try:
            words = words_under(revision, words)
        except RosPrivacyError as error:
            print(error, file=sys.stderr)
            sys.exit(error.exit_code)
    sys.argv = ["rosprivacy", "analyze", *words]
    run()


def words_under(revision: str, words: Sequence[str]) -> list[str]:
    """Return words of ``analyze`` that take what decides from a revision, and the system from the working folder."""
    from rosprivacy.cli.base_revision import Copies, git_path
    from rosprivacy.cli.project_file import project_of

    project = project_of(None)
    system = [*_system(project, words)] if project else []
    of_base = Copies(revision, Path(git_path("rosprivacy.base"))).words(words)
    return ["--no-project", *system, *of_base]


def _system(project: Project, words: Sequence[str]) -> Iterator[str]:
    """What the project file of the working folder says of the system, and the words do not."""
    stated = _parsed(words)
    if not project.is_about(stated["policies"], stated["fleet"]):
        return
    if not stated["policies"] and not stated["fleet"]:
        yield from ["--fleet", _plain(project.fleet)] if project.fleet else []
    for option in ("labels", "types"):
        for name in getattr(project, option) if not stated[option] else ():
            yield from (f"--{option}", _plain(name))
    if project.domain is not None and stated["domain"] is None:
        yield from ("--domain", str(project.domain))
    if not stated["policies"] and not stated["fleet"]:
        yield from map(_plain, project.policies)


def _plain(name: str) -> str:
    """A name that no option is called."""
    return f"./{name}" if name.startswith("-") else name


def _parsed(words: Sequence[str]) -> dict[str, Any]:
    """The values of options, by name."""
    from typer.main import get_command

    from rosprivacy.cli.app import program

    group: Any = get_command(program("analyze"))
    context = group.commands["analyze"].make_context("analyze", [*words], resilient_parsing=True)
    values: dict[str, Any] = context.params
    return values


if __name__ == "__main__":
    main()
