"""The packages of a checkout -> what each of them can run, and of which sources.

In: ``package.xml``, ``setup.py``, ``setup.cfg``, ``pyproject.toml`` and ``CMakeLists.txt``. Out: packages with their
executables, and gaps. A package of ROS 1 is left out.
"""

from __future__ import annotations

import ast
import configparser
import posixpath
import re
import warnings
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import InputError, PolicyError, shown
from rosprivacy.analysis.python_311 import tomllib
from rosprivacy.ingest.code.source_files import CPP, MAX_BYTES, PYTHON
from rosprivacy.ingest.policies.xinclude import parsed
from rosprivacy.ingest.reading.bounded_file import read_regular
from rosprivacy.ingest.scan.cmake_targets import read_targets
from rosprivacy.ingest.scan.launch.launch_values import Open
from rosprivacy.ingest.scan.launch.python_evaluation import Evaluation
from rosprivacy.ingest.scan.scan_facts import CodePlace, Executable, Gap

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rosprivacy.ingest.scan.checkout_files import CheckoutFiles
    from rosprivacy.ingest.scan.cmake_targets import Registered, Targets
    from rosprivacy.ingest.scan.launch.python_built_ins import Call

STEPS = 200_000  # of following a setup.py
NOT_PYTHON = (SyntaxError, ValueError, RecursionError, MemoryError)
LONGEST_ENTRY = 1000
ENTRY = re.compile(r"\s*([\w.-]+)\s*=\s*([\w.]+)\s*(?::\s*([\w.]+))?.*")


class SpentError(Exception):
    """More steps than a file of a package or a launch file may take."""


class Steps:
    """Counts steps, and ends what takes too many."""

    def __init__(self, number: int) -> None:
        self.remaining = number

    def spend(self) -> None:
        """Count a step."""
        self.remaining -= 1
        if self.remaining < 0:
            raise SpentError


class SourcePackage(NamedTuple):
    """A package of ROS 2 in the checkout.

    Attributes
    ----------
    folder
        Relative to the root; empty for the root itself.
    registered
        The descriptions that it puts into the ament index.
    loose
        Its other files of code, by their names: nothing says that they are installed.
    """

    name: str
    folder: str
    executables: tuple[Executable, ...] = ()
    registered: tuple[Registered, ...] = ()
    loose: tuple[Executable, ...] = ()


class Packages:
    """What was read of the packages of a checkout.

    Attributes
    ----------
    left_out
        Folders that are not read: tests, code of others, what is not built, packages of ROS 1.
    """

    def __init__(
        self,
        checkout: CheckoutFiles,
        packages: tuple[SourcePackage, ...],
        left_out: tuple[str, ...],
        gaps: tuple[Gap, ...],
    ) -> None:
        self.files = checkout.files
        self.packages = packages
        self.left_out = left_out
        self.gaps = gaps

    @property
    def executables(self) -> tuple[Executable, ...]:
        """Of all packages."""
        return tuple(one for package in self.packages for one in package.executables)

    @property
    def loose(self) -> tuple[Executable, ...]:
        """Of all packages."""
        return tuple(one for package in self.packages for one in package.loose)

    @cached_property
    def registered(self) -> dict[str, tuple[str, str]]:
        """Files of descriptions, each with the package and the name under which they are registered."""
        of_packages = ((package, one) for package in self.packages for one in package.registered)
        return {one.file: (one.package or package.name, one.name) for package, one in of_packages}

    @cached_property
    def by_name(self) -> dict[str, SourcePackage]:
        """The first package of each name."""
        return {package.name: package for package in reversed(self.packages)}


def text_in(root: str, file: str) -> str | None:
    """Return the text of a file below a root; None where it cannot be read."""
    path = str(Path(root, file))
    try:
        return read_regular(path, MAX_BYTES, partial(InputError, path)).decode("utf-8", "replace")
    except InputError:
        return None


