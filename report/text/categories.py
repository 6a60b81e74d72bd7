"""What the ontology knows -> text: the categories as a tree, all about one of them, and the law with its dates.

In: a vocabulary, or provisions, and a language. Out: lines of plain text; no verdict of law. What comes from
the ontology is in that language where it has a translation, else in English.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import shown
from rosprivacy.analysis.model import ARTICLE_10
from rosprivacy.analysis.text import blanked
from rosprivacy.ontology.iris import as_published
from rosprivacy.ontology.provisions import MONTHS, is_old

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rosprivacy.analysis.model import Category, Legal
    from rosprivacy.ontology.provisions import Provision
    from rosprivacy.ontology.vocabulary import Vocabulary

ADEQUACY = "Adequacy decisions (GDPR Art. 45)"
UNCONFIRMED = (
    "amendment adopted {date}; that the Official Journal has it is not confirmed; look whether it was published"
)
POINTER = "a pointer, not confirmed by us: all that we know of it is what others write; look the law up"
WORDS = {
    "en": {
        "definition": "Definition", "names": "Also", "broader": "Broader", "narrower": "Narrower",
        "label": "Neo4j label", "data": "Data types", "factors": "Identity factors",
        "gdpr": "GDPR", "article9": "Article 9(1)",
        "article10": "Article 10", "law": "Law", "because": "because", "source": "source",
        "stated": "stated for", "as of": "law as of", "same": "Same as",
        "within": "Part of",
        "note": "Note", "above": "see above", "iri": "IRI",
        "always": "always", "conditional": "on a condition", "may-reveal": "may reveal it", "no": "no",
        "unknown": "not known",
    },
    "de": {
        "definition": "Definition", "names": "Auch", "broader": "Weiter", "narrower": "Enger", "label": "Neo4j-Label",
        "data": "Datentypen", "factors": "Identitätsmerkmale", "gdpr": "DSGVO", "article9": "Artikel 9 Absatz 1",
        "article10": "Artikel 10", "law": "Recht", "because": "denn", "source": "Quelle",
        "stated": "angegeben für", "as of": "Rechtsstand", "same": "Dasselbe wie",
        "within": "Teil von", "note": "Hinweis", "above": "siehe oben", "iri": "IRI",
        "always": "immer", "conditional": "unter einer Bedingung",
        "may-reveal": "kann besondere Kategorien erkennen lassen", "no": "nein", "unknown": "nicht bekannt",
    },
    "fr": {
        "definition": "Définition", "names": "Aussi", "broader": "Plus large", "narrower": "Plus étroit",
        "label": "Label Neo4j", "data": "Types de données", "factors": "Éléments d'identité", "gdpr": "RGPD",
        "article9": "article 9, paragraphe 1",
        "article10": "article 10", "law": "Droit", "because": "car", "source": "source", "stated": "indiqué pour",
        "as of": "état du droit", "same": "Identique à", "within": "Partie de", "note": "Remarque",
        "above": "voir plus haut", "iri": "IRI",
        "always": "toujours", "conditional": "sous condition", "may-reveal": "peut les révéler", "no": "non",
        "unknown": "inconnu",
    },
}  # fmt: skip


def tree(vocabulary: Vocabulary, top: str, language: str = "en") -> str:
    """Return a category with all narrower ones, each with its name, its title, identity factors, and Article 9(1).

    A category below two others is shown below both, with what is narrower only once.
    """
    below: dict[str, list[str]] = {name: [] for name in vocabulary.categories}
    for name, category in vocabulary.categories.items():
        for up in category.broader:
            below[up].append(name)
    done: set[str] = set()

    def lines(name: str, first: str, rest: str) -> Iterator[str]:
        again = name in done and below[name]
        done.add(name)
        yield first + _entry(vocabulary.categories[name], language, repeated=bool(again))
        children = [] if again else sorted(below[name])
        for number, child in enumerate(children, 1):
            last = number == len(children)
            yield from lines(child, rest + ("└── " if last else "├── "), rest + ("    " if last else "│   "))

    return "".join(f"{line}\n" for line in lines(top, "", ""))


def _entry(category: Category, language: str, *, repeated: bool) -> str:
    words = WORDS[language]
    verdicts = [(words["article9"], category.article9)] if category.article9 != "no" else []
    verdicts += [(words["article10"], legal.verdict) for legal in category.law if legal.name == ARTICLE_10]
    factors = f"  [{', '.join(category.identity_factors)}]" if category.identity_factors else ""
    notes = factors + "".join(f"  [{article}: {words[verdict]}]" for article, verdict in verdicts)
    return f"{category.name}  {shown(category.text('title', language))}{notes}" + (
        f"  ({words['above']})" if repeated else ""
    )


def details(vocabulary: Vocabulary, category: Category, language: str = "en") -> str:
    """Return all that the ontology says of a category."""
    words = WORDS[language]
    narrower = [other.name for other in vocabulary.categories.values() if category.name in other.broader]
    reason = category.text("reason", language)
    rows = [
        ("", f"{category.name}: {category.text('title', language)}"),
        ("definition", category.text("definition", language)),
        ("names", ", ".join(category.synonyms)),
        ("broader", ", ".join(vocabulary.hierarchy.broader(category.name))),
        ("narrower", ", ".join(narrower)),
        ("article9", words[category.article9] + (f", {words['because']} {reason}" if reason else "")),
        *(("law", _legal(legal, category, language)) for legal in category.law),
        ("gdpr", category.text("gdpr", language)),
        ("data", ", ".join(category.data_types)),
        ("factors", ", ".join(category.identity_factors)),
        ("label", category.label),
        ("iri", as_published(category.iri)),
        ("same", ", ".join(category.same_as)),
        ("within", ", ".join(category.within)),
        ("note", category.note),
    ]
    width = max(len(words[key]) for key, value in rows if key and value) + 2
    return "".join(
        f"{words[key] + ':':<{width}}{blanked(value)}\n" if key else f"{blanked(value)}\n"
        for key, value in rows
        if value
    )


def _legal(legal: Legal, category: Category, language: str) -> str:
    words = WORDS[language]
    condition = legal.text("condition", language)
    parts = [
        f"{legal.text('name', language)}, {words[legal.verdict]}" + (f": {condition}" if condition else ""),
        *([f"{words['stated']} {legal.stated_of}"] if legal.stated_of not in ("", category.name) else []),
        *([f"{words['source']} {_sources(legal, language)}"] if legal.sources else []),
        f"{words['as of']} {legal.as_of}",
    ]
    return "; ".join(parts)


def _sources(legal: Legal, language: str) -> str:
    return legal.translations.get(language, {}).get("sources") or ", ".join(legal.sources)


def law_lines(provisions: Sequence[Provision], countries: str) -> Iterator[str]:
    """Yield what is known, each with its date; no legal advice."""
    yield "Only these are known, in words of the program; what counts is the law itself."
    yield "'reviewed' is the day on which the entry was last looked at, not a day on which the law was read in force."
    for provision in provisions:
        where = f"  {provision.address}" if provision.address else ""
        yield f"{provision.name}: {provision.title} (reviewed {provision.as_of}){where}"
        yield f"   {provision.meaning}"
        if not provision.confirmed:
            yield f"   {_unconfirmed(provision)}"
    yield f"{ADEQUACY}: reviewed {countries}"


def unconfirmed_lines(provisions: Sequence[Provision]) -> list[str]:
    """Return what rests on law that we did not find published."""
    return [f"{provision.name}: {_unconfirmed(provision)}" for provision in provisions if not provision.confirmed]


def _unconfirmed(provision: Provision) -> str:
    return UNCONFIRMED.format(date=provision.adopted) if provision.adopted else POINTER


def old_lines(provisions: Sequence[Provision], countries: str, today: str) -> list[str]:
    """Return what was last looked at more than six months before today."""
    dated = [*((provision.name, provision.as_of) for provision in provisions), (ADEQUACY, countries)]
    return [
        f"{name}: reviewed {as_of}, more than {MONTHS} months ago; look whether it still holds"
        for name, as_of in dated
        if is_old(as_of, today)
    ]
