"""Turtle -> the categories, how they are found by name, and their hierarchy (rule S7).

In: ``categories.ttl`` and ``law.ttl``, read by rdflib. Out: a ``Vocabulary``. What was read is kept in the user's cache
folder under the hash of the files, so that rdflib is imported only after a change; the cache may be deleted at any
time, and a damaged one is not used.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import tempfile
from contextlib import suppress
from dataclasses import asdict, dataclass
from difflib import get_close_matches
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.errors import InputErrors, OntologyError
from rosprivacy.analysis.hierarchy import Hierarchy
from rosprivacy.analysis.model import Category, Legal

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from rdflib import Graph
    from rdflib.term import Node

TOP = "PersonalData"
NAMESPACE = "urn:x-rosprivacy:"
SHIPPED = ("categories.ttl", "law.ttl")
CACHE_FORMAT = 3
_IDENTIFIER = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


@dataclass(frozen=True, slots=True)
class Vocabulary:
    """The categories of an ontology.

    Attributes
    ----------
    categories
        By name, sorted.
    hierarchy
        Closed over ``skos:broader``.
    """

    categories: Mapping[str, Category]
    hierarchy: Hierarchy

    @classmethod
    def of(cls, categories: Iterable[Category]) -> Vocabulary:
        """Put categories together."""
        by_name = {category.name: category for category in sorted(categories, key=lambda c: c.name)}
        return cls(by_name, Hierarchy.of(by_name.values()))

    def find(self, text: str) -> Category | None:
        """Return the category of that name, IRI, label, title or synonym; upper and lower case count alike.

        >>> load().find("face embedding").name
        'FaceTemplate'
        """
        if text in self.categories:
            return self.categories[text]
        wanted = text.casefold()
        for category in self.categories.values():
            names = (category.name, category.iri, category.label, category.title, *category.synonyms)
            if wanted in {name.casefold() for name in names}:
                return category
        return None

    def nearest(self, text: str) -> list[str]:
        """Return up to three names of categories that look like the text, or all names if none does.

        >>> load().nearest("Biometrik")
        ['Biometric']
        """
        by_spelling = {
            spelling.casefold(): category.name
            for category in self.categories.values()
            for spelling in (*category.synonyms, category.title, category.name)
        }
        close = get_close_matches(text.casefold(), by_spelling, n=3, cutoff=0.6)
        return list(dict.fromkeys(by_spelling[spelling] for spelling in close)) or list(self.categories)

    def with_narrower(self, name: str) -> set[str]:
        """Return a category with all that are kinds of it.

        >>> sorted(load().with_narrower("Biometric"))
        ['Biometric', 'FaceTemplate', 'VoicePrint']
        """
        return {other for other, above in self.hierarchy.ancestors.items() if name in above}


def load(cache: Path | None = None) -> Vocabulary:
    """Read the shipped ontology.

    Parameters
    ----------
    cache
        Folder for what was read; the user's cache folder by default.

    Raises
    ------
    InputErrors
        If the ontology breaks its own rules.
    """
    folder_here = files("rosprivacy.ontology")
    data = b"\n".join(folder_here.joinpath(name).read_bytes() for name in SHIPPED)
    key = hashlib.sha256(data).hexdigest()
    folder = cache or _cache_folder()
    path = folder / f"categories-{CACHE_FORMAT}-{key[:16]}.json"
    categories = _cached(path, key)
    if categories is None:
        categories = parse(data.decode(), "categories.ttl")
        _keep(path, key, categories)
    return Vocabulary.of(categories)


def parse(turtle: str, file: str) -> tuple[Category, ...]:
    """Read categories from Turtle: every ``skos:Concept`` with an ``rp:label``.

    Raises
    ------
    InputErrors
        If it is not Turtle, or a category lacks a label, an English name or a definition, or two share a name or a
        label.
    """
    from rdflib import RDF, SKOS, Graph  # noqa: PLC0415 - heavy, and not needed when cached

    graph = Graph()
    try:
        graph.parse(data=turtle, format="turtle")
    except Exception as error:  # noqa: BLE001 - rdflib raises its own and plain exceptions alike
        line = getattr(error, "lines", 0)
        problem = f"not Turtle: {' '.join(str(getattr(error, 'message', error)).split())}"
        raise InputErrors([OntologyError(file, line, problem, "correct the syntax")]) from None
    concepts = set(graph.subjects(RDF.type, SKOS.Concept))
    found = [_category(graph, subject, concepts) for subject in sorted(concepts, key=str)]
    problems = list(_problems(found, file))
    if problems:
        raise InputErrors(problems)
    return tuple(found)


def _category(graph: Graph, subject: Node, concepts: set[Node]) -> Category:
    from rdflib import SKOS, URIRef  # noqa: PLC0415 - as above

    def texts(predicate: Node) -> list[str]:
        values = graph.objects(subject, predicate)
        return sorted(str(value) for value in values if getattr(value, "language", None) in (None, "en"))

    return Category(
        name=_local_name(str(subject)),
        iri=str(subject),
        label="".join(texts(URIRef(f"{NAMESPACE}label"))[:1]),
        title="".join(texts(SKOS.prefLabel)[:1]),
        definition="".join(texts(SKOS.definition)[:1]),
        broader=tuple(sorted(_local_name(str(up)) for up in graph.objects(subject, SKOS.broader) if up in concepts)),
        synonyms=tuple(texts(SKOS.altLabel)),
        law=tuple(_law(graph, subject)),
        same_as=tuple(sorted(str(same) for same in graph.objects(subject, SKOS.exactMatch))),
        within=tuple(sorted(str(up) for up in graph.objects(subject, SKOS.broader) if up not in concepts)),
    )


def _law(graph: Graph, subject: Node) -> Iterable[Legal]:
    """The provisions that a category falls under, by name."""
    from rdflib import SKOS, URIRef  # noqa: PLC0415 - as above

    def text(node: Node | None, predicate: Node) -> str:
        value = graph.value(node, predicate) if node is not None else None
        return "" if value is None else str(value)

    def ours(name: str) -> URIRef:
        return URIRef(f"{NAMESPACE}{name}")

    found = []
    for link in graph.objects(subject, ours("fallsUnder")):
        provision = graph.value(link, ours("provision"))
        found.append(
            Legal(
                iri=str(provision),
                name=text(provision, ours("identifier")),
                meaning=text(provision, SKOS.definition),
                as_of=text(provision, ours("asOf")),
                verdict=text(link, ours("verdict")),
                condition=text(link, ours("condition")),
            )
        )
    return sorted(found, key=lambda legal: legal.name)


def _problems(categories: list[Category], file: str) -> Iterable[OntologyError]:
    names: dict[str, str] = {}
    for category in categories:
        lacks = [what for what in ("title", "definition") if not getattr(category, what)]
        if lacks:
            yield OntologyError(file, 0, f"<{category.iri}> has no {' and no '.join(lacks)}", "add it in English")
        if not _IDENTIFIER.fullmatch(category.label):
            hint = 'write rp:label "Name", letters and digits'
            yield OntologyError(file, 0, f"<{category.iri}> has no label that is an identifier", hint)
        for name in {category.name, category.label}:
            if names.setdefault(name, category.iri) != category.iri:
                yield OntologyError(file, 0, f"{name!r} names both <{names[name]}> and <{category.iri}>", "rename one")


def _local_name(iri: str) -> str:
    return re.split(r"[#/:]", iri)[-1]


def _cache_folder() -> Path:
    from platformdirs import user_cache_path  # noqa: PLC0415 - light start

    return user_cache_path("rosprivacy")


def _digest(categories: Any) -> str:
    return hashlib.sha256(json.dumps(categories, sort_keys=True).encode()).hexdigest()


def _cached(path: Path, key: str) -> tuple[Category, ...] | None:
    """What an earlier run kept, if it is whole and of this file."""
    try:
        kept = json.loads(path.read_text("utf-8"))
        if kept["key"] != key or kept["digest"] != _digest(kept["categories"]):
            return None
        return tuple(
            Category(
                **{
                    **c,
                    "broader": tuple(c["broader"]),
                    "synonyms": tuple(c["synonyms"]),
                    "law": tuple(Legal(**legal) for legal in c["law"]),
                    "same_as": tuple(c["same_as"]),
                    "within": tuple(c["within"]),
                }
            )
            for c in kept["categories"]
        )
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _keep(path: Path, key: str, categories: tuple[Category, ...]) -> None:
    """Write the cache, whole or not at all; a folder that cannot be written is no error."""
    facts = json.loads(json.dumps([asdict(category) for category in categories]))
    with suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile("w", dir=path.parent, delete=False, encoding="utf-8") as file:
            json.dump({"key": key, "digest": _digest(facts), "categories": facts}, file)
        os.replace(file.name, path)  # noqa: PTH105 - atomic on every platform
