"""The launch files of a checkout -> what each that no other includes would start: one system each.

In: packages with the files of the checkout. Out: ``LaunchedSystem``s. Nothing is started or run. Of launch files that
include each other in a circle the first is a system.
"""

from __future__ import annotations

import os
import posixpath
import re
from functools import cache, partial
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.ingest.scan.launch import launch_markup
from rosprivacy.ingest.scan.launch.launch_python import GENERATE, PythonLaunches
from rosprivacy.ingest.scan.launch.launch_runs import LaunchRun
from rosprivacy.ingest.scan.launch.launch_values import CHECKOUT, PACKAGE, path_text
from rosprivacy.ingest.scan.launch.parameter_files import read_parameters
from rosprivacy.ingest.scan.packages import NOT_PYTHON, SpentError, Steps, text_in
from rosprivacy.ingest.scan.scan_facts import CodePlace, Gap, LaunchedSystem

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable
    from pathlib import Path

    from rosprivacy.ingest.scan.launch.launch_actions import Action
    from rosprivacy.ingest.scan.launch.parameter_files import ParameterEntry
    from rosprivacy.ingest.scan.packages import Packages

STEPS = 150_000  # of one launch file with all that it includes
STEPS_TO_READ = 300_000  # of one launch file with the modules that it imports: to see what it does
ENDINGS = re.compile(r".*[._]launch\.(?:py|xml|ya?ml)|launch\.(?:py|xml|ya?ml)|.*\.launch")
BELOW = (".py", ".xml", ".yaml", ".yml")


def read_launches(root: str | Path, packages: Packages, files: Collection[str] = ()) -> tuple[LaunchedSystem, ...]:
    """Return what the launch files of a checkout start, by file.

    Parameters
    ----------
    packages
        As ``read_packages`` returns them for the same root.
    files
        Launch files that are systems of their own, even if others include them.
    """
    sources = CheckoutLaunches(root, packages)
    listed = sources.launch_files()
    included = {file: {one.file for one in launched(sources, file, follow=False).includes} - {file} for file in listed}
    outermost = _outermost(listed, included)
    return tuple(_system(sources, file) for file in listed if file in outermost or file in files)


def _outermost(files: Iterable[str], included: dict[str, set[str]]) -> list[str]:
    """The files that no other includes, and of those in a circle the first."""
    listed = sorted(files)
    inner = {one for ones in included.values() for one in ones}
    chosen = [file for file in listed if file not in inner]
    reached: set[str] = set()
    for file in [*chosen, *listed]:
        if file in reached:
            continue
        if file not in chosen:
            chosen.append(file)
        waiting = [file]
        while waiting:
            one = waiting.pop()
            if one not in reached:
                reached.add(one)
                waiting += included.get(one, ())
    return sorted(chosen)


def _system(sources: CheckoutLaunches, file: str) -> LaunchedSystem:
    run = launched(sources, file)
    inner = sorted({one.file for one in run.includes if one.file} - {file})
    return LaunchedSystem(file, tuple(dict.fromkeys(run.started)), tuple(inner), tuple(dict.fromkeys(run.gaps)))


def launched(sources: CheckoutLaunches, file: str, *, follow: bool = True) -> LaunchRun:
    """Return what a launch file starts and includes.

    Parameters
    ----------
    follow
        Whether what it includes is followed.
    """
    steps = Steps(STEPS)
    sources.begin()
    run = LaunchRun(sources, steps.spend, sources.python.expression, follow=follow)
    try:
        run.file(file)
    except SpentError:
        run.gaps.append(
            Gap(CodePlace(file, 1), "started", "a launch file that takes too many steps; the rest is not read")
        )
    return run


