"""What the user names on the command line -> policies: files, folders and globs.

In: paths. Out: ``Policy`` facts in a stable order. A file that was named is read or refused; in a folder or behind a
glob, XML that is no policy is passed over with a notice, and a folder without any policy is an error.
"""

from __future__ import annotations

import os
from glob import glob, has_magic
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors, PolicyError, reason
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
    arguments = tuple(arguments)
    named, found, problems = _expand(arguments)
    policies: list[Policy] = []
    skipped: list[InputError] = []
    for file in progress(sorted({*named, *(file for files in found.values() for file in files)})):
        try:
            policies.append(read_policy(file, include_root=include_root, max_bytes=max_bytes))
        except InputErrors as error:
            fragment = isinstance(error.errors[0], NotAPolicyError) and file not in named
            (skipped if fragment else problems).extend(error.errors)
    passed_over = {error.file for error in skipped}
    for argument, files in found.items():
        if files <= passed_over:
            problems.append(PolicyError(argument, 0, "no SROS 2 policy found", "name a file or folder that has one"))
    if not arguments:
        problems.append(PolicyError("nothing", 0, "no SROS 2 policy found", "name a file or folder that has one"))
    if problems:
        raise InputErrors(problems)
    notices = [Diagnostic(Place(e.file, e.line), Severity.NOTICE, f"not read by itself: {e.problem}") for e in skipped]
    return tuple(policies), tuple(notices)


def _expand(arguments: Iterable[str]) -> tuple[set[str], dict[str, set[str]], list[InputError]]:
    """Return the files named, what folders and globs hold, and what is not there; each file under one spelling."""
    named: set[str] = set()
    found: dict[str, set[str]] = {}
    problems: list[InputError] = []
    spelt: dict[str, str] = {}
    for argument in sorted(set(arguments), key=lambda name: (len(name), name)):
        try:
            files = _inside(argument)
        except (OSError, ValueError) as error:
            problems.append(PolicyError(argument or "''", 0, f"cannot be read: {reason(error)}", "name a policy"))
            continue
        if files is None:
            named.add(spelt.setdefault(os.path.abspath(argument), argument))  # noqa: PTH100 - by its text
        elif files:
            found[argument] = {spelt.setdefault(os.path.abspath(file), file) for file in sorted(files)}  # noqa: PTH100
        else:
            what = "no file matches" if has_magic(argument) else "a folder with no .xml file"
            problems.append(
                PolicyError(argument, 0, what, "correct the pattern" if has_magic(argument) else "name a policy")
            )
    return named, found, problems


def _inside(argument: str) -> set[str] | None:
    """The files of a folder or glob; None for a file that is named."""
    path = Path(argument)
    if not argument:
        raise ValueError("no name")
    if path.is_dir():
        return {str(file) for file in path.rglob("*.xml") if file.is_file()}
    if has_magic(argument) and not path.exists():
        matches = glob(argument, recursive=True)  # noqa: PTH207 - absolute patterns too
        return {match for match in matches if Path(match).is_file()}
    return None
