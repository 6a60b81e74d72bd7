"""Rules that an ``<xi:include>`` of a profile breaks: what it brings is nothing, or is there already.

In: names of policies that were read. Out: the rules that are broken, at the line of the include. The files are read
once more, since a policy does not keep by which include a line came.
"""

from __future__ import annotations

from collections import Counter
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.errors import InputErrors, shown
from rosprivacy.analysis.model import Breach
from rosprivacy.ingest.lint.rule_table import RULES
from rosprivacy.ingest.policies.names import resolve
from rosprivacy.ingest.policies.policy_xml import ROLES
from rosprivacy.ingest.policies.xinclude import Documents

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from rosprivacy.analysis.model import Place
    from rosprivacy.ingest.policies.xinclude import Item

AROUND = ("enclaves", "contexts", "enclave", "context", "profiles")  # what profiles stand in
Line = tuple[str, str, str, str]
"""Kind, role, ALLOW or DENY, and name."""


class _Include(NamedTuple):
    """One that was read: where it stands, how deep, which fragment it names, and what it brings."""

    place: Place
    chain: tuple[tuple[str, str], ...]
    fragment: tuple[str, str]
    brought: tuple[Item, ...]


class _Traced(Documents):
    """Documents that note which includes they read."""

    def __init__(self, root: Path, max_bytes: int) -> None:
        super().__init__(root, max_bytes)
        self.read: list[_Include] = []

    def took(self, include: Item, file: str, xpointer: str, brought: list[Item]) -> None:
        self.read.append(_Include(include.place, include.chain, (file, xpointer), tuple(brought)))


def include_breaches(files: Iterable[str], include_root: str | None, max_bytes: int) -> Iterator[Breach]:
    """Yield the rules that includes break; what is no policy, or cannot be read, has none.

    Notes
    -----
    Linear in the lines that includes bring.
    """
    for file in files:
        documents = _Traced(Path(include_root) if include_root else Path(file).parent, max_bytes)
        try:
            root = documents.open(file)
        except InputErrors:
            continue
        if root.tag == "policy":
            yield from _below(documents, root)


def _below(documents: _Traced, item: Item) -> Iterator[Breach]:
    for child in documents.children(item):
        if child.tag == "profile":
            yield from _of_profile(documents, child)
        elif child.tag in AROUND:
            yield from _below(documents, child)


def _of_profile(documents: _Traced, profile: Item) -> Iterator[Breach]:
    before = len(documents.read)
    children = documents.children(profile)
    read = documents.read[before:]
    if not read:
        return
    repeated: set[Place] = set()
    first: dict[tuple[str, str], Place] = {}
    for one in read:
        if one.fragment in first and one.chain == profile.chain:
            repeated.add(one.place)
            message = f"{shown(one.fragment[0])} is included at {first[one.fragment]} already; remove this include"
            yield Breach(RULES["repeated-include"], one.place, message)
        first.setdefault(one.fragment, one.place)
    own = [one for one in read if one.chain == profile.chain and one.brought and one.place not in repeated]
    lines = [_lines(documents, profile, one.brought) for one in own]
    brought = {id(item.element) for one in read for item in one.brought}
    left = _lines(documents, profile, [child for child in children if id(child.element) not in brought])
    times = Counter(chain(left, *lines))
    for one, said in zip(reversed(own), reversed(lines), strict=True):
        if not said:
            if all(item.tag != "metadata" for item in one.brought):
                message = f"what the include brings of {shown(one.fragment[0])} grants and denies nothing"
                yield Breach(RULES["empty-include"], one.place, message)
        elif all(times[line] > 1 for line in said):
            message = f"the profile has all that it brings of {shown(one.fragment[0])} from elsewhere; remove it"
            yield Breach(RULES["needless-include"], one.place, message)
            times.subtract(said)


def _lines(documents: Documents, profile: Item, groups: Sequence[Item]) -> set[Line]:
    """What some groups of a profile say."""
    namespace, node = (str(profile.element.get(name) or "") for name in ("ns", "node"))
    return {
        (kind, role, str(group.element.get(role)), resolve(name.element.text or "", namespace, node))
        for group in groups
        if group.tag in ROLES
        for kind, roles in [ROLES[group.tag]]
        for name in documents.children(group)
        for role in roles
        if group.element.get(role) is not None
    }