class CheckoutLaunches:
    """Finds and reads the launch files and parameter files of a checkout, each once."""

    def __init__(self, root: str | Path, packages: Packages) -> None:
        self.packages = packages
        self._files = frozenset(packages.files)
        self.text = partial(text_in, os.path.realpath(root))
        self.python = PythonLaunches(self.text, self.resolved, self._module, self._spend)
        self._steps = Steps(STEPS_TO_READ)
        self._actions: dict[str, Action | Gap | None] = {}
        self._parameters: dict[str, tuple[ParameterEntry, ...] | None] = {}
        self._of_name: dict[str, list[str]] = {}
        for file in packages.files:
            self._of_name.setdefault(posixpath.basename(file), []).append(file)

    def begin(self) -> None:
        """Count steps anew: one file does not use up those of the next."""
        self._steps = Steps(STEPS_TO_READ)

    def _spend(self) -> None:
        self._steps.spend()

    def launch_files(self) -> list[str]:
        """Return the launch files of the checkout, sorted."""
        return [file for file in self.packages.files if _may_launch(file) and self._read(file) is not None]

    def _read(self, file: str) -> Action | Gap | None:
        if file not in self._actions:
            self.begin()
            self._actions[file] = self._parsed(file)
        return self._actions[file]

    def actions(self, file: str) -> Action | Gap:
        """Return what a launch file does; a gap where that cannot be told."""
        return self._read(file) or Gap(CodePlace(file, 1), "include", "no launch file of ROS 2")

    def _parsed(self, file: str) -> Action | Gap | None:  # noqa: PLR0911 - one for each way it can end
        """What a launch file does; None where it is none of ROS 2."""
        text = self.text(file)
        if text is None:
            return Gap(CodePlace(file, 0), "file", "a launch file that cannot be read")
        try:
            if file.endswith(".py"):
                return self.python.actions(file) if GENERATE in text else None
            if file.endswith((".yaml", ".yml")):
                return launch_markup.actions(launch_markup.of_yaml(text, file), file) if "launch:" in text else None
            if "<launch" not in text:
                return None
            return launch_markup.actions(launch_markup.of_xml(text.encode(), file), file)
        except SyntaxError as error:
            return Gap(CodePlace(file, error.lineno or 1), "file", "a launch file that is not Python")
        except (InputError, InputErrors) as error:
            line = error.line if isinstance(error, InputError) else 1
            return Gap(CodePlace(file, line), "file", f"a launch file that cannot be read: {error}")
        except (*NOT_PYTHON, SpentError) as error:
            return Gap(
                CodePlace(file, 1), "file", f"a launch file that cannot be followed: {error or type(error).__name__}"
            )

    def parameters(self, file: str) -> tuple[ParameterEntry, ...] | None:
        """Return what a file of parameters sets; None where it cannot be read."""
        if file not in self._parameters:
            text = self.text(file)
            try:
                self._parameters[file] = None if text is None else read_parameters(text, file)
            except (InputError, InputErrors):
                self._parameters[file] = None
        return self._parameters[file]

    def resolved(self, path: str) -> str:
        """Return the file of the checkout that a path leads to; empty if there is none."""
        if path.startswith(PACKAGE):
            return self._shared(path_text(path))
        if not path.startswith(CHECKOUT):
            return self._in_workspace(path)
        whole = posixpath.normpath(path.removeprefix(CHECKOUT).lstrip("/"))
        return whole if whole in self._files else self._installed(whole, "")

    def _in_workspace(self, path: str) -> str:
        """The only file of the checkout that an author's own path means: what follows ``src`` is the same here."""
        rest = posixpath.normpath(path).rpartition("/src/")[2]
        if not path.startswith("/") or "/src/" not in path or rest.count("/") < 1:
            return ""
        inside = [one for one in self._of_name.get(posixpath.basename(rest), ()) if f"/{one}".endswith(f"/{rest}")]
        return inside[0] if len(inside) == 1 else ""

    def _shared(self, path: str) -> str:
        """The file that a package shares; where it is installed from is the same path in most packages."""
        name, _, rest = path.partition("/")
        package = self.packages.by_name.get(name)
        if package is None:
            return ""
        rest = rest.removeprefix(f"share/{name}/")
        whole = posixpath.join(package.folder, rest)
        return whole if whole in self._files else self._installed(whole, package.folder)

    def _installed(self, path: str, folder: str) -> str:
        """The only file of a package with the name of one that is not where it is installed."""
        above = folder or self._package_folder(path)
        if above is None:
            return ""
        name = posixpath.basename(path)
        inside = [one for one in self._of_name.get(name, ()) if not above or one.startswith(f"{above}/")]
        return inside[0] if len(inside) == 1 else ""

    def _package_folder(self, path: str) -> str | None:
        """The folder of the package that a file stands in."""
        folders = [one.folder for one in self.packages.packages if path.startswith(f"{one.folder}/") or not one.folder]
        return max(folders, key=len, default=None)

    def _module(self, importing: str, name: str) -> str | None:
        """The file of a module of the checkout."""
        folder = posixpath.dirname(importing)
        package = self.packages.by_name.get(name.lstrip(".").partition(".")[0])
        inner = name.lstrip(".").replace(".", "/")
        places = [folder, *([package.folder, posixpath.join(package.folder, "src")] if package else [])]
        paths = [
            posixpath.normpath(posixpath.join(place, inner + end))
            for place in places
            for end in (".py", "/__init__.py")
        ]
        return next((path for path in paths if path in self._files), None)


def _may_launch(file: str) -> bool:
    folder, _, name = file.rpartition("/")
    if name.startswith("test_"):
        return False
    return bool(ENDINGS.fullmatch(name)) or (name.endswith(BELOW) and _below_launch(folder))


@cache
def _below_launch(folder: str) -> bool:
    return any(part in ("launch", "launches") for part in folder.split("/"))
