"""What decides the exit code, as a base revision of git has it: for CI, where a pull request can edit all else.

In: a revision of the repository of the working folder, and words of ``analyze``. Out: copies of the project file and of
decisions in a folder, and the words with these copies in the place of files of the checkout. ``action.yml`` runs it:
``python -I -m rosprivacy.cli.base_revision REVISION FOLDER [WORD]…`` prints the words, each with a zero byte after it.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors, RosPrivacyError, shown
from rosprivacy.cli.project_file import OWN_FILE, PYTHON_FILE, nearest_project, read_project
from rosprivacy.ingest.reading.bounded_file import leaves
from rosprivacy.report.atomic import write_texts

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rosprivacy.cli.project_file import Project

DECISIONS, FAIL_ON = "--decisions", "--fail-on"
GIT = ("git", "-c", "core.hooksPath=/dev/null", "-c", "core.fsmonitor=false", "--no-optional-locks")
OF_A_REPOSITORY = ("GIT_DIR", "GIT_WORK_TREE", "GIT_COMMON_DIR", "GIT_INDEX_FILE")
FETCH = "check out with fetch-depth: 0, or name a commit that is there"


def main(words: Sequence[str]) -> int:
    """Print the words of ``analyze`` under a base; return an exit code."""
    revision, folder, *rest = words
    try:
        copies = Copies(revision, Path(folder))
        sys.stdout.write("".join(f"{word}\0" for word in copies.words(rest)))
    except RosPrivacyError as error:
        print(error, file=sys.stderr)
        return error.exit_code
    return 0


class Copies:
    """Copies of files as they are in a revision, in a folder of their own."""

    def __init__(self, revision: str, folder: Path) -> None:
        self.revision, self.folder = commit_of(revision), folder
        if folder.exists():
            shutil.rmtree(folder)
        (folder / ".git").mkdir(parents=True)  # the search for a project file ends here

    def copied(self, name: str) -> Path | None:
        """Copy a file; None if the revision has no such file."""
        done = git("cat-file", "blob", f"{self.revision}:./{name}")
        if done.returncode:
            return None
        copy = self.folder / name
        copy.parent.mkdir(parents=True, exist_ok=True)
        write_texts([(copy, done.stdout)])
        return copy

    def words(self, words: Sequence[str]) -> list[str]:
        """Return words of ``analyze`` with what decides taken from the revision.

        What the project file of the revision says counts where the words say nothing.
        """
        project = self._project()
        decisions = [self._decisions(name) for name in _values(words, DECISIONS)]
        if not decisions and project and project.decisions:
            decisions = [self._decisions(os.path.relpath(project.decisions, self.folder))]
        taken = [*_without(words, DECISIONS)]
        if project and FAIL_ON not in {word.partition("=")[0] for word in words}:
            taken += [part for name in project.fail_on for part in (FAIL_ON, name.value)]
        return [*taken, *(part for name in decisions[-1:] if name for part in (DECISIONS, name))]

    def _project(self) -> Project | None:
        copies = [self.copied(name) for name in (OWN_FILE, PYTHON_FILE)]
        file = nearest_project(self.folder) if any(copies) else None
        return read_project(file) if file else None

    def _decisions(self, name: str) -> str:
        """The copy of a file of decisions; one outside of the checkout is no part of it. Empty if there is none."""
        here = os.path.realpath(os.curdir)
        inside = os.path.relpath(name, here)
        if inside.startswith(os.pardir):  # by its name; what a link leads to counts only for who writes the checkout so
            if leaves(name, here):
                return name
            inside = os.path.relpath(os.path.realpath(name), here)
        copy = self.copied(inside)
        if copy is None:
            print(f"{shown(name)}: not in {shown(self.revision[:12])}, so nothing in it counts", file=sys.stderr)
        return str(copy or "")


def git_path(name: str) -> str:
    """Return where a file of our own stands in the folder of git, which nobody commits."""
    return git("rev-parse", "--git-path", name).stdout.decode("utf-8", "surrogateescape").strip() or name


def _values(words: Sequence[str], option: str) -> Iterator[str]:
    """The values of an option, written as one word or as two."""
    for word, after in zip(words, [*words[1:], ""], strict=True):
        if word == option:
            yield after
        elif word.startswith(f"{option}="):
            yield word.partition("=")[2]


def _without(words: Sequence[str], option: str) -> Iterator[str]:
    for before, word in zip(["", *words[:-1]], words, strict=True):
        if option not in (before, word) and not word.startswith(f"{option}="):
            yield word


def commit_of(revision: str, folder: str = os.curdir) -> str:
    """Return the full name of a commit of the repository in which a folder lies.

    Raises
    ------
    InputErrors
        If it has none of that name.
    """
    done = git("rev-parse", "--verify", "--quiet", "--end-of-options", f"{revision}^{{commit}}", folder=folder)
    if done.returncode:
        name = os.path.relpath(folder)
        checkout = "this checkout" if name == os.curdir else f"the checkout {shown(name)}"
        raise InputErrors([InputError(revision, 0, f"is no commit of {checkout}", FETCH)])
    return done.stdout.decode("ascii").strip()


def git(*words: str, folder: str = os.curdir) -> subprocess.CompletedProcess[bytes]:
    """Run git in a folder, and nothing that the repository names."""
    environment = git_environment(folder)
    try:
        return subprocess.run([*GIT, *words], cwd=folder, env=environment, capture_output=True, check=False)  # noqa: S603 - git
    except OSError:
        raise InputErrors([InputError("git", 0, "cannot be run", "install it, or name no base")]) from None


def git_environment(folder: str) -> dict[str, str]:
    """Return variables with which git asks nobody, fetches nothing and takes no object for another one.

    A repository that the variables name counts for the working folder alone.
    """
    named = () if folder == os.curdir else OF_A_REPOSITORY
    given = {name: value for name, value in os.environ.items() if name not in named}
    return {**given, "GIT_TERMINAL_PROMPT": "0", "GIT_NO_LAZY_FETCH": "1", "GIT_NO_REPLACE_OBJECTS": "1"}


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
