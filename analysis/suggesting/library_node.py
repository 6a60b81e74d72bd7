"""A node, as rules about libraries see it: what it is thought to write and to read; and a rule that speaks about it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import Confidence, interface_of
from rosprivacy.analysis.suggesting.carried_kinds import ANYTHING, cannot_carry
from rosprivacy.analysis.suggesting.evidence import CODE, NAMED, TYPE, Evidence, Label
from rosprivacy.analysis.suggesting.library_rules import ADDRESS, PROGRAM
from rosprivacy.analysis.suggesting.name_rules import has_word, of_node
from rosprivacy.analysis.suggesting.weighing import surer

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from rosprivacy.analysis.model import Element
    from rosprivacy.analysis.suggesting.carried_kinds import Clue, Rules
    from rosprivacy.analysis.suggesting.library_rules import LibraryRule, NodeUse

    Written = Sequence[tuple[Element, Sequence[str]]]  # channels with the names of their types
_VERBS = {PROGRAM: "starts", ADDRESS: "names"}  # what code does with a thing of such a name


class Spoken(NamedTuple):
    """A rule, and a use that it speaks about."""

    rule: LibraryRule
    use: NodeUse

    def evidence(self, label: Label, sure: Confidence, then: str = "") -> Evidence:
        """Return what it says for a label: no surer than the rule."""
        sure = sure if surer(self.rule.confidence, sure) else self.rule.confidence
        name = self.use.name
        how = next((verb for sign, verb in _VERBS.items() if name.startswith(sign)), "uses")
        what = f"{how} {name[2:] if how != 'uses' else name}"
        reason = f"{what} ({self.use.place}): {self.rule.why}{then}"
        return Evidence(label, CODE, sure, reason, self.use.place, alone=self.rule.alone)


class LibraryNode(NamedTuple):
    """One node: what it is thought to write and to read.

    Attributes
    ----------
    written
        What it writes, with the names of its types; none where nobody knows them.
    out, into
        The kinds that types and names suggest of what it writes, and of what it reads.
    by_type
        Of ``out``, those that a type suggests.
    surely_typed
        Of these, those of which a type says more than ``may``.
    told
        Those, and what a name says.
    reads
        Whether it reads anything.
    simulates
        Whether its name says that it measures nothing.
    """

    element: Element
    rules: Rules
    written: Written
    out: frozenset[str]
    into: frozenset[str]
    by_type: frozenset[str]
    surely_typed: frozenset[str]
    told: frozenset[str]
    reads: bool
    simulates: bool

    @classmethod
    def of(
        cls, element: Element, rules: Rules, written: Written, out: Iterable[Clue], into: Iterable[Clue], *, reads: bool
    ) -> LibraryNode:
        """Return a node by what is thought of its channels."""
        out = tuple(out)
        sure = frozenset(one.kind for one in out if one.confidence is not Confidence.MAY)
        return cls(
            element,
            rules,
            written,
            frozenset(one.kind for one in out),
            frozenset(one.kind for one in into),
            frozenset(one.kind for one in out if one.ground == TYPE),
            sure,
            sure.union(one.kind for one in out if one.ground == NAMED),
            reads,
            has_word(element.name, rules.names.simulated),
        )

    @property
    def typed_all(self) -> bool:
        """Whether the types of all that it writes are known."""
        return bool(self.written) and all(types for _, types in self.written)

    def related(self, kind: str, kinds: Iterable[str]) -> bool:
        """Return whether data of a kind can be of one of some others; that they can be anything says nothing."""
        return self.rules.related_to_one(kind, (one for one in kinds if one != ANYTHING))

    def is_named_after(self, kind: str) -> bool:
        """Return whether the node is called after what brings in such a kind."""
        spoken = of_node(self.element.name, self.rules.names.brings_in)
        return spoken is not None and self.related(kind, spoken.rule.kinds)

    def cannot_write(self, kind: str) -> bool:
        """Return whether none of its channels can carry a kind; of a node that writes nothing, that is not so."""
        every = [cannot_carry(kind, element, types, self.rules) for element, types in self.written]
        return bool(every) and all(every)

    def is_limited(self, kind: str) -> bool:
        """Return whether the types of all that it writes exclude a kind; those that only suggest others do not."""
        limits = [self.rules.limits.get(key) for key in self._keys()]
        return all(limit and kind in limit.kinds for limit in limits)

    def writes_anything(self) -> bool:
        """Return whether a type that it writes is made for anything, such as a text."""
        said = [self.rules.suggestions.get(key, ()) for key in self._keys()]
        return any(ANYTHING in rule.kinds for some in said for rule in some)

    def label(self, role: str, kind: str) -> Label:
        """Return a label of the node."""
        return Label(self.element, role, kind)

    def _keys(self) -> Sequence[tuple[str, str]]:
        return [(interface_of(name), element.leg) for element, types in self.written for name in types]
