"""Folders of sources -> all that its code, packages and launch files say, and the systems that they make.

In: a folder, or several that are read as one. Out: ``Checkout``. Each file is read once, by the readers of its
language; nothing is run, and no link out of the folder is followed. What is left out is listed: tests, code of others,
what is not built, other languages.
"""

from __future__ import annotations

import gc
import os
from contextlib import contextmanager
from functools import lru_cache, partial
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import InputError, InputErrors
from rosprivacy.analysis.text import counted
from rosprivacy.ingest.code.source_files import CPP, PYTHON
from rosprivacy.ingest.known_packages.package_folders import catalogue
from rosprivacy.ingest.reading.file_kinds import DESCRIPTIONS
from rosprivacy.ingest.scan.checkout_files import joined_files
from rosprivacy.ingest.scan.code_versions import CheckoutCode
from rosprivacy.ingest.scan.cpp.cpp_nodes import read_cpp_nodes
from rosprivacy.ingest.scan.descriptions import Descriptions, with_descriptions
from rosprivacy.ingest.scan.interface_definitions import read_definitions
from rosprivacy.ingest.scan.launch.launch_files import read_launches
from rosprivacy.ingest.scan.outside.bridge_configs import read_bridges
from rosprivacy.ingest.scan.outside.compose_files import read_compose
from rosprivacy.ingest.scan.outside.externals import read_externals
from rosprivacy.ingest.scan.outside.log_calls import with_logs
from rosprivacy.ingest.scan.outside.node_externals import with_externals
from rosprivacy.ingest.scan.packages import read_packages, text_in
from rosprivacy.ingest.scan.python.python_nodes import read_python_nodes
from rosprivacy.ingest.scan.scan_facts import CodeFacts, CodePlace, Gap
from rosprivacy.ingest.scan.source_trees import read_source_trees, relative
from rosprivacy.ingest.scan.started_code import CodeIndex
from rosprivacy.ingest.scan.systems import in_order, joined_systems, launched_system, whole_system, with_more_code
from rosprivacy.ingest.suggestion_rules.rule_files import read_library_rules
from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.ingest.code.source_code import NodeClass
    from rosprivacy.ingest.scan.descriptions import Description
    from rosprivacy.ingest.scan.interface_definitions import TypeDefinition
    from rosprivacy.ingest.scan.packages import Packages
    from rosprivacy.ingest.scan.scan_facts import CodeNode, Executable, External, LaunchedSystem
    from rosprivacy.ingest.scan.systems import ScannedSystem

UNREAD = {  # endings of code that is not read
    ".c": "C", ".cs": "C#", ".go": "Go", ".ino": "Arduino", ".java": "Java", ".js": "JavaScript", ".kt": "Kotlin",
    ".m": "MATLAB", ".rs": "Rust", ".swift": "Swift", ".ts": "TypeScript", ".vue": "JavaScript",
}  # fmt: skip
SHOWN_AT_MOST = 8


class Checkout(NamedTuple):
    """What was read of a folder.

    Attributes
    ----------
    folder
        As the user calls it; of several, the one above all of them.
    left_out
        Folders, relative to it.
    stated
        What compose files and configurations of bridges state of the world outside ROS.
    descriptions
        Of nodes, that lie in the folder.
    parts
        Of several folders that are read as one, their paths from it.
    loose
        Files of code that a launch file may start although no package installs them.
    packages
        (name, folder relative to the root) of each.
    classes
        (file, language, its classes) of what was read as code.
    definitions
        Of messages, services and actions, by name of the type.
    """

    folder: str
    facts: CodeFacts
    executables: tuple[Executable, ...]
    launches: tuple[LaunchedSystem, ...]
    left_out: tuple[str, ...] = ()
    stated: tuple[External, ...] = ()
    descriptions: Descriptions | None = None
    parts: tuple[str, ...] = ("",)
    loose: tuple[Executable, ...] = ()
    packages: tuple[tuple[str, str], ...] = ()
    classes: tuple[tuple[str, str, tuple[NodeClass, ...]], ...] = ()
    definitions: Mapping[str, TypeDefinition] = {}


