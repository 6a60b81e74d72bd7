"""What suggestions are made by, whatever the system: rules about names and libraries, types and packages.

In: names of files of a user. Out: ``Known``, ours and theirs joined.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.suggesting.carried_kinds import Rules
from rosprivacy.ingest.packages.package_folders import read_packages, rests_on
from rosprivacy.ingest.suggestions.library_file import read_library_rules
from rosprivacy.ingest.suggestions.name_file import read_name_rules
from rosprivacy.ingest.types import TABLE
from rosprivacy.ingest.types.type_table import read_table

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.analysis.suggesting.library_rules import LibraryRules
    from rosprivacy.analysis.suggesting.ros_package import Package
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.settings import Settings


class UserFiles(NamedTuple):
    """Files of a user that suggestions are made by.

    Attributes
    ----------
    rules
        Rules about names.
    packages
        Packages, folders of them, or ``ament``.
    sources
        Source code of nodes: files, folders or globs; its literal names and types are evidence, and what it uses.
    libraries
        Rules about libraries.
    """

    rules: Sequence[str] = ()
    packages: Sequence[str] = ()
    sources: Sequence[str] = ()
    libraries: Sequence[str] = ()


NO_FILES = UserFiles()


class Known(NamedTuple):
    """What suggestions are made by, whatever the system.

    Attributes
    ----------
    files
        (file, SHA-256) of what was read.
    """

    rules: Rules
    packages: tuple[Package, ...]
    libraries: LibraryRules
    files: tuple[tuple[str, str], ...]


def what_is_known(vocabulary: Vocabulary, settings: Settings, files: UserFiles = NO_FILES) -> Known:
    """Read rules and packages, for many answers about one system; source code is not read here.

    Raises
    ------
    InputErrors
        With every problem of them.
    """
    table = read_table(settings.type_limits or TABLE, vocabulary, settings.bounds)
    names, of_names = read_name_rules(files.rules, vocabulary, settings.bounds)
    rules = Rules(table.suggestions, table.limits.of, names, vocabulary.hierarchy)
    packages = tuple(read_packages(files.packages, vocabulary, settings.bounds))
    libraries, of_libraries = read_library_rules(files.libraries, vocabulary, settings.bounds)
    of_table = (table.limits.file, table.limits.sha256)
    return Known(rules, packages, libraries, (of_table, *of_names, *of_libraries, *rests_on(packages)))
