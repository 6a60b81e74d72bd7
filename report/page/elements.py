"""The elements of a report: the inventory, what lies outside ROS, who cleans data and who makes one kind of another.

In: an ``Index`` and the entries of the report. Out: rows of plain texts; elements that differ only in the robot are
one. Elements outside ROS stand with retention, country and recipient; what is not stated is a person's to complete, so
it is left empty and not guessed.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from itertools import islice
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.legal import on_prohibited_practices
from rosprivacy.analysis.model import SPECIAL
from rosprivacy.analysis.text import fit
from rosprivacy.report.catalogs.words import REST, shown_of
from rosprivacy.report.finding_facts import grouped
from rosprivacy.report.naming import key, name, without_leg
from rosprivacy.report.page.index import state, weight, without_robots
from rosprivacy.report.row_texts import backups_text, country

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from rosprivacy.report.naming import Key
    from rosprivacy.report.page.finding_entries import PathEntry
    from rosprivacy.report.page.index import Index

ELSEWHERE = ("source", "sanitizer", "derivation")  # roles that other sections have
PASSES = ("conduit", "sanitizer")  # what is said of data that may never get there


class ElementItem(NamedTuple):
    """An element that data gets to.

    Attributes
    ----------
    robots
        How many have it.
    roles
        What labels say of it, one text for each role.
    marks
        Those of them that no other section has: sources stand at their kinds, what cleans and makes data apart.
    reviewed
        Whether labels cover all kinds of data that get there.
    """

    name: str
    kind: str
    robots: int
    data: str
    roles: tuple[str, ...]
    marks: tuple[str, ...]
    reviewed: bool


class Enclave(NamedTuple):
    """An enclave of the policies, with the names of its nodes in a row."""

    name: str
    nodes: str


class Inventory(NamedTuple):
    """What there is: elements that data gets to, the others by kind, enclaves.

    Attributes
    ----------
    size
        How many elements and flows.
    denied
        How many flows a DENY takes back; empty if none.
    outside
        What lies outside ROS.
    cleanings, makings
        Who cleans data, and who makes one kind of another.
    """

    size: str
    denied: str
    items: tuple[ElementItem, ...]
    rest: tuple[tuple[str, int, tuple[str, ...]], ...]
    enclaves: tuple[Enclave, ...]
    outside: tuple[Outside, ...]
    cleanings: tuple[CleaningEntry, ...]
    makings: tuple[MakingEntry, ...]


def inventory(index: Index, entries: Iterable[PathEntry]) -> Inventory:
    """Return the elements of a document."""
    words, document = index.words, index.document
    elements, flows = words.count(document["elements"], "element"), words.count(document["flows"], "flow")
    denied = document["denied_flows"]
    return Inventory(
        size=words("inventory.intro", elements=elements, flows=flows),
        denied=words("inventory.denied", flows=words.count(denied, "flow")) if denied else "",
        items=items(index),
        rest=unreached_names(index),
        enclaves=enclaves(index),
        outside=outside(index),
        cleanings=cleanings(index, entries),
        makings=makings(index),
    )


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
    roles = {role: _role_text(role, of, row, index) for role, of in entry.get(at, {}).items()}
    hidden = [index.data(category, pseudonymised=True) for category in row["pseudonymised"]]
    robots = weight((row["element"]["robot"] for row in group), index.alike)
    return ElementItem(
        name=name(element) if robots == 1 else fit(element["name"]),
        kind=words.kind(element),
        robots=robots,
        data=words.row([*(_category_held(at, category, index) for category in row["categories"]), *hidden]),
        roles=tuple(filter(None, roles.values())),
        marks=tuple(text for role, text in roles.items() if text and role not in ELSEWHERE),
        reviewed=at not in open_at,
    )


def _role_text(role: str, categories: Sequence[str], row: Mapping[str, Any], index: Index) -> str:
    """What labels say of an element; kinds are not named where it is of all of them; nothing where it passes on all."""
    if role in ("conduit", "source") and set(categories) == {*row["categories"], *row["pseudonymised"]}:
        return index.words("role.source.it") if role == "source" else ""
    if role == "leak" and categories[1:] and set(categories) == set(index.categories):
        return index.words("role.leak.all")
    return index.words(f"role.{role}", data=index.all_data(categories))


def _category_held(at: Key, category: str, index: Index) -> str:
    """A kind of data that gets there; and that it is said to be cleaned there, where it is."""
    data = index.data(category)
    return index.words("inventory.cleaned", data=data) if (at, category) in index.cleaned else data


def unreached_names(index: Index) -> tuple[tuple[str, int, tuple[str, ...]], ...]:
    """Return the elements that no data gets to: kind, number of names, names; of parameter services their number."""
    groups = grouped(index.document["unreached"], lambda element: element["kind"])
    return tuple(
        (index.words.kind({"kind": some[0]["kind"]}), len(index.names(some)), index.names_by_node(some, counted=True))
        for some in groups
    )


def enclaves(index: Index) -> tuple[Enclave, ...]:
    """Return the enclaves."""
    return tuple(
        Enclave(fit(row["enclave"]), index.words.row(map(fit, row["nodes"]))) for row in index.document["enclaves"]
    )


STORAGE = "storage"
EVERY = "every"


class Outside(NamedTuple):
    """One element outside ROS.

    Attributes
    ----------
    holds
        Kinds of data that get there.
    warnings
        What has to be known and is not stated.
    place
        The line that states it.
    """

    name: str
    kind: str
    storage: bool
    holds: str
    retention: str
    backups: str
    encrypted: str
    country: str
    operator: str
    recipient: str
    transfer: str
    contract: str
    warnings: tuple[str, ...]
    place: str


def outside(index: Index) -> tuple[Outside, ...]:
    """Return all of them, storages first."""
    rows = sorted(index.outside.values(), key=lambda row: row["element"]["kind"] != STORAGE)
    return tuple(_outside(row, index) for row in rows)


def _outside(row: Mapping[str, Any], index: Index) -> Outside:
    words, element = index.words, row["element"]
    warnings = [words(f"missing.{what}") for what in row.get("missing", ())]
    if row.get("without_limit"):
        warnings.append(words("outside.unlimited", data=index.all_data(row["without_limit"])))
    return Outside(
        name=name(element),
        kind=words.kind(element),
        storage=element["kind"] == STORAGE,
        holds=index.all_data(row["holds"]),
        retention=retention(row, row["holds"], index, tuple(_of_other_data(row, index))),
        backups=backups_text(row.get("backups"), index.words),
        encrypted="" if "encrypted" not in row else words("yes" if row["encrypted"] else "no"),
        country=country(row, index.words),
        operator=fit(row.get("operator", "")),
        recipient=words.of_value(f"recipient.{row['recipient']}", row["recipient"]) if row.get("recipient") else "",
        transfer=words.of_value(f"transfer.{row['transfer']}", row["transfer"]) if row.get("transfer") else "",
        contract=fit(row.get("contract", "")),
        warnings=tuple(warnings),
        place=f"{fit(row['file'])}:{row['line']}" if row.get("file") else "",
    )


def retention(row: Mapping[str, Any], kinds: Iterable[str], index: Index, rest: tuple[str, ...] = ()) -> str:
    """Return how long a place keeps kinds of data; they are named where not all are kept alike.

    A label may state it of a broader kind, for which the report has no name but that of the label file.

    Parameters
    ----------
    row
        What is stated of the place.
    rest
        The same of other data, in words.
    """
    texts, alike = [], grouped(dict.fromkeys(kinds), lambda kind: _periods(row, kind, index))
    for same in alike:
        if periods := _periods(row, same[0], index):
            duration = index.words.row(index.words.duration(fit(period)) for period in periods)
            of_some = {"data": index.all_data(same), "duration": duration}
            texts.append(index.words("outside.of", **of_some) if rest or len(alike) > 1 else duration)
    return "; ".join((*texts, *rest))


def _periods(row: Mapping[str, Any], kind: str, index: Index) -> tuple[str, ...]:
    """How long a place keeps a kind of data, as the register has it; else what is stated of the nearest kind."""
    stated = row.get("retention", {})
    nearest = next(((stated[of],) for of in (*index.upwards(kind), EVERY) if of in stated), ())
    return index.periods.get((key(row["element"]), kind), nearest)


def _of_other_data(row: Mapping[str, Any], index: Index) -> Iterator[str]:
    """What is stated of data that do not get there."""
    periods = {period for kind in row["holds"] for period in _periods(row, kind, index)}
    for category, period in row.get("retention", {}).items():
        if period not in periods:
            duration = index.words.duration(fit(period))
            every = category == EVERY
            data = {} if every else {"data": index.data(category)}
            yield index.words("outside.every" if every else "outside.of", duration=duration, **data)


SHOWN = 100  # entries of one row


class CleaningEntry(NamedTuple):
    """What an element does to some kinds of data in one way.

    Attributes
    ----------
    method
        In words; ``weak`` if the data are still personal.
    unreached
        Kinds that never get there.
    other_readers
        Who reads the same channels and gets the data as they are; after these, who is said to clean them, too.
    past, remainder
        The first entries of these kinds whose path does not lead through the element: (anchor, number); and how many
        more there are, in words.
    recognises
        Kinds that it makes by which persons are recognised or judged: then it is no measure.
    """

    name: str
    kinds: str
    method: str
    weak: bool
    unreached: str
    leaves: str
    other_readers: tuple[str, ...]
    past: tuple[tuple[str, int], ...]
    remainder: str = ""
    recognises: str = ""


class MakingEntry(NamedTuple):
    """That an element makes one kind of data of another; ``special`` if it can be a special category only then.

    ``recognises`` if persons are recognised or judged by what it makes.
    """

    name: str
    made_of: str
    product: str
    special: bool
    recognises: bool = False


def cleanings(index: Index, entries: Iterable[PathEntry]) -> tuple[CleaningEntry, ...]:
    """Return what sanitizers do."""
    past = _Past(index, entries)

    def merge_key(row: Mapping[str, Any]) -> Any:
        lists = (tuple(row["leaves"]), tuple(row["leaves_pseudonymised"]), without_robots(row["beside"]))
        return row["element"]["kind"], row["element"]["name"], row["method"], row["stated"], lists

    return tuple(_cleaning(group, past, index) for group in grouped(index.document["sanitizers"], merge_key))


class _Past:
    """Paths to assess on which a kind of data arrives as it is, and the elements that each leads through."""

    def __init__(self, index: Index, entries: Iterable[PathEntry]) -> None:
        self._paths: dict[str, Counter[tuple[str, int]]] = defaultdict(Counter)
        self._through: dict[tuple[str, Key], list[tuple[str, tuple[str, int]]]] = defaultdict(list)
        for entry in entries:
            for finding in map(index.by_id.__getitem__, (entry.id, *entry.alike)):
                if state(finding) == "open" and not finding["pseudonymised"]:
                    place = entry.anchor, entry.number
                    self._paths[entry.category][place] += 1
                    for element in {without_leg(element) for element in finding["witness"]}:
                        self._through[entry.category, element].append((finding["id"], place))

    def of(self, elements: set[Key], categories: Iterable[str]) -> tuple[list[tuple[str, int]], int]:
        """The first entries of the categories that lead through none of the elements, and how many there are."""
        first: list[tuple[str, int]] = []
        number = 0
        for category in categories:
            paths = self._paths[category]
            here = {path for element in elements for path in self._through.get((category, element), ())}
            through = Counter(place for _, place in here)
            past = (place for place in paths if paths[place] > through[place])
            first += islice(past, SHOWN + REST)
            number += len(paths) - sum(paths[place] == count for place, count in through.items())
        return sorted(first, key=lambda place: place[1])[: shown_of(number, SHOWN)], number


def _cleaning(group: list[Mapping[str, Any]], past: _Past, index: Index) -> CleaningEntry:
    row, words = group[0], index.words
    reached = dict.fromkeys(r["category"] for r in group if r["reached"])
    unreached = [c for c in dict.fromkeys(r["category"] for r in group) if c not in reached]
    leaves = [index.data(category) for category in row["leaves"]]
    leaves += [index.data(category, pseudonymised=True) for category in row["leaves_pseudonymised"]]
    recognising = {key(r["element"]) for r in index.document["sanitizers"] if r.get("recognises")}
    too = _cleaning_too(group)
    first, number = past.of({without_leg(r["element"]) for r in group}, reached)
    return CleaningEntry(
        name=words.row(index.names([r["element"] for r in group])),
        kinds=index.all_data(reached),
        method=words(f"method.{row['method']}" if row["stated"] else "method.unstated"),
        weak=row["method"] == "pseudonymise",
        unreached=index.all_data(unreached),
        leaves=words.row(leaves),
        other_readers=(
            *index.names([*(e for r in group for e in r["beside"]), *(e for e in too if key(e) in recognising)]),
            *(
                words("sanitizer.cleans.too", element=name)
                for name in index.names(e for e in too if key(e) not in recognising)
            ),
        ),
        recognises=index.all_data(dict.fromkeys(kind for r in group for kind in r.get("recognises", ()))),
        past=tuple(first),
        remainder=words("more", n=number - len(first)) if number > len(first) else "",
    )


def _cleaning_too(group: Iterable[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Older documents do not name them."""
    return [element for row in group for element in row.get("cleaning_beside", ())]


