"""A repository as a revision of git has it, for as long as a block lasts.

In: a revision, and a file or folder of the repository. Out: a folder of its own, in which the repository lies where it
lies from the working folder, which moves there too: so every name leads to the file as the revision has it. Git hands
over what it has stored, file by file: `git archive` and `git checkout` would run filters that the repository names.
Links are written last, so nothing is written through one; a submodule is not there.
"""

from __future__ import annotations

import os
import subprocess
import tempfile
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import InputError, InputErrors, reason, shown
from rosprivacy.analysis.python_311 import chdir
from rosprivacy.cli.base_revision import FETCH, GIT, commit_of, git, git_environment

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

LINK, SUBMODULE = "120000", "160000"  # modes of git


class StoredFile(NamedTuple):
    """What a tree of git says of a file; the name is from the root of the repository."""

    mode: str
    object: str
    name: str


def from_root(name: str) -> Path:
    """Return a file by its name from the root, of which links stay as they are."""
    return Path(os.path.normpath(Path.cwd() / name))


def plain_name(name: str) -> str:
    """Return the name of a file from the working folder, without links to folders above it."""
    path = from_root(name)
    return os.path.relpath(path.parent.resolve() / path.name)


def checkout_of(name: str) -> str:
    """Return the folder of the checkout in which a file or a folder lies; of a link, where the link itself lies.

    Parameters
    ----------
    name
        A plain name; it may be a glob, or of what is not there.

    Raises
    ------
    InputErrors
        If git finds none.
    """
    path = from_root(name)
    folder = next(one for one in (path, *path.parents) if one.is_dir() and not one.is_symlink())
    done = git("rev-parse", "--show-toplevel", folder=str(folder))
    if done.returncode:
        why = done.stderr.decode("utf-8", "replace").partition("\n")[0].removeprefix("fatal: ")
        hint = "name a file or folder of a checkout"
        raise InputErrors([InputError(name, 0, f"is in no checkout: {shown(why)}", hint)])
    return os.fsdecode(done.stdout.removesuffix(b"\n"))


@contextmanager
def at_revision(revision: str, checkout: str) -> Iterator[None]:
    """Move to where the working folder is from a checkout as a revision has it.

    Raises
    ------
    InputErrors
        If there is no such revision, or git has not all of its files.
    """
    commit, working = commit_of(revision, checkout), os.path.realpath(os.curdir)
    above = os.path.commonpath([checkout, working])
    with tempfile.TemporaryDirectory(prefix="rosprivacy.") as made:
        base = Path(made, "base")  # nothing lies beside it
        there, here = (base / os.path.relpath(folder, above) for folder in (checkout, working))
        for folder in (there, here, base / ".git", there / ".git"):  # a search upwards ends at .git
            folder.mkdir(parents=True, exist_ok=True)
        _write(_stored_files(commit, revision, checkout), there, revision, checkout)
        with chdir(here):
            yield


def _stored_files(commit: str, revision: str, checkout: str) -> list[StoredFile]:
    """The files of a commit, links last."""
    listed = os.fsdecode(git("ls-tree", "-r", "-z", "--full-tree", commit, folder=checkout).stdout)
    rows = (row.partition("\t") for row in listed.split("\0") if row)
    files = [StoredFile(facts.split(" ")[0], facts.split(" ")[2], name) for facts, _, name in rows]
    for file in files:
        if file.name.startswith("/") or {"..", ".git"} & {part.casefold() for part in PurePosixPath(file.name).parts}:
            hint = "name another revision; `git fsck` says more"
            raise InputErrors([InputError(revision, 0, f"no checkout has a file {shown(file.name)!r}", hint)])
    return sorted((file for file in files if file.mode != SUBMODULE), key=lambda file: file.mode == LINK)


def _write(files: Sequence[StoredFile], root: Path, revision: str, checkout: str) -> None:
    for file, content in zip(files, _contents(files, revision, checkout), strict=True):
        target = root / file.name
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            if file.mode == LINK:
                target.symlink_to(os.fsdecode(content))
            else:
                target.write_bytes(content)
        except (OSError, ValueError) as error:
            problem = f"{shown(file.name)} cannot be written: {reason(error)}"
            raise InputErrors([InputError(revision, 0, problem, "name another revision")]) from None


def _contents(files: Sequence[StoredFile], revision: str, checkout: str) -> Iterator[bytes]:
    """What git has stored of each file, one after the other."""
    with tempfile.TemporaryFile() as asked:
        asked.write("".join(f"{file.object}\n" for file in files).encode("ascii"))
        asked.seek(0)
        command, environment = [*GIT, "cat-file", "--batch"], git_environment(checkout)
        with subprocess.Popen(  # noqa: S603 - git
            command, stdin=asked, stdout=subprocess.PIPE, cwd=checkout, env=environment
        ) as running:
            stored = running.stdout
            assert stored is not None
            for file in files:
                *_, size = stored.readline().split() or [b""]
                if not size.isdigit():  # "missing"
                    raise InputErrors([InputError(revision, 0, f"git has no content of {shown(file.name)}", FETCH)])
                yield stored.read(int(size))
                stored.read(1)  # the end of a line
