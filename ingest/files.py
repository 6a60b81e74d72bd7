"""What the user names on the command line -> policies: files, folders and globs.

In: paths. Out: ``Policy`` facts in a stable order. A file that was named is read or refused; in a folder or behind a
glob, XML that is no policy is passed over with a notice, and a folder without any policy is an error.
"""

from __future__ import annotations

from glob import glob, has_magic
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors, PolicyError, shown
from rosprivacy.analysis.model import Diagnostic, Place, Policy, Severity
from rosprivacy.ingest.policy import NotAPolicyError, read_policy
from rosprivacy.ingest.xinclude import MAX_BYTES

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence


def read_policies(
    arguments: Iterable[str],
    *,
    include_root: str | None = None,
    max_bytes: int = MAX_BYTES,
    progress: Callable[[Sequence[str]], Iterable[str]] = lambda files: files,
) -> tuple[tuple[Policy, ...], tuple[Diagnostic, ...]]:
    """Read every policy that the arguments name, each file once.

    Parameters
    ----------
    arguments
        Files, folders (read with all below them) and glob patterns.
    progress
        Wraps the list of files, to show how far it is.

    Returns
    -------
    policies
        In the order of their paths.
    diagnostics
        A notice for each XML file of a folder that is no policy.

    Raises
    ------
    InputErrors
        With the problems of all files.
    """
    named, found, problems = _expand(arguments)
    policies: list[Policy] = []
    skipped: list[InputError] = []
    for file in progress(sorted(named | found)):
        try:
            policies.append(read_policy(file, include_root=include_root, max_bytes=max_bytes))
        except InputErrors as error:
            fragment = isinstance(error.errors[0], NotAPolicyError) and file not in named
            (skipped if fragment else problems).extend(error.errors)
    if not policies and not problems:
        where = ", ".join(shown(argument) for argument in arguments) or "nothing"
        problems = [PolicyError(where, 0, "no SROS 2 policy found", "name a file or folder that has one")]
    if problems:
        raise InputErrors(problems)
    notices = [Diagnostic(Place(e.file, e.line), Severity.NOTICE, f"not read by itself: {e.problem}") for e in skipped]
    return tuple(policies), tuple(notices)


def _expand(arguments: Iterable[str]) -> tuple[set[str], set[str], list[InputError]]:
    """Return the files named, the files found in folders and by globs, and what is not there."""
    named: set[str] = set()
    found: set[str] = set()
    problems: list[InputError] = []
    for argument in arguments:
        path = Path(argument)
        if path.is_dir():
            inside = {str(file) for file in path.rglob("*.xml") if file.is_file()}
            if not inside:
                problems.append(PolicyError(argument, 0, "a folder with no .xml file", "name a policy"))
            found |= inside
        elif has_magic(argument) and not path.exists():
            found_here = glob(argument, recursive=True)  # noqa: PTH207 - absolute patterns too
            matches = {match for match in found_here if Path(match).is_file()}
            if not matches:
                problems.append(PolicyError(argument, 0, "no file matches", "correct the pattern"))
            found |= matches
        else:
            named.add(argument)
    return named, found, problems
