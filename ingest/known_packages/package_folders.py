"""Which files of packages are read: the shipped catalogue, a file or a folder, those of installed packages.

In: what ``--packages`` names. Out: packages, sorted by name; a user's file stands in place of a shipped one of the same
name. That data come in or go out is never taken away in silence: of the shipped one, a source or a leak that the user's
does not state is still a question; what else it says is left out. ``ament`` means
``share/<package>/rosprivacy/package.yaml`` below every prefix of ``AMENT_PREFIX_PATH``, where the first prefix wins, as
an overlay does in ROS: the way for a vendor to ship such a file (docs/packages.md).
"""

from __future__ import annotations

import hashlib
import os
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

from rosprivacy.analysis.bounds import BOUNDS
from rosprivacy.analysis.errors import InputError, InputErrors, PackageError, shown
from rosprivacy.analysis.model import Diagnostic, Severity
from rosprivacy.analysis.suggesting.evidence import LEAK, SOURCE
from rosprivacy.ingest.known_packages.package_file import read_package, read_shipped
from rosprivacy.ingest.reading.path_kinds import is_dir
from rosprivacy.ontology.vocabulary import FOLDER, remembered

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.analysis.bounds import Bounds
    from rosprivacy.analysis.hierarchy import Hierarchy
    from rosprivacy.analysis.suggesting.packages import Claim, Package, PackageNode
    from rosprivacy.ontology.vocabulary import Vocabulary

AMENT = "ament"
PREFIXES = "AMENT_PREFIX_PATH"
PLACE = ("rosprivacy", "package.yaml")  # below share/<package>
ENDINGS = (".yaml", ".yml", ".json")
SHIPPED = "rosprivacy:packages/"  # how messages and reasons call the shipped folder
ENDS = (SOURCE, LEAK)
SHOWN_CLAIMS = 3  # statements in a notice


@remembered
def catalogue(vocabulary: Vocabulary) -> tuple[Package, ...]:
    """Read the shipped catalogue.

    >>> from rosprivacy.ontology.vocabulary import load
    >>> "nav2" in [package.name for package in catalogue(load())]
    True
    """
    files = sorted((FOLDER / "packages").glob("*.yaml"))
    return tuple(read_shipped(str(file), vocabulary, SHIPPED + file.name) for file in files)


def read_packages(arguments: Iterable[str], vocabulary: Vocabulary, bounds: Bounds = BOUNDS) -> tuple[Package, ...]:
    """Return the shipped packages with those of a user; after one of a user what is left of a shipped one of its name.

    Parameters
    ----------
    arguments
        Files, folders, or ``ament`` for those of installed packages.

    Raises
    ------
    InputErrors
        With every problem of all files, each a ``PackageError`` of one line.
    """
    problems: list[InputError] = []
    own: dict[str, Package] = {}
    for file, folder in _files(arguments, problems):
        try:
            package = read_package(file, vocabulary, bounds=bounds)
        except InputErrors as errors:
            problems += errors.errors
            continue
        if package.name in own:
            what = f"package {package.name} again, first in {shown(own[package.name].place.file)}"
            problems.append(PackageError(file, package.place.line, what, "keep one"))
        elif folder not in ("", package.name):
            what = f"it speaks of {package.name}, and lies in the package {shown(folder)}"
            problems.append(PackageError(file, package.place.line, what, "name the package that ships it"))
        own.setdefault(package.name, package)
    if problems:
        raise InputErrors(problems)
    known = list(own.values())
    for package in catalogue(vocabulary):
        replaced = package.name in own
        known.append(_left_of(package, own[package.name], vocabulary.hierarchy) if replaced else package)
    return tuple(sorted(known, key=lambda package: package.name))  # stable: a user's first


def replacements(packages: Iterable[Package]) -> tuple[Diagnostic, ...]:
    """Return a notice for each file of a user that stands in place of a shipped one; packages as they were read."""
    return tuple(_replacing(one, other) for one, other in pairwise(packages) if one.name == other.name)


