"""What suggestions are made by: rules and packages, whatever the system; what source code says of it; and the evidence.

In: names of files of a user, a graph with its labels and types. Out: ``Evidence``; the order does not matter, and none
of it labels anything.
"""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import MessageType
from rosprivacy.analysis.suggesting.channels import Rules, carried_kinds, traffic
from rosprivacy.analysis.suggesting.evidence import SOURCE
from rosprivacy.analysis.suggesting.nodes import node_evidence
from rosprivacy.analysis.suggesting.open_elements import of_channels, of_open
from rosprivacy.analysis.suggesting.packages import by_package_types, nodes_of_packages, package_evidence
from rosprivacy.ingest.known_packages.package_folders import read_packages, rests_on
from rosprivacy.ingest.suggestion_rules.rule_files import read_library_rules, read_name_rules
from rosprivacy.ingest.types import TABLE
from rosprivacy.ingest.types.type_table import read_table

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.analysis.answer import Analysis
    from rosprivacy.analysis.errors import InputError
    from rosprivacy.analysis.model import Bound, Element, FlowGraph
    from rosprivacy.analysis.suggesting.channels import Traffic
    from rosprivacy.analysis.suggesting.evidence import Evidence, Identity
    from rosprivacy.analysis.suggesting.library_rules import LibraryRules, NodeUse
    from rosprivacy.analysis.suggesting.packages import NodeOfPackage, Package
    from rosprivacy.ingest.code.node_uses import Local
    from rosprivacy.ingest.code.source_code import Code
    from rosprivacy.ontology.vocabulary import Vocabulary
    from rosprivacy.result import Result
    from rosprivacy.settings import Settings


class UserFiles(NamedTuple):
    """Files of a user that suggestions are made by.

    Attributes
    ----------
    rules, libraries
        Rules about names, and about libraries.
    packages
        Packages, folders of them, or ``ament``.
    sources
        Source code of nodes: files, folders or globs; its literal names and types are evidence, and what it uses.
    """

    rules: Sequence[str] = ()
    packages: Sequence[str] = ()
    sources: Sequence[str] = ()
    libraries: Sequence[str] = ()


NO_FILES = UserFiles()


class KnownOfSystem(NamedTuple):
    """What suggestions are made by, whatever the system, with (file, SHA-256) of what was read."""

    rules: Rules
    packages: tuple[Package, ...]
    libraries: LibraryRules
    files: tuple[tuple[str, str], ...]


class CodeSaid(NamedTuple):
    """What source code says of a system.

    Attributes
    ----------
    types, uses
        By vertex of a channel; by vertex of a node.
    unplaced
        Uses of which nobody knows the node, or whose node is none of the system.
    problems
        What could not be read.
    of_others
        Folders with code of others that were left out.
    local
        Uses that no library is asked about, since something in the code has that name.
    """

    types: Mapping[int, tuple[MessageType, ...]]
    uses: Mapping[int, tuple[NodeUse, ...]]
    unplaced: tuple[NodeUse, ...] = ()
    problems: tuple[InputError, ...] = ()
    of_others: tuple[str, ...] = ()
    local: tuple[Local, ...] = ()


class Basis(NamedTuple):
    """What there is to suggest about.

    Attributes
    ----------
    bound
        Labels and types, with those that source code names.
    places
        Identities of open elements -> their places in the order of review (rule S11).
    comments
        What stands beside elements in source code.
    """

    result: Result
    bound: Bound
    places: Mapping[Identity, int]
    comments: Mapping[tuple[str, str], tuple[str, ...]]
    code: CodeSaid


def what_is_known(vocabulary: Vocabulary, settings: Settings, files: UserFiles = NO_FILES) -> KnownOfSystem:
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
    return KnownOfSystem(rules, packages, libraries, (of_table, *of_names, *of_libraries, *rests_on(packages)))


def evidence(
    analysis: Analysis, bound: Bound, knowledge: KnownOfSystem, uses: Mapping[int, Sequence[NodeUse]]
) -> Iterator[Evidence]:
    """Yield what every provider finds.

    Parameters
    ----------
    uses
        By vertex of a node: what its code uses of libraries.
    """
    graph, open_ = analysis.graph, analysis.open
    ends = traffic(graph, bound)
    of_packages = nodes_of_packages(graph, bound.types, knowledge.packages)
    yield from lasting_evidence(graph, bound, ends, of_packages, knowledge, uses)
    yield from of_open(open_, graph, bound, ends, knowledge.rules)
    yield from by_package_types(open_, graph, bound, of_packages, knowledge.rules)


def lasting_evidence(
    graph: FlowGraph,
    bound: Bound,
    ends: Traffic,
    of_packages: Sequence[NodeOfPackage],
    knowledge: KnownOfSystem,
    uses: Mapping[int, Sequence[NodeUse]],
) -> Iterator[Evidence]:
    """Yield what is found whatever a person has said: of what is bound to the graph, only types are looked at."""
    rules = knowledge.rules
    clues = carried_kinds(graph, bound, rules)
    by_packages = tuple(package_evidence(graph, of_packages))
    yield from by_packages
    sources = {one.label.element for one in by_packages if one.label.role == SOURCE}
    yield from node_evidence(graph, bound, ends, clues, rules, uses, knowledge.libraries, sources)
    yield from of_channels(graph, clues)


def code_said(codes: Sequence[Code], of_others: tuple[str, ...], elements: Sequence[Element]) -> CodeSaid:
    """Return what source code says of elements.

    A node is the one that the code calls so; where the policies put it into another namespace, the one whose own name
    is the same.

    Parameters
    ----------
    of_others
        Folders that were left out.
    elements
        Of a graph, in the order of its vertices.
    """
    from rosprivacy.ingest.code.code_names import code_evidence  # noqa: PLC0415 - light start
    from rosprivacy.ingest.code.node_uses import node_uses  # noqa: PLC0415

    types: dict[tuple[str, str], list[MessageType]] = defaultdict(list)
    for one in code_evidence(codes):
        if one.name and one.type:
            types[one.kind, one.name].append(MessageType(one.type, one.place))
    channels = ((at, (e.kind, e.name)) for at, e in enumerate(elements) if e.is_channel)
    found = node_uses(codes)
    uses, placed = _placed(found.of_nodes, elements)
    homeless = {use for name, some in found.of_nodes.items() if name not in placed for use in some}
    homeless -= {use for some in uses.values() for use in some}
    return CodeSaid(
        {at: tuple(types[key]) for at, key in channels if key in types},
        uses,
        tuple(sorted({*found.without_node, *homeless}, key=lambda use: (use.place, use.name))),
        tuple(one for code in codes for one in code.problems if not code.uses and not code.sites),
        of_others,
        found.local,
    )


def _placed(
    of_nodes: Mapping[str, tuple[NodeUse, ...]], elements: Iterable[Element]
) -> tuple[dict[int, tuple[NodeUse, ...]], set[str]]:
    """The uses of each node of a system, and the names in code that are of one."""
    by_own_name: dict[str, list[str]] = defaultdict(list)
    for name in of_nodes:
        by_own_name[name.rpartition("/")[2]].append(name)
    uses, placed = {}, set()
    for vertex, element in enumerate(elements):
        if element.is_node:
            own = element.name.rpartition("/")[2]
            names = [element.name] if element.name in of_nodes else by_own_name.get(own, [])
            placed.update(names)
            if names:
                uses[vertex] = tuple(use for name in names for use in of_nodes[name])
    return uses, placed