def read_packages(checkout: CheckoutFiles) -> Packages:
    """Read the packages of a checkout."""
    gaps = list(checkout.gaps)
    folders: dict[str, str] = {}
    old: list[str] = []
    for file in checkout.files:
        if posixpath.basename(file) != "package.xml":
            continue
        folder = posixpath.dirname(file)
        try:
            name, first_version = _manifest(text_in(checkout.root, file) or "", file)
        except PolicyError as error:
            gaps.append(Gap(CodePlace(file, error.line), "file", f"a package that cannot be read: {error.problem}"))
            continue
        if first_version:
            old.append(folder)
        elif name:
            folders[folder] = name
    of_package: dict[str, list[str]] = {folder: [] for folder in (*folders, *old)}
    for file in checkout.files:
        above = posixpath.dirname(file)
        while above and above not in of_package:
            above = posixpath.dirname(above)
        if above in of_package:
            of_package[above].append(file)
    packages = tuple(
        _package(name, folder, of_package[folder], checkout.root, gaps) for folder, name in sorted(folders.items())
    )
    in_old = {file for folder in old for file in of_package[folder]}
    files = checkout._replace(files=tuple(file for file in checkout.files if file not in in_old))
    return Packages(files, packages, tuple(sorted({*checkout.left_out, *old})), tuple(gaps))


def _package(name: str, folder: str, files: list[str], root: str, gaps: list[Gap]) -> SourcePackage:
    built = read_targets(folder, files, partial(text_in, root))
    if not built.whole:
        file = posixpath.join(folder, "CMakeLists.txt")
        gaps.append(Gap(CodePlace(file, 1), "file", "a CMakeLists.txt that grows without end; the rest is not read"))
    executables = _distinct(_executables(name, folder, built, set(files), root, gaps))
    loose = tuple(Executable(name, posixpath.basename(file), (file,)) for file in files if _is_code(file))
    return SourcePackage(name, folder, executables, built.registered, loose)


def _is_code(file: str) -> bool:
    return posixpath.splitext(file)[1].lower() in (*PYTHON, *CPP)


def _distinct(executables: Iterator[Executable]) -> tuple[Executable, ...]:
    """Each executable once; one whose sources are there rather than another of its name."""
    listed = list(dict.fromkeys(executables))
    whole = {one.name for one in listed if one.files}
    return tuple(one for one in listed if one.files or one.name not in whole)


def _manifest(text: str, file: str) -> tuple[str, bool]:
    """The name in a ``package.xml``, and whether it is a package of ROS 1."""
    top = parsed(text.encode(), file)
    name = (top.findtext("name") or "").strip()
    tools = {(one.text or "").strip() for one in top.iter("buildtool_depend", "build_type")}
    old = "catkin" in tools and not any("ament" in tool or "colcon" in tool for tool in tools)
    return name, old


def _executables(
    name: str, folder: str, built: Targets, existing: set[str], root: str, gaps: list[Gap]
) -> Iterator[Executable]:
    for target in built.targets:
        yield Executable(name, target.name, target.files, target.plugin)
        if not target.files:
            what = f"the sources of {shown(target.name)} are not in the checkout"
            gaps.append(Gap(CodePlace(target.file, target.line), "file", what))
    for file, line, entry in _entries(folder, existing, root, gaps):
        match = ENTRY.fullmatch(entry[:LONGEST_ENTRY])
        if match is None:
            gaps.append(Gap(CodePlace(file, line), "file", f"an entry point that cannot be told: {shown(entry)}"))
            continue
        module = _module(folder, match[2], existing)
        if not module:
            gaps.append(Gap(CodePlace(file, line), "file", f"{match[2]} of {match[1]} is not in the checkout"))
        yield Executable(name, match[1], (module,) if module else (), match[3] or "")
    for path in _scripts(folder, existing, root, gaps):
        yield Executable(name, posixpath.basename(path), (path,))


