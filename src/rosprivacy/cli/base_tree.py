"""The repository of the working folder as a revision of git has it, for as long as a block lasts.

In: a revision. Out: a folder of its own, with the working folder moved into it, so that every name leads to the file as
the revision has it. Git hands over what it has stored, file by file: `git archive` and `git checkout` would run filters
that the repository names. Links are written last, so nothing is written through one; a submodule is not there.
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


@contextmanager
def at_revision(revision: str) -> Iterator[None]:
    """Move into the working folder as a revision has it.

    Raises
    ------
    InputErrors
        If there is no such revision, or git has not all of its files.
    """
    commit = commit_of(revision)
    here = os.fsdecode(git("rev-parse", "--show-prefix").stdout.removesuffix(b"\n"))
    with tempfile.TemporaryDirectory(prefix="rosprivacy.") as made:
        root = Path(made, "base")  # nothing lies beside it
        (root / here).mkdir(parents=True)
        _write(_stored_files(commit, revision), root, revision)
        (root / ".git").mkdir()  # a search upwards ends here
        with chdir(root / here):
            yield


def _stored_files(commit: str, revision: str) -> list[StoredFile]:
    """The files of a commit, links last."""
    listed = os.fsdecode(git("ls-tree", "-r", "-z", "--full-tree", commit).stdout)
    rows = (row.partition("\t") for row in listed.split("\0") if row)
    files = [StoredFile(facts.split(" ")[0], facts.split(" ")[2], name) for facts, _, name in rows]
    for file in files:
        if file.name.startswith("/") or {"..", ".git"} & {part.casefold() for part in PurePosixPath(file.name).parts}:
            hint = "name another revision; `git fsck` says more"
            raise InputErrors([InputError(revision, 0, f"no checkout has a file {shown(file.name)!r}", hint)])
    return sorted((file for file in files if file.mode != SUBMODULE), key=lambda file: file.mode == LINK)


def _write(files: Sequence[StoredFile], root: Path, revision: str) -> None:
    for file, content in zip(files, _contents(files, revision), strict=True):
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


def _contents(files: Sequence[StoredFile], revision: str) -> Iterator[bytes]:
    """What git has stored of each file, one after the other."""
    with tempfile.TemporaryFile() as asked:
        asked.write("".join(f"{file.object}\n" for file in files).encode("ascii"))
        asked.seek(0)
        command = [*GIT, "cat-file", "--batch"]
        with subprocess.Popen(command, stdin=asked, stdout=subprocess.PIPE, env=git_environment()) as running:  # noqa: S603 - git
            stored = running.stdout
            assert stored is not None
            for file in files:
                *_, size = stored.readline().split() or [b""]
                if not size.isdigit():  # "missing"
                    raise InputErrors([InputError(revision, 0, f"git has no content of {shown(file.name)}", FETCH)])
                yield stored.read(int(size))
                stored.read(1)  # the end of a line
