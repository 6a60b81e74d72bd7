"""Which values of Python code are nodes, by what calls an object becomes one, and what it is called there."""

from __future__ import annotations

import ast
import sys
from collections import defaultdict
from typing import TYPE_CHECKING

from rosprivacy.ingest.scan.python.python_calls import INIT
from rosprivacy.ingest.scan.python.python_ends import WRAPPERS, is_node_class
from rosprivacy.ingest.scan.python.python_scopes import Scope, is_super
from rosprivacy.ingest.scan.python.python_value_types import Frame, Instance, Made, Open, Run, Text, Value, Values
from rosprivacy.ingest.scan.scan_facts import DEFAULT, NODE_NAME, NODE_SPACE, Name, NamePiece, plain_text, sorted_names

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.ingest.scan.python.python_calls import PythonCalls
    from rosprivacy.ingest.scan.python.python_returns import PythonReturns

NodeKey = Scope | ast.Call  # a class, or the call that makes a node
NO_NODES = frozenset(sys.stdlib_module_names) | {"rclpy", "launch", "launch_ros", "ament_index_python"}


class PythonOwners:
    """The nodes of a checkout.

    Attributes
    ----------
    runs
        By the call that makes a node without a class of the checkout: where it runs.
    """

    def __init__(self, calls: PythonCalls, returns: PythonReturns) -> None:
        self.checkout = calls.checkout
        self.calls, self.returns, self.values = calls, returns, calls.values
        self.runs: dict[ast.Call, dict[Run, None]] = defaultdict(dict)
        returns.own_names = self._own_names

    def is_node(self, cls: Scope) -> bool:
        """Return whether a class is one of nodes."""
        return any(is_node_class(one) for one in self.values.line(cls)[1])

    def may_be_node(self, cls: Scope) -> bool:
        """Return whether a class is derived of one that is not in the checkout, and may be a node."""
        return self.is_node(cls) or any(one.partition(".")[0] not in NO_NODES for one in self.values.line(cls)[1])

    def keys(self, values: Values, *, as_owner: bool = False) -> tuple[list[NodeKey], list[Value]]:
        """Return the nodes among values, and what is none.

        Parameters
        ----------
        as_owner
            Whether a method of nodes is called on them.
        """
        keys: dict[NodeKey, None] = {}
        rest: list[Value] = []
        for one in values:
            if isinstance(one, Instance) and (self.is_node(one.scope) or (as_owner and self.may_be_node(one.scope))):
                keys.update(dict.fromkeys(self.calls.derived(one.scope) if one.origin is None else [one.scope]))
            elif isinstance(one, Made) and is_node_class(one.name):
                keys[one.run.call] = None
                self.runs[one.run.call][one.run] = None
            else:
                rest.append(one)
        return list(keys), rest

    def made_by(self, me: Instance) -> Iterator[tuple[Run, int, str]]:
        """Yield the calls by which an object becomes a node, the place of the name, and the class of the library."""
        classes, libraries = self.values.line(me.scope)
        bases = [one for one in libraries if is_node_class(one)] or list(libraries[:1])
        if not bases:
            return
        if self.values.method(me.scope, INIT) is None:
            made = (
                [me.origin]
                if me.origin
                else [Run(one.call, self.values.frame_of(one.scope)) for one in self.calls.constructions(me.scope)]
            )
            yield from ((run, 0, bases[0]) for run in made)
        for one in self.checkout.calls.get(INIT, ()):
            above = one.scope.of_class
            if above is not None and above in classes:
                what = self.calls.constructor(one.call, above, me)
                if isinstance(what, str) and what in bases:
                    through = is_super(getattr(one.call.func, "value", None))
                    yield Run(one.call, Frame(one.scope, me)), 0 if through else 1, what

    def names(self, runs: Iterable[tuple[Run, int, str]]) -> tuple[tuple[Name, ...], tuple[Name, ...]]:
        """Return what nodes are called where they are made, and their namespaces."""
        names: dict[Name, None] = {}
        spaces: dict[Name, None] = {}
        for run, place, library in runs:
            wrapper = WRAPPERS.get(library.rpartition(".")[2], "")
            given = self.returns.argument(run.call, run.frame, place, "node_name")
            if not given and wrapper:
                given = (Text((NamePiece(wrapper, DEFAULT),)),)
            names.update(dict.fromkeys(self.values.texts(without_none(given), "the name of the node")))
            space = self.returns.argument(
                run.call, run.frame, place + 1 if wrapper else len(run.call.args), "namespace"
            )
            spaces.update(dict.fromkeys(one for one in self.values.texts(without_none(space)) if plain_text(one) != ""))
        return sorted_names(names), sorted_names(spaces)

    def _own_names(self, method: str, me: Instance) -> Values:
        """What a node says of its own name; a launch file can set it, as it sets parameters."""
        names, spaces = self.names(self.made_by(me))
        known = [text for one in names if (text := plain_text(one)) is not None]
        if len(known) != len(names) or not names or (spaces and method != "get_name"):
            return (Open(f"{method}()"),)
        if method == "get_namespace":
            return (Text((NamePiece("/", DEFAULT, NODE_SPACE),)),)
        own = [NamePiece(one, DEFAULT, NODE_NAME) for one in known]
        space = (NamePiece("/", DEFAULT, NODE_SPACE),) if method == "get_fully_qualified_name" else ()
        return tuple(Text((*space, one)) for one in own)


def without_none(values: Values) -> Values:
    """Return values without None, where something else is among them."""
    return tuple(one for one in values if getattr(one, "value", "") is not None)
