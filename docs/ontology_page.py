"""The page of our ontology: every term with an anchor, in English, German and French, from the Turtle files alone.

In: Turtle. Out: Markdown, the same bytes for the same files. The page is made with the site (``site_pages.py``) and
nothing of it is committed, so that it cannot say anything else than the files. ``https://w3id.org/rosprivacy`` can lead
to it: ``#Video`` is the anchor of ``rp:Video``.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from rdflib import DCTERMS, RDF, RDFS, SKOS, BNode, Graph, Literal, Namespace, URIRef

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rdflib.term import Node

DOCS = Path(__file__).resolve().parent
TEMPLATE, WORDS = "ontology.md.j2", "linked-data.md"
FILES = ("categories.ttl", "law.ttl", "other_law.ttl", "contexts.ttl", "persons.ttl", "elements.ttl")
RP = Namespace("https://w3id.org/rosprivacy#")
LANGUAGES = ("en", "de", "fr")
NAMES = (SKOS.prefLabel, DCTERMS.title)
GROUPS = (
    ("Kinds of personal data", (SKOS.Concept,)),
    ("Provisions", (RP.LegalProvision,)),
    ("Contexts", (RP.Context, RP.Sharpening, RP.Situation)),
    ("Groups of persons", (RP.PersonGroup,)),
    ("Roles, elements and findings", (RDFS.Class, RP.PossibleActivity)),
    ("Methods, data types, identity factors, verdicts", (RP.Method, RP.DataType, RP.IdentityFactor, RP.Verdict)),
    ("Further terms", ()),
)
# What is told first of a term, and in which words; any other property follows under its own name.
PROPERTIES = {
    SKOS.prefLabel: "name", DCTERMS.title: "title", SKOS.definition: "definition", SKOS.altLabel: "also called",
    SKOS.note: "note", SKOS.broader: "broader", SKOS.exactMatch: "the same in DPV",
    SKOS.closeMatch: "nearly the same in DPV", SKOS.broadMatch: "broader in DPV", SKOS.relatedMatch: "related in DPV",
    RP.dataType: "data types", RP.identityFactor: "identity factors", RP.gdprCategory: "defined by",
    RP.fallsUnder: "falls under", RP.article9: "under Article 9(1)", RP.provision: "provision", RP.verdict: "verdict",
    RP.condition: "when", RP.reason: "why", RP.source: "source", RP.inContext: "in a context", RP.context: "context",
    RP.lookAt: "to look at", DCTERMS.bibliographicCitation: "cited as", RDFS.seeAlso: "address", RP.partOf: "part of",
    RP.asOf: "last looked at", RP.appliesFrom: "applies from", RP.confirmed: "confirmed", RP.adopted: "adopted",
}  # fmt: skip
BACK = {SKOS.broader: "narrower", RP.partOf: "parts", RP.provision: "said of"}
COMMENT = re.compile(r"^# (rp:\w+)(?: \"\w+\")? {2,}(.+(?:\n# {5,}.+)*)", re.MULTILINE)


class Value(NamedTuple):
    """A value as it is shown: a text with its language, a link, or the rows of what has no name."""

    text: str
    language: str = ""
    link: str = ""
    rows: tuple[tuple[str, list[Value]], ...] = ()


def ontology_page() -> str:
    """Return the page of the shipped files."""
    texts = [(DOCS.parent / "ontology" / name).read_text("utf-8") for name in FILES]
    return page(texts, (DOCS / WORDS).read_text("utf-8"))


def page(turtle: Iterable[str], linked_data: str) -> str:
    """Return the page of Turtle texts, and of the words of exported files that another page explains."""
    graph, properties = Graph(), dict[str, str]()
    for text in turtle:
        graph.parse(data=text, format="turtle")
        properties = {
            name: " ".join(said.replace("\n#", " ").split()) for name, said in COMMENT.findall(text)
        } | properties
    terms = {one for one in graph.subjects() if isinstance(one, URIRef) and one.startswith(RP)}
    groups, left = [], set(terms)
    for title, kinds in GROUPS:
        ours = {one for one in left if not kinds or one in kinds or {*graph.objects(one, RDF.type)} & {*kinds}}
        groups.append((title, [_term(graph, one, terms) for one in sorted(ours, key=lambda one: _order(graph, one))]))
        left -= ours
    loader = FileSystemLoader(DOCS)
    template = Environment(
        loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=StrictUndefined
    )
    words = _own_words(_members(graph, terms) | properties, linked_data.split("## Our own words")[1])
    words = _anchored(words, {str(one).removeprefix(RP) for one in terms})
    return template.get_template(TEMPLATE).render(groups=[group for group in groups if group[1]], words=words)


def _term(graph: Graph, term: URIRef, terms: set[URIRef]) -> tuple[str, str, list[tuple[str, list[Value]]]]:
    """What a term is called in its IRI and in English, and the rows about it."""
    back = [(said, list(_back(graph, term, by, terms))) for by, said in BACK.items()]
    rows = [*_rows(graph, term, terms), *((said, sorted(values)) for said, values in back if values)]
    return term.removeprefix(RP), _name(graph, term), rows


def _back(graph: Graph, term: URIRef, by: Node, terms: set[URIRef]) -> Iterator[Value]:
    """Which terms point at a term, also from within a statement of theirs."""
    pointing = {parent for one in graph.subjects(by, term) for parent in (one, *graph.subjects(None, one))}
    yield from (_value(graph, one, terms) for one in pointing if one in terms)


def _rows(graph: Graph, subject: Node, terms: set[URIRef]) -> Iterator[tuple[str, list[Value]]]:
    order: list[Node] = list(PROPERTIES)
    known = set(graph.predicates(subject)) - {SKOS.inScheme}
    for predicate in sorted(known, key=lambda one: (order.index(one) if one in order else len(order), str(one))):
        values = [_value(graph, value, terms) for value in graph.objects(subject, predicate)]
        shown = PROPERTIES.get(predicate) or _short(graph, predicate)  # type: ignore[call-overload]
        yield shown, sorted(values, key=_by_language)


def _value(graph: Graph, value: Node, terms: set[URIRef]) -> Value:
    if isinstance(value, BNode):
        return Value("", rows=tuple(_rows(graph, value, terms)))
    if isinstance(value, Literal):
        return Value(str(value), value.language or "")
    if value in terms:
        return Value(_name(graph, value), link=f"#{str(value).removeprefix(RP)}")
    return Value(str(value) if "eur-lex" in str(value) else _short(graph, value), link=str(value))


def _by_language(value: Value) -> tuple[object, ...]:
    return (LANGUAGES.index(value.language) if value.language in LANGUAGES else -1, value.text, str(value.rows))


def _short(graph: Graph, iri: Node) -> str:
    return iri.n3(graph.namespace_manager)


def _name(graph: Graph, term: Node) -> str:
    """The English name; of a provision its identifier."""
    identifier = graph.value(term, RP.identifier)
    names = [str(one) for by in NAMES for one in graph.objects(term, by) if getattr(one, "language", "") == "en"]
    return str(identifier or min(names, default=str(term).removeprefix(RP)))


def _order(graph: Graph, term: Node) -> tuple[object, ...]:
    """By name, numbers as numbers: Article 9 before Article 10."""
    parts = re.split(r"(\d+)", _name(graph, term).casefold())
    return tuple((int(part) if part.isdigit() else 0, part) for part in parts), str(term)


def _members(graph: Graph, terms: set[URIRef]) -> dict[str, str]:
    """Classes of ours -> what is in them; their meaning stands with their members."""
    found: dict[str, str] = {}
    for kind in {str(kind) for kind in graph.objects(None, RDF.type) if str(kind).startswith(RP)}:
        members = sorted(terms & {*graph.subjects(RDF.type, URIRef(kind))})
        linked = (f"[{_name(graph, one)}](#{one.removeprefix(RP)})" for one in members)
        found[f"rp:{kind.removeprefix(RP)}"] = f"a class: {', '.join(linked)}"
    return found


def _own_words(told: dict[str, str], exported: str) -> str:
    """What the files explain at their beginning, classes with their members, and the table of exported files."""
    rows = {name: re.sub(r"\b(?:rp|skos|dpv):\w+", r"`\g<0>`", said) for name, said in told.items()}
    written = "".join(
        f"| `{name}` | {said} |\n" for name, said in sorted(rows.items()) if f"| `{name}`" not in exported
    )
    return f"| term | meaning |\n| --- | --- |\n{written}\n{exported.strip()}\n"


def _anchored(text: str, taken: set[str]) -> str:
    """Put an anchor where a word of ours is named first, if it has none."""

    def anchor(word: re.Match[str]) -> str:
        if word[1] in taken:
            return word[0]
        taken.add(word[1])
        return f'<span id="{word[1]}"></span>{word[0]}'

    return re.sub(r"`rp:(\w+)`", anchor, text)
