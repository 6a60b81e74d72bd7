"""What the result rests on (rule S12): assumptions, files, what was said of them; and what hangs on single statements.

In: an ``Index``. Out: plain texts, in a fixed order. What hangs on a statement is what there would be if it were wrong:
a user's statements before shipped ones, those on which most hangs first. Message types are told with where each is
known from, and what they close (rule S15); a type that only a bag tells has no writer.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.model import MAY_REVEAL, OWN_DOMAINS
from rosprivacy.analysis.text import fit, printable
from rosprivacy.report.document.ledger import hanging_labels
from rosprivacy.report.finding_facts import grouped
from rosprivacy.report.naming import infrastructure_file, key, name
from rosprivacy.report.observed_lines import observed_lines
from rosprivacy.report.page.hanging import Hanging, hanging

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from rosprivacy.report.page.index import Index

ALL = "all"


class File(NamedTuple):
    """A file that was read: its role in words, its name, its hash."""

    role: str
    name: str
    sha256: str


class Remark(NamedTuple):
    """What was said of a file when it was read.

    Attributes
    ----------
    endings
        How several that begin with the text go on; empty of one that stands alone.
    """

    place: str
    severity: str
    text: str
    endings: tuple[str, ...] = ()


class ResultGrounds(NamedTuple):
    """What the result rests on.

    Attributes
    ----------
    assumptions, files, remarks
        In sentences; what was read, and what was said of it.
    closed
        What closed a path.
    hanging
        What hangs on single statements; None where nobody asked.
    typed, only_by_types
        Channels of known types, and the paths that only these close: (data, ends).
    """

    assumptions: tuple[str, ...]
    files: tuple[File, ...]
    remarks: tuple[Remark, ...]
    closed: tuple[ClosedSection, ...]
    hanging: tuple[Hanging, ...] | None
    typed: tuple[Typed, ...]
    only_by_types: tuple[tuple[str, str], ...]


def grounds(index: Index) -> ResultGrounds:
    """Return what a document says that its result rests on."""
    return ResultGrounds(
        assumptions=tuple(assumed(index)),
        files=files(index),
        remarks=remarks(index),
        closed=closed(index),
        hanging=hanging(index),
        typed=typed(index),
        only_by_types=only_by_types(index),
    )


def assumed(index: Index) -> Iterator[str]:
    """Return the assumptions."""
    words, said = index.words, index.document["assumptions"]
    yield words(f"assumption.view.{index.document['view']}")
    yield words("assumption.unlabelled")
    yield from observed_lines(index.document, words)
    yield _standard(index)
    yield from _stopped(index)
    yield from _types(index)
    if said["categories_asked"] != ALL:
        yield words("assumption.categories", names=words.row(map(fit, said["categories_asked"])))
    if said.get("data_types_asked", ALL) != ALL:
        yield words("assumption.types", names=words.row(_type(kind, index) for kind in said["data_types_asked"]))
    if factors := said.get("identity_factors_asked"):
        yield words(
            "assumption.factors", names=words.row(words.of_value(f"factor.{factor}", fit(factor)) for factor in factors)
        )
    if said.get("article9_only"):
        yield words(f"assumption.article9.{said.get('article9_level', MAY_REVEAL)}")
    for category, kinds in said.get("may_be_asked", {}).items():
        yield words("assumption.broader", data=index.data(category), kinds=index.all_data(kinds))
    if "database" in said:
        yield words("assumption.database", robots=words.count(said["database"]["robots"], "robot"))
    if not said["labels"]:
        yield words("file.none")
    yield from _outside(index)
    yield from _unstated(index)
    yield from _decisions(index)
    yield words("assumption.law", date=words.date(said["law_as_of"]))
    yield words("assumption.labels")


def _decisions(index: Index) -> Iterator[str]:
    """The head of the log of decisions, to be written down outside of it; or that nobody would see a change."""
    decisions = index.document["assumptions"].get("decisions")
    if decisions and decisions.get("head"):
        yield index.words("assumption.decisions.log", file=fit(decisions["file"]), head=decisions["head"])
    elif decisions:
        yield index.words("assumption.decisions.file", file=fit(decisions["file"]))


def _standard(index: Index) -> str:
    taken = index.document["assumptions"]["standard_channels"]
    if not taken or not index.document["standard_channels"]:
        return index.words("assumption.standard.none")
    channels = index.words.count(index.document["standard_channels"], "channel")
    said = {"channels": channels, "file": fit(taken["file"])}
    if proposed := infrastructure_file(index.document["assumptions"]):
        return index.words("assumption.standard.proposed", **said, proposed=proposed)
    return index.words("assumption.standard", **said)


def _stopped(index: Index) -> Iterator[str]:
    """Standard channels at which data stops, those of which a glob says otherwise, and what labels take away."""
    words, said = index.words, index.document["assumptions"]
    reached = said.get("standard_channels_reached", ())
    if reached:
        names = index.names_by_node((row["element"] for row in reached), counted=True)
        yield words("assumption.standard.reached", names=words.row(names))
    if kept := [row for row in reached if row.get("keeps_from")]:
        yield words("assumption.standard.keeps", rows="; ".join(_kept_away(row, index) for row in kept))
    if unchanged := said.get("standard_channels_unchanged", ()):
        yield words("assumption.standard.unchanged", element=words.row(index.names_by_node(unchanged)))
    for row in said.get("absent", ()):
        yield words("assumption.absent", element=name(row["element"]), why=printable(row["why"]))
    if rows := hanging_labels(index.document):
        yield words(
            "assumption.hangs", labels=words.row(f"{name(row['element'])} ({fit(place)})" for place, row in rows)
        )
    yield from _globs(index)
    for row in said.get("overruled", ()):
        yield words(
            f"assumption.overruled.{row['role']}",
            elements=words.row(map(printable, row["elements"])),
            data=index.all_data(row["categories"]),
            lost=fit(f"{row['file']}:{row['line']}"),
            by=fit(f"{row['by']['file']}:{row['by']['line']}"),
        )


def _kept_away(row: Mapping[str, Any], index: Index) -> str:
    ends = {"element": name(row["element"]), "end": name(row["keeps_from"])}
    return index.words("assumption.standard.keeps.one", **ends)


def _globs(index: Index) -> Iterator[str]:
    """What each glob of the label files decides and closes."""
    words = index.words
    for row in index.document["assumptions"].get("globs", ()):
        at = {"place": fit(f"{row['file']}:{row['line']}"), "says": words.row(row["says"])}
        if flows := row.get("flows"):
            text = words("assumption.glob.flows", **at, flows=words.count(flows, "flow"), closed=row["flows_closed"])
        else:
            elements = words.count(row["elements"], "element")
            text = words("assumption.glob", **at, elements=elements, closed=row["closed"], reviewed=row["reviewed"])
        warning = row["warning"]
        yield f"{text} {words(f'assumption.glob.{warning}')}" if warning else text


def _types(index: Index) -> Iterator[str]:
    """When message types were observed, what these close, and the findings that only they close (rules S15, S16)."""
    words, said = index.words, index.document["assumptions"]
    for file in said.get("types", ()):
        seen = file["observed"]
        if seen["from"]:
            yield words(
                "assumption.types.observed",
                file=fit(file["file"]),
                start=words.moment(fit(seen["from"])),
                end=words.moment(fit(seen["to"])),
            )
    if "type_limits" not in said:
        return
    limits = said["type_limits"]
    if limits is None:
        yield words("assumption.types.none")
        return
    flows = words.count(limits["flows"], "flow")
    yield words("assumption.types.limits", flows=flows, file=fit(limits["file"]), sha=limits["sha256"][:12])
    if closed := said.get("closed_by_types", ()):
        rows = (f"{index.data(row['category'])}: {name(row['source'])} → {name(row['leak'])}" for row in closed)
        yield words("assumption.types.closed", findings=words.row(rows))


def _type(kind: str, index: Index) -> str:
    return index.words.of_value(f"type.{kind}", fit(kind))


def _outside(index: Index) -> Iterator[str]:
    words, said = index.words, index.document["assumptions"]
    taken = said.get("taken_by_kind", {})
    if taken:
        rows = (
            words.pair(
                words.row(words.kind({"kind": kind}) for kind in kinds), words(f"assumption.kinds.{taken[kinds[0]]}")
            )
            for kinds in grouped(taken, taken.__getitem__)
        )
        yield words("assumption.kinds", rows="; ".join(rows))
    if "countries_as_of" in said:
        yield words("assumption.countries", date=words.date(said["countries_as_of"]))


def _unstated(index: Index) -> Iterator[str]:
    rows = index.document["assumptions"]["sanitizers_without_method"]
    for category in dict.fromkeys(row["category"] for row in rows):
        elements = [row["element"] for row in rows if row["category"] == category]
        for element in index.names(elements):
            yield index.words("assumption.unstated", element=element, data=index.data(category))


def files(index: Index) -> tuple[File, ...]:
    """Return the files that were read, by role."""
    said, words = index.document["assumptions"], index.words
    rows = [
        File(words(f"file.{kind}"), fit(entry["file"]), entry["sha256"])
        for kind in ("project", "fleet", "policies", "types", "labels", "ontologies")
        for entry in said.get(kind, ())
    ]
    standard = said["standard_channels"]
    limits = said.get("type_limits")
    rows += [File(words("file.type-limits"), fit(limits["file"]), limits["sha256"])] if limits else []
    return (*rows, *([File(words("file.standard"), fit(standard["file"]), standard["sha256"])] if standard else []))


def remarks(index: Index) -> tuple[Remark, ...]:
    """Return what was said of the files, warnings before notices; what begins alike at one line is one.

    Robots that share a domain are an assumption already.
    """
    order = {"error": 0, "warning": 1, "notice": 2}
    rows = [row for row in index.document["diagnostics"] if row.get("code") != OWN_DOMAINS]
    rows.sort(key=lambda row: order[row["severity"]])
    return tuple(_remark(same, index) for same in grouped(rows, _beginning))


AND = ", and "  # after which messages of one sort differ


def _beginning(row: Mapping[str, Any]) -> tuple[str, str, int, str]:
    return row["severity"], row["file"], row["line"], row["message"].rpartition(AND)[0] or row["message"]


def _remark(rows: list[Mapping[str, Any]], index: Index) -> Remark:
    place = f"{fit(rows[0]['file'])}:{rows[0]['line']}"
    messages = tuple(dict.fromkeys(printable(row["message"]) for row in rows))
    severity = index.words(f"severity.{rows[0]['severity']}")
    if len(messages) == 1:
        return Remark(place, severity, messages[0])
    begins = messages[0].rpartition(AND)[0] + AND
    return Remark(place, severity, begins.rstrip(), tuple(message.removeprefix(begins) for message in messages))


class Typed(NamedTuple):
    """A channel, or a leg of one, that data gets to.

    Attributes
    ----------
    types
        (name, from where it is known) of each.
    data
        Kinds that it carries.
    closed
        Kinds that end there, since its types cannot carry them.
    """

    name: str
    kind: str
    types: tuple[tuple[str, str], ...]
    data: str
    closed: str


def typed(index: Index) -> tuple[Typed, ...]:
    """Return the channels with data of which types are known, in the order of the document."""
    carries = {key(row["element"]): row for row in index.document["carries"]}
    limits = index.document["assumptions"].get("type_limits_reached", ())
    closed = {key(row["element"]): row["categories"] for row in limits}

    def channel_of(row: Mapping[str, Any]) -> tuple[str, str]:
        at = key(row["element"])
        return _data(carries.get(at, {}), index), index.all_data(closed.get(at, ()))

    def merge_key(row: Mapping[str, Any]) -> Any:
        types = tuple((one["type"], one["file"], one["line"]) for one in row["types"])
        return key(row["element"])[1:], channel_of(row), types

    with_data = {*carries, *closed}
    rows = [row for row in index.document.get("types", ()) if key(row["element"]) in with_data]
    return tuple(_typed(some, channel_of(some[0]), index) for some in grouped(rows, merge_key))


def _data(row: Mapping[str, Any], index: Index) -> str:
    hidden = (index.data(category, pseudonymised=True) for category in row.get("pseudonymised", ()))
    return index.words.row([*map(index.data, row.get("categories", ())), *hidden])


def _typed(entries: list[Mapping[str, Any]], channel: tuple[str, str], index: Index) -> Typed:
    return Typed(
        index.words.row(index.names([row["element"] for row in entries])),
        index.words.kind(entries[0]["element"]),
        tuple((fit(one["type"]), _origin(one, index)) for one in entries[0]["types"]),
        *channel,
    )


def _origin(type_entry: Mapping[str, Any], index: Index) -> str:
    observed = {entry["file"] for entry in index.document["assumptions"].get("types", ())}
    how = "stated" if type_entry["stated"] else "observed" if type_entry["file"] in observed else "recorded"
    return index.words(f"channel_type.{how}", place=f"{fit(type_entry['file'])}:{type_entry['line']}")


def only_by_types(index: Index) -> tuple[tuple[str, str], ...]:
    """Return (kind of data, from where to where) of what only types close."""
    return tuple(
        (index.data(row["category"]), index.words("entry.from.to", source=name(row["source"]), leak=name(row["leak"])))
        for row in index.document["assumptions"].get("closed_by_types", ())
    )


class ClosedSection(NamedTuple):
    """One row: where data ends, which data, on whose word, and where it would get to.

    ``hangs`` where the list of what hangs on single statements has the paths of all these data.
    """

    where: str
    data: str
    statement: str
    lines: tuple[str, ...]
    behind: str
    hangs: bool = False


def closed(index: Index) -> tuple[ClosedSection, ...]:
    """Return the rows that closed a path; older documents have none."""
    rows = [row for row in index.document.get("taken_away", ()) if row["leak"] or row["open"] or row["perhaps"]]
    rows.sort(key=lambda row: row["leak"] is None)
    return tuple(_closed(group, index) for group in grouped(rows, _normalised))


def _normalised(row: Mapping[str, Any]) -> Any:
    ends = [(row[end] or {}).get("name", "") for end in ("element", "to", "leak", "open")]
    places = tuple((place["file"], place["line"]) for place in row["places"])
    return row["by"], tuple(ends), tuple(row["categories"]), places, row["note"]


def _closed(rows: list[Mapping[str, Any]], index: Index) -> ClosedSection:
    words, row = index.words, rows[0]

    def of(end: str) -> str:
        elements = [row[end] for row in rows if row[end]]
        return words.row(index.names(elements)) if elements else ""

    behind = [words("closed.leak", element=of("leak"))] if row["leak"] else []
    behind += [words("closed.open", element=of("open"))] if row["open"] else []
    said = words(f"closed.{row['by']}")
    return ClosedSection(
        where=" → ".join(end for end in (of("element"), of("to")) if end),
        data=index.all_data(row["categories"]),
        statement=words("closed.glob", said=said) if row["glob"] else said,
        lines=tuple(f"{fit(place['file'])}:{place['line']}" for place in row["places"]),
        behind=words.row(behind) if behind else words("closed.perhaps"),
        hangs=bool(behind) and all(_hangs(row, index) for row in rows),
    )


def _hangs(row: Mapping[str, Any], index: Index) -> bool:
    """Whether what hangs on the statement that closes a row names the same data, recipient and element to review."""
    places = {(place["file"], place["line"]) for place in row["places"]}
    hung = [one for one in index.document.get("hangs_on") or () if (one["file"], one["line"]) in places]
    opened = {(opening["category"], key(opening["leak"])) for one in hung for opening in one["findings"]}
    asked = {key(question["element"]) for one in hung for question in one["questions"]}
    leads = row["leak"] is None or opened >= {(category, key(row["leak"])) for category in row["categories"]}
    return bool(opened) and leads and (row["open"] is None or key(row["open"]) in asked)