@contextmanager
def _without_collector() -> Iterator[None]:
    """Trees are millions of objects and leave nothing to collect: going through them takes a third of the time."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


@_without_collector()
def read_checkout(
    *folders: str, launches: Sequence[str] = (), described: tuple[Description, ...] | None = None
) -> Checkout:
    """Read all that folders say.

    Parameters
    ----------
    launches
        Launch files that are systems of their own, even if others include them; written as for ``chosen``.
    described
        What counts in place of the descriptions that lie in them.
    """
    files = joined_files(folders)
    packages, root = read_packages(files), Path(files.root)
    rules = read_library_rules((), load())[0]
    read = read_source_trees(root, (str(root / file) for file in _code_files(packages)), rules)
    codes = read.codes
    of_python, of_cpp = read_python_nodes(root, codes, read.python), read_cpp_nodes(read.cpp, read.texts)
    names = {code.file: relative(code.file, root) for code in codes}
    outside = read_externals(codes, rules, names)
    imports = {names[code.file]: [target for _, target in code.imports] for code in codes}
    nodes, homeless = with_externals((*of_python.nodes, *of_cpp.nodes), outside.units, imports)
    nodes = with_logs(nodes, read.logs)
    stated = [reader(files) for reader in (read_compose, read_bridges)]
    definitions, undefined = read_definitions(files.root, packages)
    gaps = {*packages.gaps, *undefined, *of_python.gaps, *of_cpp.gaps, *outside.gaps, *homeless, *read.gaps}
    gaps |= {*_other_languages(packages), *(gap for part in stated for gap in part.gaps)}
    descriptions = Descriptions(root, packages)
    if described is None:
        described = descriptions.nodes()
        gaps |= descriptions.gaps
    index = CodeIndex(nodes, packages.executables, partial(text_in, files.root), packages.loose)
    nodes, unclear = with_descriptions(nodes, described, index, packages.executables)
    gaps |= {*unclear}
    facts = CodeFacts(nodes, tuple(sorted(gaps)))
    externals = tuple(sorted({one for part in stated for one in part.externals}))
    above = files.root if all(map(os.path.isabs, folders)) else os.path.relpath(files.root)
    folder = folders[0] if len(folders) == 1 else above
    systems = read_launches(root, packages, [name for launch in launches for name in _names_of(folder, launch)])
    return Checkout(
        folder,
        facts,
        packages.executables,
        systems,
        packages.left_out,
        externals,
        descriptions,
        files.parts,
        packages.loose,
        tuple((package.name, package.folder) for package in packages.packages),
        tuple((names[code.file], code.language, code.classes) for code in codes),
        definitions,
    )


def systems_of(checkout: Checkout) -> tuple[ScannedSystem, ...]:
    """Return the systems of a checkout: one for each launch file at the top, or one of all its code."""
    facts = checkout.facts
    if not checkout.launches:
        return (whole_system(facts),)
    index = CodeIndex(facts.nodes, checkout.executables, partial(text_in, checkout.folder), checkout.loose)
    packages = catalogue(load())
    return tuple(launched_system(facts, index, launched, packages) for launched in checkout.launches)


def scanned(*folders: str, launch: str = "") -> tuple[Checkout, tuple[ScannedSystem, ...]]:
    """Read folders as ``read_checkout`` does, once as long as nothing in them changes."""
    return _scanned(folders, launch, tuple(_state(folders)))


def chosen(checkout: Checkout, systems: Sequence[ScannedSystem], launch: str = "") -> ScannedSystem:
    """Return the system of a launch file or a description; else the one that starts most of the code in each folder.

    Then what else the code starts is a gap: a folder was named, and it is not in the answer. What no launch file starts
    is started by other means, such as by hand at an operator's screen. Those of these nodes that send something out of
    ROS are added, under the names in the code: they may be ways out. Where they are at least as many as the others, all
    are.

    Parameters
    ----------
    launch
        Its path, from the folder or as the user would open it.

    Raises
    ------
    InputErrors
        If no system is of this launch file.
    """
    if launch.endswith(DESCRIPTIONS) and checkout.descriptions:
        inner = os.path.normpath(launch)
        known = inner in checkout.descriptions.files
        return _described_system(checkout.descriptions, inner if known else os.path.relpath(launch, checkout.folder))
    if launch:
        names = _names_of(checkout.folder, launch)
        for system in systems:
            if system.launch in names:
                return system
        hint = (
            f"name one of {', '.join(system.launch for system in systems[:SHOWN_AT_MOST] if system.launch) or 'none'}"
        )
        raise InputErrors([InputError(launch, 0, f"no launch file of {checkout.folder}", hint)])
    in_parts = ([one for one in systems if PurePosixPath(one.launch).is_relative_to(part)] for part in checkout.parts)
    counting = [max(some, key=_weight) for some in in_parts if some] or [max(systems, key=_weight)]
    best = joined_systems(sorted(counting, key=_weight, reverse=True))
    idle = [{id(node) for node in system.idle} for system in systems]
    never = [node for node in best.idle if all(id(node) in one for one in idle)]
    sending = [node for node in never if any(external.outgoing for external in node.externals)]
    added = never if len(never) >= _with_code(best) else sending
    whole = with_more_code(best, added, checkout.facts.gaps) if added else best
    gaps = _other_systems(counting, systems, added, [node for node in never if all(node is not one for one in added)])
    return whole._replace(gaps=in_order((*whole.gaps, *gaps)))


def _weight(system: ScannedSystem) -> tuple[int, int]:
    return _with_code(system), len(system.ends)


def _described_system(descriptions: Descriptions, file: str) -> ScannedSystem:
    """What one file describes, whatever code lies around it."""
    described = descriptions.of_file(file)
    files = {file, *(part for one in described for part in one.files)}
    gaps = tuple(gap for gap in descriptions.gaps if gap.place.file in files)
    return whole_system(CodeFacts(tuple(one.without_code for one in described), gaps))


def _names_of(folder: str, launch: str) -> tuple[str, ...]:
    """What a launch file that a user names can be called in a folder; nothing where none is named."""
    return (os.path.normpath(launch), os.path.relpath(launch, folder)) if launch else ()


def _with_code(system: ScannedSystem) -> int:
    return sum(node.code is not None for node in system.nodes)


def _other_systems(
    counting: Sequence[ScannedSystem],
    systems: Sequence[ScannedSystem],
    added: Sequence[CodeNode],
    idle: Sequence[CodeNode],
) -> Iterator[Gap]:
    others = [system for system in systems if all(system is not one for one in counting)]
    if others:
        names = _listed(system.launch for system in others)
        text = f"{counted(len(others), 'other launch file')} at the top, whose nodes are not in it: {names}"
        yield Gap(CodePlace(others[0].launch, 0), "system", f"{text}; name the one that counts")
    for nodes, but in ((added, ", taken to run under the names in the code"), (idle, "")):
        if nodes:
            names = _listed(f"{node.name} ({node.place.file}:{node.place.line})" for node in nodes)
            text = f"{counted(len(nodes), 'node')} that no launch file starts{but}: {names}"
            yield Gap(nodes[0].place, "system", text)


def _listed(names: Iterable[str]) -> str:
    listed = list(names)
    more = [f"and {len(listed) - SHOWN_AT_MOST} more"] if len(listed) > SHOWN_AT_MOST else []
    return ", ".join([*listed[:SHOWN_AT_MOST], *more])


def code_of(*folders: str, launch: str = "") -> CheckoutCode:
    """Return the code of folders by its units, once as long as nothing in them changes.

    Parameters
    ----------
    launch
        The launch file with which they were read: then they are not read again.
    """
    return _code_of(folders, launch, tuple(_state(folders)))


@lru_cache(maxsize=2)
def _code_of(folders: tuple[str, ...], launch: str, state: tuple[tuple[str, int, int], ...]) -> CheckoutCode:
    checkout, _ = _scanned(folders, launch, state)
    return CheckoutCode(checkout.folder, checkout.packages, checkout.classes)


@lru_cache(maxsize=2)
def _scanned(
    folders: tuple[str, ...], launch: str, _: tuple[tuple[str, int, int], ...]
) -> tuple[Checkout, tuple[ScannedSystem, ...]]:
    checkout = read_checkout(*folders, launches=(launch,))
    return checkout, systems_of(checkout)


def _state(folders: Sequence[str]) -> Iterator[tuple[str, int, int]]:
    """What tells whether files have changed."""
    checkout = joined_files(folders)
    for file in checkout.files:
        try:
            status = os.stat(Path(checkout.root, file))  # noqa: PTH116 - of a path that is made for it
        except OSError:
            continue
        yield file, status.st_mtime_ns, status.st_size


def _code_files(packages: Packages) -> Iterator[str]:
    run = {file for executable in packages.executables for file in executable.files}
    return (file for file in packages.files if _suffix(file) in (*PYTHON, *CPP) or file in run)


def _other_languages(packages: Packages) -> Iterator[Gap]:
    """One gap for each language that is not read, at its first file."""
    files: dict[str, list[str]] = {}
    for file in packages.files:
        if _suffix(file) in UNREAD:
            files.setdefault(UNREAD[_suffix(file)], []).append(file)
    for language, names in sorted(files.items()):
        yield Gap(CodePlace(names[0], 0), "file", f"{len(names)} files of {language} are not read, here and elsewhere")


def _suffix(file: str) -> str:
    return PurePosixPath(file).suffix.lower()
