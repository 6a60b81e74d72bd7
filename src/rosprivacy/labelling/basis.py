"""What there is to suggest about: an answer of ours, with what source code says of its channels and nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.analysis.errors import InputError
    from rosprivacy.analysis.model import Bound, MessageType
    from rosprivacy.analysis.suggesting.asked_elements import Comments
    from rosprivacy.analysis.suggesting.library_rules import NodeUse
    from rosprivacy.ingest.code.node_uses import Local
    from rosprivacy.result import Result


class CodeSaid(NamedTuple):
    """What code says of a system.

    Attributes
    ----------
    types
        By vertex of a channel.
    uses
        By vertex of a node.
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
    unplaced: tuple[NodeUse, ...]
    problems: tuple[InputError, ...]
    of_others: tuple[str, ...]
    local: tuple[Local, ...] = ()


NO_CODE = CodeSaid({}, {}, (), (), ())


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
    code
        What else source code says.
    """

    result: Result
    bound: Bound
    places: Mapping[tuple[str, str, str], int]
    comments: Comments
    code: CodeSaid
