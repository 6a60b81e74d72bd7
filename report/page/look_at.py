"""Law that is pointed at beside what is followed into paths, and what data may reveal in a context, in words.

In: an ``Index``. Out: rows for the law box of a kind, for an entry, for the list at the end of the paths. No verdict.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from rosprivacy.analysis.model import MAY_REVEAL
from rosprivacy.analysis.text import fit
from rosprivacy.report.finding_facts import of_every_system
from rosprivacy.report.naming import text

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from rosprivacy.report.page.index import Index

WORKPLACE = "workplace"  # the context
ABOUT_WORK = ("AI Act", "GDPR Art. 88", "GDPR Art. 22", "BDSG § 26", "BetrVG", "Labour code")


class LookAt(NamedTuple):
    """One provision to look at.

    Attributes
    ----------
    title
        What it is about; empty where that stands elsewhere.
    reviewed
        When we read it.
    applies, unconfirmed
        From when on it applies; that a change of it is not confirmed; empty if nothing is to be told.
    """

    name: str
    title: str
    meaning: str
    reviewed: str
    applies: str
    unconfirmed: str

    def dates_but(self, usual: str) -> str:
        """When it was read, if not as most provisions, and from when on it applies."""
        return "; ".join(date for date in (self.reviewed, self.applies) if date not in ("", usual))


def unconfirmed_notes(provisions: Iterable[LookAt]) -> tuple[str, ...]:
    """Return what is not confirmed of some provisions, each note once, sorted.

    >>> changed = LookAt("AI Act Art. 27", "", "", "2026-11-22", "", "amendment not confirmed")
    >>> unconfirmed_notes([changed, changed._replace(unconfirmed="")])
    ('amendment not confirmed',)
    """
    return tuple(sorted({provision.unconfirmed for provision in provisions} - {""}))


class FurtherLaw(NamedTuple):
    """Provisions beside those that say something of a path.

    Attributes
    ----------
    provisions
        What contexts and every system point at: (who calls for it, provisions).
    contexts
        Names of those that are stated.
    at_work
        What a works council has to look at.
    national
        Whose national law is to be looked at.
    """

    provisions: tuple[tuple[str, tuple[LookAt, ...]], ...]
    contexts: tuple[str, ...]
    at_work: tuple[LookAt, ...]
    national: tuple[str, ...]


def further_law(index: Index) -> FurtherLaw:
    """Return the provisions to look at beside those of paths and kinds of data."""
    contexts = tuple(context["name"] for context in index.document.get("contexts", ()))
    return FurtherLaw(further(index), contexts, at_work(index), national(index))


def of_kind(category: str, index: Index) -> tuple[LookAt, ...]:
    """Return the provisions that a kind of data points at."""
    return tuple(_provision_text((row for row in index.looked_at if category in row["categories"]), index))


def further(index: Index) -> tuple[tuple[str, tuple[LookAt, ...]], ...]:
    """Return what contexts and every system point at: (who calls for it, provisions)."""
    rows, words = index.looked_at, index.words
    found = [(words("look.system"), tuple(_provision_text(of_every_system(rows), index)))]
    for context in index.document.get("contexts", ()):
        called = (row for row in rows if context["name"] in row["contexts"])
        heading = words("look.context", context=text(context, "title", words.language))
        found.append((heading, tuple(_provision_text(called, index))))
    return tuple((heading, several) for heading, several in found if several)


def at_work(index: Index) -> tuple[LookAt, ...]:
    """Return what a works council has to look at: of the provisions of the register those that are about work."""
    called = {name for row in index.register for name in row["look_at"]}

    def is_about_work(row: Mapping[str, Any]) -> bool:
        return row["provision"] in called and (WORKPLACE in row["contexts"] or row["provision"].startswith(ABOUT_WORK))

    return tuple(_provision_text(filter(is_about_work, index.looked_at), index))


def national(index: Index) -> tuple[str, ...]:
    """Return whose national law is to be looked at, and how much of it is known here; never that of the language."""
    words = index.words
    countries = sorted({country for row in index.register for country in row["countries"]})
    countries_known = sorted({row["country"] for row in index.document.get("look_at", ()) if row["country"]})
    known = words.row(countries_known)
    told = [
        words(f"look.national.{'some' if one in countries_known else 'none'}", country=one, known=known)
        for one in countries
    ]
    return tuple(told) or (words("look.national.unstated", known=known),)


def context_of(name: str, index: Index) -> str:
    """Return what a context is called."""
    known = (one for one in index.document.get("contexts", ()) if one["name"] == name)
    return next((text(one, "title", index.words.language) for one in known), fit(name))


def revealed(finding: Mapping[str, Any], index: Index) -> Iterator[str]:
    """Yield what the data of a finding may reveal where they are brought in: context and provision.

    Why, and what only concerns such data there, is said once, where the provision is.
    """
    of_category = {
        (row["context"], row["provision"], row["condition"]): row
        for row in index.categories[finding["category"]].get("in_context", ())
    }
    for said in finding.get("in_context", ()):
        row = of_category.get((said["context"], said["provision"], said["condition"]))
        if row and said["verdict"] == MAY_REVEAL:
            language = index.words.language
            yield index.words(
                "entry.context.may-reveal",
                context=context_of(said["context"], index),
                provision=text(row, "provision", language),
            )


def _provision_text(rows: Iterable[Mapping[str, Any]], index: Index) -> Iterator[LookAt]:
    words, language = index.words, index.words.language
    for row in rows:
        reviewed = words.date(row["as_of"])
        applies = words("look.applies", date=words.date(row["applies_from"])) if row["applies_from"] else ""
        unconfirmed = ""
        if not row.get("confirmed", True):
            adopted = row["adopted"]
            unconfirmed = words("look.unconfirmed", date=words.date(adopted)) if adopted else words("look.pointer")
        provision, title, meaning = (text(row, what, language) for what in ("provision", "title", "meaning"))
        yield LookAt(provision, title, meaning, reviewed, applies, unconfirmed)
