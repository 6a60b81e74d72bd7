"""What the user names on the command line -> policies: files, folders and globs.

In: paths. Out: ``Policy`` facts in a stable order. A file that was named is read or refused. What lies in a folder or
behind a glob and is not read is said (rule S11): grants that no policy brings in with a warning, all else with a
notice. A folder without any policy is an error. Links are followed, each folder is entered once whatever leads to it,
and nothing is left out in silence: of what does not end in ``.xml`` the beginning is looked at, and a link to nothing
is a problem.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from functools import cache
from glob import glob, has_magic
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import InputError, InputErrors, PolicyError, reason, shown
from rosprivacy.analysis.model import ACCESS_GAP, NOT_READ, UNREAD_FILE, Diagnostic, Place, Policy, Severity
from rosprivacy.ingest.policies.policy_xml import NotAPolicyError, read_policy
from rosprivacy.ingest.reading.bounded_file import WIDEN, leaves, what_leaves
from rosprivacy.ingest.reading.file_kinds import ACCESS_LIST, PERMISSIONS, POLICY, FileKind, kind_of_file
from rosprivacy.ingest.reading.path_kinds import exists, is_dir, is_file

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Container, Iterable, Iterator, Mapping, Sequence
    from collections.abc import Set as AbstractSet

    from rosprivacy.analysis.bounds import Bounds

SIGNED = ".p7s"
KEYS = (".pem", ".key")  # never opened
UNREADABLE = FileKind("a file that cannot be read", "check its permissions")
GRANTING = (POLICY, ACCESS_LIST, PERMISSIONS, UNREADABLE)  # or it may be
SHOWN_AT_MOST = 3  # of the files that are passed over
FEWEST_WRONG = 3  # files of a folder that cannot be read: then it may be the wrong folder


@dataclass(slots=True, eq=False, repr=False)
class Contents:
    """What a folder or a glob holds.

    Attributes
    ----------
    files
        To be read.
    passed_over
        Passed over, since their names do not end in ``.xml``.
    hidden
        Those of the others that a person does not see; they are not counted.
    """

    files: set[str] = field(default_factory=set)
    passed_over: set[str] = field(default_factory=set)
    hidden: set[str] = field(default_factory=set)
    problems: list[InputError] = field(default_factory=list)

    def diagnostics(self, argument: str, read: Collection[str], bounds: Bounds = BOUNDS) -> Iterator[Diagnostic]:
        """Yield what is to be said of what is passed over: what it is by its content, not by its name (rule S11).

        Parameters
        ----------
        read
            Real paths of files and folders that were read all the same.
        """
        left = sorted(self.passed_over, key=lambda name: (name in self.hidden, name))
        left = [name for name in left if not _within(os.path.realpath(name), read)]
        looked = left[: bounds.passed_over]
        kinds = {name: looked_at(name) for name in looked}
        permissions = {name for name, kind in kinds.items() if kind is PERMISSIONS}
        if permissions:
            count = "1 file is" if len(permissions) == 1 else f"{len(permissions):,} files are"
            yield not_read_here(Place(argument, 0), f"{count} ({_names_shown(permissions, argument)})")
        yield from _unread((name, kind) for name, kind in kinds.items() if kind is not PERMISSIONS)
        if len(looked) < len(left):
            what = "; ".join(bounds.refusal("passed_over", len(left)))
            yield Diagnostic(Place(argument, 0), Severity.WARNING, f"not all looked into: {what}", UNREAD_FILE)
        others = {name for name, kind in kinds.items() if kind not in GRANTING and name not in self.hidden}
        if others:
            count = "1 file is" if len(others) == 1 else f"{len(others):,} files are"
            message = f"{count} not read, as the name does not end in .xml: {_names_shown(others, argument)}"
            yield Diagnostic(Place(argument, 0), Severity.NOTICE, message, NOT_READ)


def beside_keystore(folder: str, read: Collection[str]) -> Iterator[Diagnostic]:
    """Yield what is to be said of policies and access lists in a keystore: no middleware reads them there."""
    held = [
        contents(str(entry)) or Contents({str(entry)})
        for entry in Path(folder).iterdir()
        if entry.name not in ("public", "private")
    ]
    files = sorted({name for one in held for name in one.files | one.passed_over})
    kinds = ((name, looked_at(name)) for name in files if not _within(os.path.realpath(name), read))
    return _unread((name, kind) for name, kind in kinds if kind is not PERMISSIONS)  # beside those that are signed


def _unread(kinds: Iterable[tuple[str, FileKind | None]]) -> Iterator[Diagnostic]:
    """Yield the gap that a file with grants is which nobody reads, whatever its name."""
    for name, kind in kinds:
        if kind in GRANTING:
            what = f"not read: it is {kind.name}, and what it grants is not known"
            yield Diagnostic(
                Place(name, 0), Severity.WARNING, f"{what}; {kind.instead}, or move it out of the folder", UNREAD_FILE
            )


def looked_at(name: str) -> FileKind | None:
    """Return what a file is by its content; of keys and what is signed by its name, since these are not opened."""
    ending = Path(name).suffix.lower()
    if ending == SIGNED or ending in KEYS:
        return PERMISSIONS if ending == SIGNED else None
    try:
        return kind_of_file(name)
    except (OSError, ValueError):
        return UNREADABLE


def _within(file: str, read: Collection[str]) -> bool:
    return file in read or any(str(folder) in read for folder in Path(file).parents)


def _names_shown(files: Iterable[str], argument: str) -> str:
    names = sorted(shown(os.path.relpath(name, argument) if is_dir(argument) else name) for name in files)
    return ", ".join([*names[:SHOWN_AT_MOST], *(["…"] if len(names) > SHOWN_AT_MOST else [])])


def not_read_here(place: Place, subject: str) -> Diagnostic:
    """Return the gap that permissions or governance in a folder of policies are: what is deployed is not read."""
    message = f"not read: {subject} permissions or governance, and what that grants is not known"
    return Diagnostic(
        place, Severity.WARNING, f"{message}; name it by itself, or move it out of the folder", ACCESS_GAP
    )


def contents(argument: str) -> Contents | None:
    """Return what a folder or a glob holds; None for a file that is named.

    Raises
    ------
    OSError, ValueError
        If there can be no such path.
    """
    if not argument:
        raise ValueError("no name")
    path = Path(argument)
    found = _FolderWalk(len(path.parts) - has_magic(argument))
    if is_dir(path):
        found.folder(argument)
    elif has_magic(argument) and not exists(path):
        for match in sorted(glob(argument, recursive=True)):  # noqa: PTH207 - absolute patterns too
            found.match(match)
    else:
        return None
    found.links()
    return found.contents


class _FolderWalk:
    """Walks folders: first those that stand there, then those that only a link leads to."""

    def __init__(self, depth: int) -> None:
        self.depth = depth  # of what was named, in parts of its path: above it, hidden folders are no matter
        self.contents = Contents()
        self._entered: set[str] = set()
        self._links: list[str] = []

    def match(self, name: str) -> None:
        """What a glob matches: a file whatever it is called, or a folder."""
        if is_file(name):
            self.contents.files.add(name)
        elif is_dir(name):
            (self._links.append if Path(name).is_symlink() else self.folder)(name)
        else:
            self._entry(name)

    def folder(self, name: str) -> None:
        waiting = [name]
        while waiting:
            folder = waiting.pop()
            real = os.path.realpath(folder)
            if real in self._entered:
                continue
            self._entered.add(real)
            try:
                entries = sorted(os.listdir(folder))
            except OSError as error:
                hint = "check its permissions"
                self.contents.problems.append(PolicyError(folder, 0, f"cannot be read: {reason(error)}", hint))
                continue
            for entry in entries:
                path = str(Path(folder, entry))
                if not is_dir(path):
                    self._entry(path)
                elif Path(path).is_symlink():
                    self._links.append(path)
                else:
                    waiting.append(path)

    def links(self) -> None:
        """Enter the folders that links lead to, and what links in these lead to."""
        while self._links:
            self.folder(self._links.pop(0))

    def _entry(self, name: str) -> None:
        path = Path(name)
        if path.is_symlink() and not exists(path):
            what = f"a link to nothing: {shown(str(path.readlink()))}"
            self.contents.problems.append(PolicyError(name, 0, what, "correct the link, or remove it"))
        elif is_file(path) and path.suffix.lower() == ".xml":
            self.contents.files.add(name)
        else:
            self.contents.passed_over.add(name)
            if any(part.startswith(".") for part in path.parts[self.depth :]):
                self.contents.hidden.add(name)


@dataclass(slots=True, eq=False, repr=False)
class _Expanded:
    """The files behind the arguments; ``folder_files`` by folder or glob."""

    named_files: set[str] = field(default_factory=set)
    folder_files: dict[str, set[str]] = field(default_factory=dict)
    contents: dict[str, Contents] = field(default_factory=dict)
    problems: list[InputError] = field(default_factory=list)

    @property
    def files(self) -> list[str]:
        """All of them, each once."""
        return sorted({*self.named_files, *(file for files in self.folder_files.values() for file in files)})


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
    named, found = expanded.named_files, expanded.folder_files
    outside = dict.fromkeys(file for file in expanded.files if within is not None and leaves(file, within))
    inside = [file for file in expanded.files if file not in outside]
    policies, skipped, unread = _read_each(progress(inside), named, include_root, bounds)
    problems = [
        *expanded.problems,
        *(PolicyError(file, 0, what_leaves(file, within or ""), WIDEN) for file in outside),
        *unread,
        *_without_policies(arguments, found, {error.file for error in skipped}),
    ]
    if problems:
        good = {policy.file for policy in policies}
        whole = [one for folder in found for one in _mixed(folder, found[folder], good, problems)]
        raise InputErrors([*whole, *problems])
    if not expanded.contents:
        return tuple(policies), ()
    included = _included(policies)
    read = {*included, *map(os.path.realpath, besides), *map(os.path.realpath, named)}
    passed_over = (
        one for argument, held in expanded.contents.items() for one in held.diagnostics(argument, read, bounds)
    )
    return tuple(policies), (*(_not_read(error, included) for error in skipped), *passed_over)


class _Reading(NamedTuple):
    """What came of files: policies, what a folder holds beside these, and what is wrong."""

    policies: list[Policy]
    skipped: list[NotAPolicyError]
    problems: list[InputError]


def _read_each(files: Iterable[str], named_files: Container[str], include_root: str | None, bounds: Bounds) -> _Reading:
    """Read files; one that is no policy is a problem only where somebody named it."""
    reading = _Reading([], [], [])
    for file in files:
        try:
            reading.policies.append(read_policy(file, include_root=include_root, bounds=bounds))
        except InputErrors as error:
            first = error.errors[0]
            if isinstance(first, NotAPolicyError) and file not in named_files:
                reading.skipped.append(first)
            else:
                reading.problems.extend(_of_another_kind(file) or error.errors)
    return reading


def _without_policies(
    arguments: Collection[str], folder_files: Mapping[str, AbstractSet[str]], no_policies: AbstractSet[str]
) -> Iterator[PolicyError]:
    """Name each folder that has no policy; and where nothing is named, say so."""
    for argument in (one for one, files in folder_files.items() if files <= no_policies) if arguments else ("nothing",):
        yield PolicyError(argument, 0, "no SROS 2 policy found", "name a file or folder that has one")


def _mixed(
    folder: str, files: Collection[str], read: Iterable[str], problems: Iterable[InputError]
) -> Iterator[PolicyError]:
    """Say of a folder of many files that cannot be read first what is in it: it may be the wrong one."""
    wrong = {problem.file for problem in problems} & {*files}
    if len(wrong) < FEWEST_WRONG:
        return
    good = sorted({*read} & {*files})
    policies = "1 is a policy" if len(good) == 1 else f"{len(good) or 'none'} are policies"
    what = f"of its {len(files):,} files that are looked at {policies}, and {len(wrong):,} cannot be read"
    named = f": {_names_shown(good, folder)}" if good else ""
    yield PolicyError(folder, 0, what, f"name the policies{named}" if good else "name a folder that has policies")


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
            glob = has_magic(argument) and not is_dir(argument)
            what = "no file matches" if glob else "a folder with no .xml file"
            hint = "correct the pattern" if glob else "name a policy"
            expanded.problems.append(PolicyError(argument, 0, what, hint))
    return expanded