def makings(index: Index) -> tuple[MakingEntry, ...]:
    """Return which element makes which kind of data of which."""
    article9 = {name: category["article9"] in SPECIAL for name, category in index.categories.items()}
    rows = [row for row in index.document["derivations"] if row["reached"]]
    groups = grouped(rows, lambda row: (key(row["element"])[1:], row["from"], row["to"]))
    return tuple(
        MakingEntry(
            name=index.words.row(index.names([row["element"] for row in group])),
            made_of=index.data(group[0]["from"]),
            product=index.data(group[0]["to"]),
            recognises=_recognises(index.categories.get(group[0]["to"], {})),
            special=article9.get(group[0]["to"], False) and not article9.get(group[0]["from"], False),
        )
        for group in groups
    )


def _recognises(entry: Mapping[str, Any]) -> bool:
    """Whether persons are recognised or judged by such data, as ``recognises`` has it of a category."""
    special = any(legal["verdict"] in SPECIAL for legal in entry.get("law", ()))
    return special or any(map(on_prohibited_practices, entry.get("look_at", ())))


PROTECTION = ("category", "method", "stated", "everywhere")  # what tells measures at elements of one name apart


def protections(row: Mapping[str, Any], index: Index) -> Iterator[str]:
    """Yield technical measures that are seen on the ways of the row; others are a person's to add."""
    words = index.words
    alike = grouped(
        row["measures"], lambda one: (without_leg(one["element"])[1:], *(str(one[of]) for of in PROTECTION))
    )
    for same in alike:
        first = same[0]
        method = words(f"method.{first['method']}" if first["stated"] else "method.unstated")
        names = words.row(index.names([one["element"] for one in same]))
        cleans = words("record.measure.cleans", element=names, data=index.data(first["category"]), method=method)
        yield cleans if first["everywhere"] else words("record.measure.past", measure=cleans)
    for place in row["places"] if row["encrypted"] else ():
        yield words("record.measure.encrypted", element=name(place))
