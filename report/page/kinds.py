"""The kinds of data of a document: what each is, which provisions to look at, who brings it in, how it stands.

In: an ``Index`` and the entries of the report. Out: one ``KindEntry`` per emitted category: those with the worst
finding first, then the others, in the document's order.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.text import fit, printable
from rosprivacy.ontology.iris import as_published
from rosprivacy.report.catalogs.words import spaced
from rosprivacy.report.finding_facts import grouped
from rosprivacy.report.naming import count_rows, text
from rosprivacy.report.page.index import kind_anchor
from rosprivacy.report.page.look_at import LookAt, context_of, of_kind, unconfirmed_notes

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.report.page.finding_entries import PathEntry
    from rosprivacy.report.page.index import Index
    from rosprivacy.report.page.look_at import FurtherLaw

SIGNS = "†‡§¶"  # of notes
NARROWER = "⊇ "  # how the ontology writes, in other languages than English: if the data are of one of these kinds


class ProvisionText(NamedTuple):
    """One provision to look at: that data of the kind can be what it speaks of.

    Attributes
    ----------
    verdict
        ``always``, ``conditional`` or ``may-reveal``.
    stated
        The kind that the ontology says it of, if it is another.
    """

    name: str
    verdict: str
    condition: str
    meaning: str
    sources: str
    stated: str
    as_of: str


class ProvisionOnce(NamedTuple):
    """A provision that kinds of data, contexts or every system call for, told once.

    Attributes
    ----------
    dates
        When we read it, where that is not when most of the list was read; from when on it applies.
    unconfirmed
        That a change of it is not confirmed; empty if it is.
    contexts
        (why it is to be looked at in a context, of which kinds of data).
    at_kinds
        Whether kinds of data point at it: then its title and its dates stand there.
    narrower
        Whether it is a part of another of the list, of which kinds of data say when it applies.
    """

    name: str
    title: str
    meaning: str
    dates: str
    unconfirmed: str
    contexts: tuple[tuple[str, str], ...]
    at_kinds: bool
    narrower: bool


class ProvisionGroup(NamedTuple):
    """Provisions that the same contexts or every system call for; ``callers`` is empty where only kinds of data do."""

    callers: str
    provisions: tuple[ProvisionOnce, ...]


class ProvisionList(NamedTuple):
    """What the provisions of a report say, each once.

    Attributes
    ----------
    reviewed
        When most of them were read.
    unconfirmed
        What is said of those of which a change is not confirmed: notes, each once.
    """

    reviewed: str
    groups: tuple[ProvisionGroup, ...]
    unconfirmed: tuple[str, ...]

    def mark(self, note: str) -> str:
        """Return the sign of a note, which stands after the name of a provision; empty for no note."""
        return SIGNS[self.unconfirmed.index(note) % len(SIGNS)] if note else ""


class KindEntry(NamedTuple):
    """One kind of data.

    Attributes
    ----------
    factors
        What of a person's identity it tells of, by Article 4(1).
    reason
        Why it is no special category by itself, where the ontology says so.
    origins
        Who brings it in, or makes it: (name, of what it makes it, empty if it brings it in).
    places
        Names that it can reach by a path that is to be assessed or accepted.
    open
        How many elements that it gets to are not reviewed.
    in_context
        (what a context is called, what such data may reveal there).
    look_at
        Further provisions to look at; the title of each stands at the first kind that points at it.
    """

    name: str
    title: str
    iri: str
    definition: str
    types: tuple[str, ...]
    factors: tuple[str, ...]
    gdpr: str
    article9: str
    reason: str
    law: tuple[ProvisionText, ...]
    origins: tuple[tuple[str, str], ...]
    entries: tuple[PathEntry, ...]
    places: tuple[str, ...]
    open: int
    in_context: tuple[tuple[str, ProvisionText], ...]
    look_at: tuple[LookAt, ...]

    @property
    def anchor(self) -> str:
        """Where it stands in a page."""
        return kind_anchor(self.name)

    @property
    def law_anchor(self) -> str:
        """Where a page has what the law says of it."""
        return f"law-{self.anchor}"

    @property
    def shared(self) -> dict[str, tuple[PathEntry, ...]]:
        """Notes that several entries have -> these; each stands once, before them."""
        return {note: tuple(entries) for note, entries in entries_of(self.entries).items() if len(entries) > 1}

    @property
    def detailed(self) -> tuple[PathEntry, ...]:
        """The entries that are told one by one."""
        return tuple(entry for entry in self.entries if entry.detailed)

    @property
    def not_detailed(self) -> int:
        """How many others there are."""
        return sum(not entry.detailed for entry in self.entries)

    @property
    def to_assess(self) -> int:
        """How many entries are to be assessed."""
        return sum(entry.state in ("open", "decided") for entry in self.entries)


def entries_of(entries: Iterable[PathEntry]) -> dict[str, list[PathEntry]]:
    """Return the notes of entries that are told one by one -> those that have them."""
    of: dict[str, list[PathEntry]] = {}
    for entry in entries:
        for note in entry.notes if entry.detailed else ():
            of.setdefault(note, []).append(entry)
    return of


def kinds(index: Index, entries: Iterable[PathEntry]) -> tuple[KindEntry, ...]:
    """Return the kinds of data."""
    by_category: dict[str, list[PathEntry]] = {}
    for entry in entries:
        by_category.setdefault(entry.category, []).append(entry)
    made = [
        _kind(category, index, tuple(by_category.get(category["name"], ())))
        for category in index.document["categories"]
    ]
    made.sort(key=lambda kind: kind.entries[0].number if kind.entries else len(index.findings) + 1)
    first = {look: kind.name for kind in reversed(made) for look in kind.look_at}
    return tuple(
        kind._replace(
            look_at=tuple(look if first[look] == kind.name else look._replace(title="") for look in kind.look_at)
        )
        for kind in made
    )


def _kind(category: Mapping[str, Any], index: Index, entries: tuple[PathEntry, ...]) -> KindEntry:
    language, of = index.words.language, category["name"]
    reached = [finding["leak"] for finding in index.findings if finding["category"] == of and not finding["dismissed"]]
    return KindEntry(
        name=fit(of),
        title=index.data(of),
        iri=fit(as_published(category["iri"])),
        definition=text(category, "definition", language),
        types=tuple(index.words.of_value(f"type.{kind}", fit(kind)) for kind in category["data_types"]),
        factors=tuple(
            index.words.of_value(f"factor.{factor}", fit(factor)) for factor in category.get("identity_factors", ())
        ),
        gdpr=text(category, "gdpr", language),
        article9=category["article9"],
        reason=text(category, "reason", language),
        law=tuple(provision(legal, of, index) for legal in category["law"]),
        origins=tuple(_origins(of, index)),
        entries=entries,
        places=index.names(reached),
        open=count_rows(q for q in index.document["open"] if of in q["categories"]).elements,
        in_context=tuple(
            (context_of(legal["context"], index), provision(legal, of, index))
            for legal in category.get("in_context", ())
        ),
        look_at=of_kind(of, index),
    )


def provisions(entries: Iterable[KindEntry], further: FurtherLaw, index: Index) -> ProvisionList:
    """Return what the provisions say, each once: those of kinds of data, of every system, of contexts; by name."""
    kinds = tuple(entries)
    at_kinds = {look._replace(title=""): look.title for kind in reversed(kinds) for look in kind.look_at}
    elsewhere = {look._replace(title=""): look.title for _, several in further.provisions for look in several}
    titles = {**elsewhere, **at_kinds}  # the first kind that points at one has its title
    contexts: dict[LookAt, dict[str, list[str]]] = {}
    for kind in kinds:
        for context, law in kind.in_context:
            contexts.setdefault(_looked_at(law), {}).setdefault(_why(context, law, index), []).append(kind.title)
    borne = {_looked_at(law) for kind in kinds for law in kind.law}
    called: dict[LookAt, list[str]] = {look: [] for look in (*at_kinds, *borne)}
    for caller, several in further.provisions:
        for look in several:
            called.setdefault(look._replace(title=""), []).append(caller)
    looks = sorted({**called, **contexts})
    usual = Counter(look.reviewed for look in looks).most_common(1)[0][0] if looks else ""

    def provision_row(look: LookAt) -> ProvisionOnce:
        why = tuple((reason, index.words.row(of)) for reason, of in contexts.get(look, {}).items())
        dates, title = look.dates_but(usual), titles.get(look, "")
        narrower = not why and look in borne and any(look.name.startswith(f"{other.name} ") for other in borne)
        return ProvisionOnce(look.name, title, look.meaning, dates, look.unconfirmed, why, look in at_kinds, narrower)

    groups = (
        ProvisionGroup("; ".join(called.get(some[0], ())), tuple(map(provision_row, some)))
        for some in grouped(looks, lambda look: tuple(called.get(look, ())))
    )
    return ProvisionList(
        usual,
        tuple(sorted(groups, key=lambda group: group.callers != "")),
        unconfirmed_notes(looks),
    )


def _looked_at(law: ProvisionText) -> LookAt:
    return LookAt(law.name, "", law.meaning, law.as_of, "", "")


def _why(context: str, law: ProvisionText, index: Index) -> str:
    """Why a provision is to be looked at in a context."""
    words = index.words
    why = words.pair(words(f"law.context.{law.verdict}", context=context), law.condition)
    return f"{why}. {words.pair(words('law.sources'), law.sources)}" if law.sources else why


def provision(legal: Mapping[str, Any], of: str, index: Index) -> ProvisionText:
    """Return a provision in words."""
    language = index.words.language
    name, condition = text(legal, "provision", language), text(legal, "condition", language)
    if condition.startswith(NARROWER):
        condition = index.words("law.narrower", kinds=condition.removeprefix(NARROWER))
    translated = legal["translations"].get(language, {}).get("sources") if legal["sources"] else ""
    sources = "; ".join(cited for cited in (translated or "; ".join(legal["sources"])).split("; ") if cited != name)
    return ProvisionText(
        name=name,
        verdict=legal["verdict"],
        condition=condition,
        meaning=text(legal, "meaning", language),
        sources=spaced(printable(_sources(sources)), language) if sources else "",
        stated="" if legal["stated_of"] in ("", of) else _stated(legal["stated_of"], index),
        as_of=index.words.date(legal["as_of"]),
    )


def _sources(texts: str) -> str:
    """Sources in a row; of several places in one, its name once.

    >>> _sources("Guidelines 3/2019 par. 63; Guidelines 3/2019 par. 65; Recital 51")
    'Guidelines 3/2019 par. 63, 65; Recital 51'
    """
    cited = [tuple(source.rpartition(" ")[::2]) for source in texts.split("; ")]
    same = grouped(cited, lambda of: of[0] if of[1].isdecimal() else of)
    return "; ".join(" ".join(filter(None, (some[0][0], ", ".join(place for _, place in some)))) for some in same)


def _stated(names: str, index: Index) -> str:
    return index.all_data(names.split(", "))


def _origins(category: str, index: Index) -> Iterator[tuple[str, str]]:
    sources = index.of_role.get("source", {}).items()
    for name in index.names([index.elements[e] for e, categories in sources if category in categories]):
        yield name, ""
    made = [row for row in index.document["derivations"] if row["to"] == category and row["reached"]]
    for of in dict.fromkeys(row["from"] for row in made):
        said = index.words("made.by", data=index.data(of))
        for name in index.names([row["element"] for row in made if row["from"] == of]):
            yield name, said
