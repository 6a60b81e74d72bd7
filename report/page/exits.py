"""The places where data gets out of the robots: a card for each, with whom it gets to, and which kinds of data do.

In: an ``Index``, the flows and the entries of a report, both in the order of weight. Out: ``ExitCard``, what waits for
a decision first. Each entry stands on one card. What all flows of a card have in common stands once; what is not stated
is gathered in one line.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.text import fit, printable
from rosprivacy.report.catalogs.words import brief_reason, first_of
from rosprivacy.report.finding_facts import grouped
from rosprivacy.report.naming import all_kinds, key
from rosprivacy.report.page.elements import STORAGE, retention
from rosprivacy.report.page.flows import TO_DECIDE, WITH_A_CONTRACT
from rosprivacy.report.row_texts import country

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

    from rosprivacy.report.page.finding_entries import PathEntry
    from rosprivacy.report.page.flows import Fact, ToDecide
    from rosprivacy.report.page.index import Index

SETTLED = ("accepted", "dismissed")  # the others, in the order in which a card has them
NAMES = 3  # kinds that the heading of a card names one by one
LINKS = 6  # entries that a line leads to
STATE, OWNER = "state", "owner"  # the title of the first is that of decisions
OF_PLACE = ("element", "file", "line", "holds", "missing", "without_limit")  # what does not tell recipients apart


Gap = tuple[str, list[str]]  # what is not stated, and of which places; of all if none is named


class ExitLine(NamedTuple):
    """Kinds of data that get from the same sources to the place of a card, with what is the same of all of them.

    Attributes
    ----------
    data
        The kinds, in words, with what they are made of.
    sources
        Their names.
    kinds
        Of the findings, in words.
    spread
        On which robots, in sentences.
    facts
        (what, value) that other lines of the card have not.
    entries
        The first entries of the report that it is.
    asks
        What is to be decided, and why it is asked, in sentences.
    remainder
        How many others there are, in words.
    """

    waits: bool
    data: str
    sources: tuple[str, ...]
    article9: str
    kinds: tuple[str, ...]
    spread: tuple[str, ...]
    facts: tuple[tuple[str, str], ...]
    entries: tuple[PathEntry, ...]
    asks: tuple[str, ...]
    remainder: str = ""


class SettledLine(NamedTuple):
    """Entries of a card that nobody has to decide about now: why, the first of them, and how many others."""

    why: str
    entries: tuple[PathEntry, ...]
    remainder: str = ""


class ExitCard(NamedTuple):
    """A place where data gets out.

    Attributes
    ----------
    place, kind
        Its name and what it is.
    data
        The kinds of data that get there, in few words; of those to decide, if there are any.
    waits
        Whether somebody has to decide about it.
    lines
        What is to be decided, the worst first; ``settled`` what is not.
    facts
        (what, value) that holds for all lines.
    unstated
        What is not stated, in one sentence; empty where all is.
    flows, entries
        All that stands on it.
    """

    place: str
    kind: str
    data: str
    waits: bool
    lines: tuple[ExitLine, ...]
    facts: tuple[tuple[str, str], ...]
    unstated: str
    settled: tuple[SettledLine, ...]
    flows: tuple[ToDecide, ...]
    entries: tuple[PathEntry, ...]


def exit_cards(index: Index, flows: Sequence[ToDecide], entries: Iterable[PathEntry]) -> tuple[ExitCard, ...]:
    """Return the cards.

    Parameters
    ----------
    flows
        All of them, see ``flows.flows``.
    entries
        All entries of the report.

    Complexity: O(flows + entries).
    """

    def place_of(entry: PathEntry) -> Any:
        return _place([finding["leak"] for finding in _findings(entry, index)], index)

    of_flows = [entry for flow in flows for entry in flow.entries]
    groups = grouped([*of_flows, *(entry for entry in entries if entry.state == "dismissed")], place_of)
    by_place: dict[Any, list[ToDecide]] = {}
    for flow in flows:
        if flow.entries[0].state in TO_DECIDE:
            by_place.setdefault(place_of(flow.entries[0]), []).append(flow)
    silent = () if is_owned(flows) else (OWNER,)
    everywhere = {entry.category for flow in flows for entry in flow.entries if entry.state in TO_DECIDE}
    return tuple(_card(group, by_place.get(place_of(group[0]), ()), everywhere, silent, index) for group in groups)


def is_owned(flows: Iterable[ToDecide]) -> bool:
    """Return whether of any flow to decide it is stated who decides; else that is told once for all."""
    return any(dict(flow.facts)[OWNER] for flow in flows if flow.entries[0].state in TO_DECIDE)


def _findings(entry: PathEntry, index: Index) -> list[Mapping[str, Any]]:
    return [index.by_id[finding] for finding in (entry.id, *entry.alike)]


def _place(leaks: Sequence[Mapping[str, Any]], index: Index) -> Any:
    """What two places have in common that are one for a reader: their name, and all that is stated about them."""
    rows = (index.outside.get(key(leak), {}) for leak in leaks)
    stated = {tuple(sorted((what, repr(row[what])) for what in row if what not in OF_PLACE)) for row in rows}
    return leaks[0]["kind"], leaks[0]["name"], frozenset(stated)


def _card(
    group: Sequence[PathEntry], flows: Sequence[ToDecide], everywhere: set[str], silent: Collection[str], index: Index
) -> ExitCard:
    findings = [finding for entry in group for finding in _findings(entry, index)]
    to_decide = [entry for flow in flows for entry in flow.entries]
    place, lacks = _place_facts(findings, index) if flows else ([], [])
    spoken = [flow._replace(facts=tuple(fact for fact in flow.facts if fact[0] not in silent)) for flow in flows]
    common, missing = _in_common(spoken)
    return ExitCard(
        place=index.words.row(index.names([finding["leak"] for finding in findings])),
        kind=index.words.kind(findings[0]["leak"]),
        data=kinds_in_words(to_decide or group, everywhere, index),
        waits=any(flow.waits for flow in flows),
        lines=tuple(_lines(spoken, {what for what, _ in common}, index)),
        facts=tuple(_in_words([*place, *common], index)),
        unstated=_unstated([*lacks, *((what, []) for what in missing)], spoken, index),
        settled=tuple(_settled(group, index)),
        flows=tuple(flows),
        entries=tuple(group),
    )


def kinds_in_words(entries: Sequence[PathEntry], everywhere: set[str], index: Index) -> str:
    """Return which kinds of data there are: all, a kind with all that are narrower, or some by their names.

    Parameters
    ----------
    everywhere
        Of all places together.
    """
    words = index.words
    data = {entry.category: entry.data for entry in reversed(entries)}
    data |= {entry.category: entry.data for entry in entries if not entry.pseudonymised}
    ordered = {entry.category: data[entry.category] for entry in entries}
    plain = {entry.category for entry in entries if not entry.pseudonymised}
    if every := all_kinds(plain, everywhere, words):
        return every
    for broad in plain:
        narrower = {kind for kind in everywhere if broad in index.upwards(kind)}
        if len(narrower) >= NAMES and narrower <= plain:
            ordered = {broad: words("exit.kinds.narrower", data=data[broad])} | {
                kind: name for kind, name in ordered.items() if kind not in narrower
            }
            break
    return words.row(words.first(list(ordered.values()), NAMES))


def _in_common(flows: Sequence[ToDecide]) -> tuple[list[Fact], list[str]]:
    """Facts that are the same for all flows of a card, and what is stated of none."""
    values: dict[str, dict[str, None]] = {}
    for flow in flows:
        for what, value in flow.facts:
            values.setdefault(what, {})[value] = None
    same = [(what, next(iter(every))) for what, every in values.items() if len(every) == 1]
    return [(what, value) for what, value in same if value], [what for what, value in same if not value]


def _in_words(facts: Iterable[Fact], index: Index) -> Iterator[tuple[str, str]]:
    """Facts with their titles; that something waits to be decided goes without saying."""
    words = index.words
    waits = (STATE, words("state.open"))
    facts = (fact for fact in facts if fact != waits)
    titled = ((words("decision.state") if what == STATE else words(f"opening.{what}"), value) for what, value in facts)
    return ((title, value) for title, value in titled if value)


def _unstated(lacks: Sequence[Gap], flows: Sequence[ToDecide], index: Index) -> str:
    """What is not stated, in one sentence: of all flows, of some places, then of some flows, with their data."""
    words = index.words
    gaps = {what: dict.fromkeys(names) for what, names in lacks}
    for flow in flows:
        for what, value in flow.facts:
            if not value and what not in dict(lacks):
                gaps.setdefault(what, {})[flow.data] = None
    names = []
    for what, of in gaps.items():
        name = words(f"opening.unstated.{what}")
        of_some = words.row(words.first(list(of), NAMES))
        names.append(words("opening.unstated.some", what=name, data=of_some) if of else name)
    return words("opening.unstated", names=words.row(names)) if names else ""


def _lines(flows: Sequence[ToDecide], common: set[str], index: Index) -> Iterator[ExitLine]:
    """The flows: first one line for the sources of the same data, then one for the data of the same sources."""

    def facts(flow: ToDecide) -> tuple[Fact, ...]:
        return tuple((what, value) for what, value in flow.facts if what not in common and value)

    def alike(flow: ToDecide) -> Any:
        return flow.waits, flow.article9, flow.kinds, flow.spread, facts(flow)

    def sources(group: Sequence[ToDecide]) -> tuple[str, ...]:
        return tuple(dict.fromkeys(flow.source for flow in group))

    of_data = grouped(flows, lambda flow: (flow.content, alike(flow)))
    for groups in grouped(of_data, lambda group: (sources(group), alike(group[0]))):
        first = groups[0][0]
        every = [entry for group in groups for flow in group for entry in flow.entries]
        entries, remainder = _first(every, index)
        yield ExitLine(
            waits=first.waits,
            data=index.words.row(group[0].content for group in groups),
            sources=index.words.first(sources(groups[0]), NAMES),
            article9=first.article9,
            kinds=first.kinds,
            spread=first.spread,
            facts=tuple(_in_words(facts(first), index)),
            entries=entries,
            asks=tuple(_asks(every, index)),
            remainder=remainder,
        )


def _asks(entries: Iterable[PathEntry], index: Index) -> Iterator[str]:
    """Each question once, with the reasons for which it is asked."""
    words = index.words
    findings = [index.by_id[entry.id] for entry in entries]
    for same in grouped(findings, lambda finding: finding["kind"]):
        reasons = tuple(dict.fromkeys(_reason(finding, index) for finding in same))
        question = words(f"ask.{same[0]['kind']}")
        yield words("ask.reason", question=question, reason="; ".join(words.first(reasons, NAMES)))


def _reason(finding: Mapping[str, Any], index: Index) -> str:
    """Why a finding is one, in few words; the sentence stands with its path."""
    taken = index.document["assumptions"].get("taken_by_kind", {}).get(finding["leak"]["kind"])
    exit_ = index.words("ask.reason.sort" if taken == "leak" else "ask.reason.label")
    return brief_reason(finding, index.words, index.data) or exit_


def _first(entries: Sequence[PathEntry], index: Index) -> tuple[tuple[PathEntry, ...], str]:
    shown, left = first_of(entries, LINKS)
    return shown, index.words("more", n=left) if left else ""


def _settled(group: Sequence[PathEntry], index: Index) -> Iterator[SettledLine]:
    for state in SETTLED:
        if entries := [entry for entry in group if entry.state == state]:
            yield SettledLine(index.words(f"state.{state}"), *_first(entries, index))


def _place_facts(findings: Sequence[Mapping[str, Any]], index: Index) -> tuple[list[Fact], list[Gap]]:
    """Who stands behind a place, in which country, on what basis, for how long; and what of it is not stated.

    A place can stand for those of several robots; then a gap names those of which it is not stated.
    """
    leaks = {key(finding["leak"]): finding["leak"] for finding in findings}
    values: dict[str, dict[str, list[Mapping[str, Any]]]] = {}
    for at, leak in leaks.items():
        for what, value in _stated(leak, [finding for finding in findings if key(finding["leak"]) == at], index):
            values.setdefault(what, {}).setdefault(value, []).append(leak)
    facts = [(what, "; ".join(filter(None, every))) for what, every in values.items() if any(every)]
    gaps = [
        (what, list(index.names(every[""])) if len(every) > 1 else []) for what, every in values.items() if "" in every
    ]
    return facts, gaps


def _stated(leak: Mapping[str, Any], findings: Sequence[Mapping[str, Any]], index: Index) -> Iterator[Fact]:
    """What is stated about one place; what is not asked of it, or by a question of its own, is left out."""
    words, row = index.words, index.outside.get(key(leak), {})
    role, transfer = row.get("recipient", ""), row.get("transfer", "")
    recipient = [printable(row["operator"])] if row.get("operator") else []
    recipient += [words.of_value(f"recipient.{role}", role)] if role else []
    keeps = leak["kind"] == STORAGE or key(leak) not in index.outside
    period = retention(row, [finding["category"] for finding in findings], index) if row else ""
    facts: list[tuple[str, str, bool]] = [
        ("recipient", words.row(recipient), True),
        ("country", country(row, index.words), True),
        ("transfer", words.of_value(f"transfer.{transfer}", transfer) if transfer else "", False),
        ("occasional", "", "occasional" in row.get("missing", ())),
        ("contract", fit(row.get("contract", "")), role in ("", *WITH_A_CONTRACT)),
        ("retention", period, keeps),
    ]
    yield from ((what, value) for what, value, asked in facts if value or asked)