def _module(folder: str, module: str, existing: set[str]) -> str:
    """The file of a module; empty where there is none."""
    inner = module.replace(".", "/")
    for above in ("", "src", "python", "scripts", "lib"):
        for ending in (".py", "/__main__.py", "/__init__.py"):
            path = posixpath.normpath(posixpath.join(folder, above, inner + ending))
            if path in existing:
                return path
    return ""


def _entries(folder: str, existing: set[str], root: str, gaps: list[Gap]) -> Iterator[tuple[str, int, str]]:
    """(file, line, ``name = module:function``) of the console scripts."""
    for file, keywords, line in _setup_calls(folder, existing, root, gaps):
        points = keywords.get("entry_points")
        listed = points.get("console_scripts") if isinstance(points, dict) else None
        if isinstance(points, str):
            parser = _configuration(points)
            listed = parser.get("console_scripts", "", fallback="") if parser else []
            listed = [*parser["console_scripts"].items()] if parser and parser.has_section("console_scripts") else []
            listed = [f"{key} = {value}" for key, value in listed]
        for entry in [listed] if isinstance(listed, str) else listed if isinstance(listed, list) else []:
            if isinstance(entry, str):
                yield from ((file, line, one) for one in entry.splitlines() if one.strip())
            else:
                gaps.append(Gap(CodePlace(file, line), "file", "an entry point that cannot be told"))
        if isinstance(points, Open) or (isinstance(points, dict) and isinstance(listed, Open)):
            gaps.append(Gap(CodePlace(file, line), "file", "entry points that cannot be told"))
    file = posixpath.join(folder, "setup.cfg")
    parser = _configuration(text_in(root, file) or "") if file in existing else None
    if parser and parser.has_option("options.entry_points", "console_scripts"):
        text = parser.get("options.entry_points", "console_scripts")
        yield from ((file, 1, one) for one in text.splitlines() if one.strip())
    file = posixpath.join(folder, "pyproject.toml")
    if file in existing:
        try:
            scripts = tomllib.loads(text_in(root, file) or "").get("project", {}).get("scripts", {})
        except (tomllib.TOMLDecodeError, AttributeError, RecursionError):
            scripts = {}
        yield from ((file, 1, f"{key} = {value}") for key, value in scripts.items() if isinstance(value, str))


def _configuration(text: str) -> configparser.ConfigParser | None:
    parser = configparser.ConfigParser(interpolation=None, strict=False)
    parser.optionxform = str  # type: ignore[assignment,method-assign]
    try:
        parser.read_string(text)
    except (configparser.Error, ValueError):
        return None
    return parser


def _scripts(folder: str, existing: set[str], root: str, gaps: list[Gap]) -> Iterator[str]:
    for file, keywords, line in _setup_calls(folder, existing, root, []):
        scripts = keywords.get("scripts")
        for script in scripts if isinstance(scripts, list) else []:
            path = posixpath.normpath(posixpath.join(folder, script)) if isinstance(script, str) else ""
            if path in existing:
                yield path
            else:
                gaps.append(Gap(CodePlace(file, line), "file", "a script that is not in the checkout"))


def _setup_calls(
    folder: str, existing: set[str], root: str, gaps: list[Gap]
) -> list[tuple[str, dict[str, object], int]]:
    """(file, arguments, line) of each ``setup(…)`` in a ``setup.py``."""
    file = posixpath.join(folder, "setup.py")
    text = text_in(root, file) if file in existing else None
    calls: list[tuple[str, dict[str, object], int]] = []
    if text is None:
        return calls

    def note(_: Evaluation, call: Call) -> object:
        if call.name.rpartition(".")[2] in ("setup", "generate_distutils_setup"):
            calls.append((file, call.keywords, call.line))
        return Open(call.name)

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            tree = ast.parse(text)
        module = Evaluation(file, note, lambda _, __: None, Steps(STEPS).spend)
        module.block(tree.body, module.scope, [])
    except (*NOT_PYTHON, SpentError):
        gaps.append(Gap(CodePlace(file, 1), "file", "a setup.py that cannot be read"))
    return calls
