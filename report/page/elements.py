"""The inventory of a report: elements that data gets to, with what labels say of them; the others by name.

In: an ``Index``. Out: rows; elements that differ only in the robot are one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.text import fit
from rosprivacy.report.naming import key, name
from rosprivacy.report.page.entries_of_robots import grouped, weight

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rosprivacy.report.naming import Key
    from rosprivacy.report.page.index import Index


PASSES = ("conduit", "sanitizer")  # what is said of data that may never get there


@dataclass(frozen=True, slots=True)
class ElementItem:
    """An element that data gets to.

    Attributes
    ----------
    robots
        How many have it.
    roles
        What labels say of it, one text for each role.
    reviewed
        Whether labels cover all kinds of data that get there.
    """

    name: str
    kind: str
    robots: int
    data: str
    roles: tuple[str, ...]
    reviewed: bool


@dataclass(frozen=True, slots=True)
class Enclave:
    """An enclave of the policies, with the names of its nodes in a row."""

    name: str
    nodes: str


def items(index: Index) -> tuple[ElementItem, ...]:
    """Return the elements that data gets to, in the order of the document."""
    said: dict[Any, dict[str, list[str]]] = {}
    there = {  # with broader kinds: of these the document names the narrowest
        key(row["element"]): {up for name in (*row["categories"], *row["pseudonymised"]) for up in index.upwards(name)}
        for row in index.document["carries"]
    }
    makes = {(key(row["element"]), row["from"]) for row in index.document["derivations"] if row["reached"]}
    for (element, category), roles in index.roles.items():
        for role in roles:
            noise = role in PASSES and category not in there.get(element, ())  # nothing of it gets there
            if not noise and (role != "derivation" or (element, category) in makes):
                said.setdefault(element, {}).setdefault(role, []).append(category)
    open_at = {element for element, _ in index.unreviewed}

    def merge_key(row: Mapping[str, Any]) -> Any:
        at = key(row["element"])
        roles = tuple((role, tuple(names)) for role, names in said.get(at, {}).items())
        return at[1:], tuple(row["categories"]), tuple(row["pseudonymised"]), roles, at in open_at

    return tuple(_item(group, said, open_at, index) for group in grouped(index.document["carries"], merge_key))


def _item(group: list[Mapping[str, Any]], entry: Mapping[Any, Any], open_at: set[Any], index: Index) -> ElementItem:
    row, words = group[0], index.words
    element, at = row["element"], key(row["element"])
    hidden = [index.data(category, pseudonymised=True) for category in row["pseudonymised"]]
    robots = weight((row["element"]["robot"] for row in group), index.alike)
    return ElementItem(
        name=name(element) if robots == 1 else fit(element["name"]),
        kind=words.kind(element),
        robots=robots,
        data=words.row([*(_category_held(at, category, index) for category in row["categories"]), *hidden]),
        roles=tuple(words(f"role.{role}", data=index.all_data(c)) for role, c in entry.get(at, {}).items()),
        reviewed=at not in open_at,
    )


def _category_held(at: Key, category: str, index: Index) -> str:
    """A kind of data that gets there; and that it is said to be cleaned there, where it is."""
    data = index.data(category)
    return index.words("inventory.cleaned", data=data) if (at, category) in index.cleaned else data


def unreached_names(index: Index) -> tuple[tuple[str, tuple[str, ...]], ...]:
    """Return the names of the elements that no data gets to, by kind."""
    groups = grouped(index.document["unreached"], lambda element: element["kind"])
    return tuple((index.words.kind({"kind": some[0]["kind"]}), index.names(some)) for some in groups)


def enclaves(index: Index) -> tuple[Enclave, ...]:
    """Return the enclaves."""
    return tuple(
        Enclave(fit(row["enclave"]), index.words.row(map(fit, row["nodes"]))) for row in index.document["enclaves"]
    )
