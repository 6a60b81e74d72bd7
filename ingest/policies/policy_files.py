"""What the user names on the command line -> policies: files, folders and globs.

In: paths. Out: ``Policy`` facts in a stable order. A file that was named is read or refused. What lies in a folder or
behind a glob and is not read is said (rule S11): grants that no policy brings in with a warning, all else with a
notice. A folder without any policy is an error.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from functools import cache
from glob import has_magic
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import InputError, InputErrors, PolicyError, reason
from rosprivacy.analysis.model import NOT_READ, UNREAD_FILE, Diagnostic, Place, Policy, Severity
from rosprivacy.ingest.policies.folders import Contents, contents, not_read_here
from rosprivacy.ingest.policies.policy_xml import NotAPolicyError, read_policy
from rosprivacy.ingest.reading.confined import WIDEN, leaves, what_leaves
from rosprivacy.ingest.reading.file_kinds import PERMISSIONS, POLICY, kind_of_file

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping, Sequence

    from rosprivacy.analysis.bounds import Bounds


@dataclass(slots=True, eq=False, repr=False)
class _Expanded:
    """The files behind the arguments; ``folder_files`` by folder or glob."""

    named_files: set[str] = field(default_factory=set)
    folder_files: dict[str, set[str]] = field(default_factory=dict)
    contents: dict[str, Contents] = field(default_factory=dict)
    problems: list[InputError] = field(default_factory=list)


def read_policies(
    arguments: Iterable[str],
    *,
    include_root: str | None = None,
    within: str | None = None,
    besides: Iterable[str] = (),
    bounds: Bounds = BOUNDS,
    progress: Callable[[Sequence[str]], Iterable[str]] = lambda files: files,
) -> tuple[tuple[Policy, ...], tuple[Diagnostic, ...]]:
    """Read every policy that the arguments name, each file once.

    Parameters
    ----------
    arguments
        Files, folders (read with all below them) and glob patterns.
    within
        A folder that no file may lie outside of, its own links followed; for arguments that a file names.
    besides
        Files and folders that somebody else reads.
    progress
        Wraps the list of files, to show how far it is.

    Returns
    -------
    policies
        In the order of their paths.
    diagnostics
        For each XML file of a folder that is no policy a notice, or a warning if it has grants that nothing includes;
        for each other file of a folder that is one by its content a warning, and a notice on how many others there are.

    Raises
    ------
    InputErrors
        With the problems of all files.
    """
    arguments = tuple(arguments)
    expanded = _expand(arguments)
    named, found, problems = expanded.named_files, expanded.folder_files, expanded.problems
    everything = sorted({*named, *(file for files in found.values() for file in files)})
    outside = dict.fromkeys(file for file in everything if within is not None and leaves(file, within))
    problems += [PolicyError(file, 0, what_leaves(file, within or ""), WIDEN) for file in outside]
    policies: list[Policy] = []
    skipped: list[NotAPolicyError] = []
    for file in progress([file for file in everything if file not in outside]):
        try:
            policies.append(read_policy(file, include_root=include_root, bounds=bounds))
        except InputErrors as error:
            first = error.errors[0]
            if isinstance(first, NotAPolicyError) and file not in named:
                skipped.append(first)
            else:
                problems += _of_another_kind(file) or error.errors
    no_policies = {error.file for error in skipped}
    for argument, files in found.items():
        if files <= no_policies:
            problems.append(PolicyError(argument, 0, "no SROS 2 policy found", "name a file or folder that has one"))
    if not arguments:
        problems.append(PolicyError("nothing", 0, "no SROS 2 policy found", "name a file or folder that has one"))
    if problems:
        raise InputErrors(problems)
    if not expanded.contents:
        return tuple(policies), ()
    included = _included(policies)
    read = {*included, *map(os.path.realpath, besides), *map(os.path.realpath, named)}
    passed_over = (
        one for argument, held in expanded.contents.items() for one in held.diagnostics(argument, read, bounds)
    )
    return tuple(policies), (*(_not_read(error, included) for error in skipped), *passed_over)


def _of_another_kind(file: str) -> list[InputError]:
    """The one thing that is wrong with a file that is something else by its content; none for a policy."""
    try:
        kind = kind_of_file(file)
    except (OSError, ValueError):
        return []  # who reads it says why not
    return [PolicyError(file, 1, *kind.refused("a policy", file))] if kind not in (None, POLICY, PERMISSIONS) else []


def _included(policies: Iterable[Policy]) -> dict[str, set[tuple[int, str, str]]]:
    """Real path of each file that was read -> (line, kind, role) of what policies took of it."""
    taken: dict[str, set[tuple[int, str, str]]] = {}
    real = cache(os.path.realpath)
    for policy in policies:
        for name, _ in policy.sources:
            taken.setdefault(real(name), set())
        for grant in policy.grants:
            taken.setdefault(real(grant.place.file), set()).add((grant.place.line, grant.kind, grant.role))
    return taken


def _not_read(error: NotAPolicyError, included: Mapping[str, Collection[tuple[int, str, str]]]) -> Diagnostic:
    """What is to be said of XML that is no policy: grants that nothing brings in are a gap (rule S11)."""
    place = Place(error.file, error.line)
    if error.deployed:
        return not_read_here(place, "it is")
    taken = included.get(os.path.realpath(error.file))
    if taken is None and (error.grants or error.includes):
        what = f"not read: {error.problem}, and no policy read here includes it, so what it grants is not known"
        return Diagnostic(place, Severity.WARNING, f"{what}; name the policy that does, or remove it", UNREAD_FILE)
    left = sorted(line for line, *_ in error.grants.difference(taken or ()))
    if left:
        what = f"not read whole: of this file no policy read here includes what stands at line {left[0]}"
        more = f" and {len(left) - 1} more" if len(left) > 1 else ""
        hint = "include it, name the policy that does, or remove it"
        return Diagnostic(place, Severity.WARNING, f"{what}{more}; {hint}", UNREAD_FILE)
    return Diagnostic(place, Severity.NOTICE, f"not read by itself: {error.problem}", NOT_READ)


def _expand(arguments: Iterable[str]) -> _Expanded:
    """Return the files named, what folders and globs hold, and what is not there; each file under one spelling."""
    expanded = _Expanded()
    spelt: dict[str, str] = {}
    for argument in sorted(set(arguments), key=lambda name: (len(name), name)):
        try:
            held = contents(argument)
        except (OSError, ValueError) as error:
            what = f"cannot be read: {reason(error)}"
            expanded.problems.append(PolicyError(argument or "''", 0, what, "name a policy"))
            continue
        if held is None:
            expanded.named_files.add(spelt.setdefault(os.path.abspath(argument), argument))  # noqa: PTH100 - by its text
            continue
        expanded.problems += held.problems
        expanded.contents[argument] = held
        if held.files:
            expanded.folder_files[argument] = {
                spelt.setdefault(os.path.abspath(file), file)  # noqa: PTH100
                for file in sorted(held.files)
            }
        elif not held.problems:
            glob = has_magic(argument) and not Path(argument).is_dir()
            what = "no file matches" if glob else "a folder with no .xml file"
            hint = "correct the pattern" if glob else "name a policy"
            expanded.problems.append(PolicyError(argument, 0, what, hint))
    return expanded