def rests_on(packages: Iterable[Package]) -> tuple[tuple[str, str], ...]:
    """Return (file, SHA-256) of packages: the shipped ones are one, by the hashes of all that were read.

    >>> from rosprivacy.ontology.vocabulary import load
    >>> [file for file, _ in rests_on(catalogue(load()))]
    ['rosprivacy:packages']
    """
    read = [(package.place.file, package.sha256) for package in packages]
    shipped = "".join(sha256 for file, sha256 in read if file.startswith(SHIPPED))
    own = [(file, sha256) for file, sha256 in read if not file.startswith(SHIPPED)]
    return ((SHIPPED.rstrip("/"), hashlib.sha256(shipped.encode()).hexdigest()), *own)


def _files(arguments: Iterable[str], problems: list[InputError]) -> Iterable[tuple[str, str]]:
    """Files to read, each once, with the installed package that ships it; empty for others."""
    found: dict[str, str] = {}
    for argument in arguments:
        if argument == AMENT:
            found |= _installed(os.environ, problems)
        elif is_dir(argument):
            files = sorted(str(file) for file in Path(argument).iterdir() if file.suffix in ENDINGS)
            if not files:
                what = f"a folder without files that end in {', '.join(ENDINGS)}"
                problems.append(PackageError(argument, 0, what, "name the folder that the files lie in"))
            found |= dict.fromkeys(files, "")
        else:
            found[argument] = ""
    return found.items()


def _installed(environment: Mapping[str, str], problems: list[InputError]) -> dict[str, str]:
    """Files that installed packages ship: path -> name of the package; of one package that of the first prefix."""
    prefixes = [prefix for prefix in environment.get(PREFIXES, "").split(os.pathsep) if prefix]
    if not prefixes:
        problems.append(
            PackageError(AMENT, 0, f"{PREFIXES} is not set", "source the setup file of ROS, or name a file")
        )
    first: dict[str, str] = {}
    for prefix in prefixes:
        share = Path(prefix) / "share"
        for file in sorted(share.glob("/".join(("*", *PLACE)))):
            first.setdefault(file.relative_to(share).parts[0], str(file))
    if prefixes and not first:
        what = f"no installed package has a file {'/'.join(PLACE)} in its share folder"
        problems.append(PackageError(AMENT, 0, what, "name a file or a folder"))
    return {file: package for package, file in first.items()}


def _left_of(shipped: Package, own: Package, hierarchy: Hierarchy) -> Package:
    """Of a shipped package the sources and leaks that a user's file of its name does not state of such nodes.

    Nodes are the same by name; who states a kind states all narrower ones.
    """
    nodes = (rest for node in shipped.nodes for rest in _remainder(node, own, hierarchy))
    return shipped._replace(nodes=tuple(nodes))


def _replacing(own: Package, remainder: Package) -> Diagnostic:
    """The notice that a user's file stands in place of a shipped one, of which so much is left."""
    claims = [f"{claim.role} of {claim.kind} at {node.names[0]}" for node in remainder.nodes for claim in node.claims]
    message = f"it stands in place of the shipped package {own.name}"
    if claims:
        more = f" and {len(claims) - SHOWN_CLAIMS} more" if len(claims) > SHOWN_CLAIMS else ""
        message += f"; what it does not state of that is asked all the same: {', '.join(claims[:SHOWN_CLAIMS])}{more}"
    return Diagnostic(own.place, Severity.NOTICE, message)


def _remainder(node: PackageNode, own: Package, hierarchy: Hierarchy) -> Iterator[PackageNode]:
    """A node by each of its names, with the claims that are left under that name."""
    for name in node.names:
        stated = [claim for other in own.nodes if name in other.names for claim in other.claims]
        ends = (claim for claim in node.claims if claim.role in ENDS)
        claims = tuple(claim for claim in ends if not any(_covers(one, claim, hierarchy) for one in stated))
        if claims:
            yield node._replace(names=(name,), claims=claims)


def _covers(stated: Claim, other: Claim, hierarchy: Hierarchy) -> bool:
    return stated.role == other.role and hierarchy.distance(other.kind, stated.kind) is not None
