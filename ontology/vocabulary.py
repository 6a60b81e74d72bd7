"""The categories, how they are found by name, and their hierarchy (rule S7).

In: the shipped Turtle files (all but the shapes) and users' own files. Out: a ``Vocabulary``. What was read is kept
under the hash of all files (``cache.py``), so that rdflib is imported only after a change.
"""

from __future__ import annotations

import hashlib
from functools import lru_cache, wraps
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Concatenate, NamedTuple, ParamSpec, TypeVar

from rosprivacy.analysis.contexts import surrounded
from rosprivacy.analysis.errors import InputErrors, OntologyError, reason
from rosprivacy.analysis.files_read import noted
from rosprivacy.analysis.hierarchy import Hierarchy
from rosprivacy.analysis.installing import command_for
from rosprivacy.analysis.legal import close
from rosprivacy.analysis.written_names import FEW, did_you_mean, nearest
from rosprivacy.ontology import cache as kept
from rosprivacy.ontology.iris import STORED, as_stored
from rosprivacy.ontology.pointed import Pointed

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence

    from rosprivacy.analysis.model import Category
    from rosprivacy.ontology.known import Known

FOLDER = Path(__file__).parent  # what is shipped; importlib.resources would be imported for nothing else
LARGEST = 4 * 2**20  # bytes of a user's file
REMEMBERED = 8  # vocabularies that are remembered, and what was made for them: of a program that asks many times
P = ParamSpec("P")
T = TypeVar("T")
CHECKER = "pyshacl"  # an extra, for ontologies of users; what it has passed is in the cache
TOP = "PersonalData"
SHIPPED = ("categories.ttl", "law.ttl", "other_law.ttl", "contexts.ttl", "persons.ttl", "elements.ttl", "dpv.ttl")
PREFIXES = {
    "rp:": STORED,
    "dpv:": "https://w3id.org/dpv#",
    "pd:": "https://w3id.org/dpv/pd#",
    "eu-gdpr:": "https://w3id.org/dpv/legal/eu/gdpr#",
}


class Vocabulary(NamedTuple):
    """The categories of an ontology.

    Attributes
    ----------
    categories
        By name, sorted, each with the law that follows for it.
    hierarchy
        Closed over ``skos:broader``.
    respelt
        Former spellings of DPV terms -> IRIs of today.
    sources
        (file, SHA-256) of users' own ontologies.
    pointed
        Law to look at beside what is followed, and the contexts and groups of persons that point at it.
    """

    categories: Mapping[str, Category]
    hierarchy: Hierarchy
    respelt: Mapping[str, str] = {}
    sources: tuple[tuple[str, str], ...] = ()
    pointed: Pointed = Pointed()

    @classmethod
    def of(
        cls,
        categories: Iterable[Category],
        respelt: Mapping[str, str] | None = None,
        sources: tuple[tuple[str, str], ...] = (),
        pointed: Pointed | None = None,
    ) -> Vocabulary:
        """Put categories together; what follows from what is stated of them is added."""
        by_name = {category.name: category for category in sorted(categories, key=lambda c: c.name)}
        hierarchy = Hierarchy.of(by_name.values())
        closed = surrounded(close(by_name, hierarchy), hierarchy)
        return cls(closed, hierarchy, respelt or {}, sources, pointed or Pointed())

    def find(self, text: str) -> Category | None:
        """Return the category of that name, IRI, label, title or synonym in any language, or DPV term.

        Upper and lower case count alike; a former spelling of a DPV term is taken for the one of today.

        >>> load().find("face embedding").name, load().find("pd:FacialPrint").name
        ('FaceTemplate', 'FaceTemplate')
        """
        if text in self.categories:
            return self.categories[text]
        wanted = (self.respelt_as(text) or _whole(text)).casefold()
        for category in self.categories.values():
            if wanted in {name.casefold() for name in (*category.names, *category.same_as)}:
                return category
        return None

    def respelt_as(self, text: str) -> str | None:
        """Return how DPV spells a term today, if the text is a former spelling of one.

        >>> load().respelt_as("pd:Behavioral")
        'https://w3id.org/dpv/pd#Behavioural'
        """
        return self.respelt.get(_whole(text))

    def nearest(self, text: str) -> list[str]:
        """Return up to three names of categories that look like the text.

        >>> load().nearest("Biometrik")[0]
        'Biometric'
        """
        by_spelling = {
            spelling.casefold(): category.name
            for category in self.categories.values()
            for spelling in (*category.synonyms, category.title, category.name)
        }
        close_ones = nearest(text.casefold(), by_spelling, FEW)
        return list(dict.fromkeys(by_spelling[spelling] for spelling in close_ones))

    def hint(self, text: str) -> str:
        """Return what to do about a name that is not there.

        >>> load().hint("Biometrik"), load().hint("qqqqqq")
        ('did you mean Biometric?', 'rosprivacy categories lists all of them')
        """
        return did_you_mean(self.nearest(text), "rosprivacy categories lists all of them")

    @property
    def law_as_of(self) -> str:
        """Date of the newest law that the ontology knows, ``YYYY-MM-DD``; empty if it knows none."""
        return max((legal.as_of for category in self.categories.values() for legal in category.law), default="")

    def with_narrower(self, name: str) -> set[str]:
        """Return a category with all that are kinds of it.

        >>> "FaceTemplate" in load().with_narrower("Biometric")
        True
        """
        return {other for other, above in self.hierarchy.ancestors.items() if name in above}


def _whole(text: str) -> str:
    """An IRI in place of a prefixed name; one of ours in the form in which it is stored."""
    prefix, colon, rest = text.partition(":")
    return as_stored(PREFIXES.get(prefix + colon, prefix + colon) + rest)


def load(cache: Path | None = None, ontologies: Sequence[str] = ()) -> Vocabulary:
    """Read the shipped ontology, and users' own beside it.

    Parameters
    ----------
    cache
        Folder for what was read; the user's cache folder by default.
    ontologies
        Turtle files with more categories; see ``own.py`` for what they may say.

    Raises
    ------
    InputErrors
        If an ontology breaks a rule, or cannot be checked.
    """
    shipped = tuple((FOLDER / name).read_bytes() for name in SHIPPED)
    own = tuple((file, _read(file)) for file in dict.fromkeys(ontologies))
    return _vocabulary(cache or kept.default_folder(), shipped, own)


def remembered(make: Callable[Concatenate[Vocabulary, P], T]) -> Callable[Concatenate[Vocabulary, P], T]:
    """Make something once for a vocabulary, such as what shipped files say of its kinds; nobody changes it.

    >>> tops = remembered(lambda vocabulary: [TOP])
    >>> tops(load()) is tops(load())
    True
    """
    made: dict[Hashable, tuple[Vocabulary, T]] = {}

    @wraps(make)
    def of(vocabulary: Vocabulary, /, *args: P.args, **kwargs: P.kwargs) -> T:
        key = id(vocabulary), args, *kwargs.items()
        found = made.get(key)  # with its vocabulary: none of the same number comes while it is here
        if found is None:
            found = vocabulary, make(vocabulary, *args, **kwargs)
            if len(made) >= REMEMBERED:
                made.clear()
            made[key] = found
        return found[1]

    return of


@lru_cache(maxsize=REMEMBERED)
def _vocabulary(folder: Path, shipped: tuple[bytes, ...], own: tuple[tuple[str, bytes], ...]) -> Vocabulary:
    key = hashlib.sha256(
        b"".join(hashlib.sha256(data).digest() for data in [*shipped, *(d for _, d in own)])
    ).hexdigest()
    found = kept.get(folder, key)
    if found is None:
        found = _parse(shipped, own)
        kept.keep(folder, key, *found)
    categories, respelt, pointed = found
    sources = tuple((file, hashlib.sha256(data).hexdigest()) for file, data in own)
    return Vocabulary.of(categories, respelt, sources, pointed)


def _read(file: str) -> bytes:
    path = Path(file)

    def refused(problem: str, hint: str) -> InputErrors:
        return InputErrors([OntologyError(file, 0, problem, hint)])

    try:
        if not path.is_file():
            raise refused("is not a file", "name a Turtle file")
        if path.stat().st_size > LARGEST:
            size = f"{path.stat().st_size / 2**20:.0f} MB are too large"
            raise refused(size, f"an ontology of categories has at most {LARGEST // 2**20} MB")
        with path.open("rb") as data:
            return noted(data, file).read()
    except (OSError, ValueError) as error:
        raise refused(f"cannot be read: {reason(error)}", "check the name and your rights") from None


@lru_cache(maxsize=1)
def _shipped(texts: tuple[bytes, ...]) -> tuple[Known, dict[str, str]]:
    from rosprivacy.ontology.known import Known  # noqa: PLC0415 - light start
    from rosprivacy.ontology.turtle import categories_of, read, respelt_of  # noqa: PLC0415 - heavy

    graph = read("\n".join(text.decode() for text in texts), "the shipped ontology")
    return Known(graph, categories_of(graph)), respelt_of(graph)


def _parse(shipped: tuple[bytes, ...], own: Sequence[tuple[str, bytes]]) -> kept.CachedOntology:
    if own and find_spec(CHECKER) is None:
        hint = f"install it: {command_for('ontology')}"
        raise InputErrors([OntologyError(own[0][0], 0, f"cannot be checked, since {CHECKER} is not installed", hint)])
    known, respelt = _shipped(shipped)
    problems = []
    for file, data in own:
        from rosprivacy.ontology.own import with_own  # noqa: PLC0415 - heavier

        try:
            known = with_own(known, data, file)
        except InputErrors as error:
            problems += [e for e in error.errors if isinstance(e, OntologyError)]
    if problems:
        raise InputErrors(problems)
    from rosprivacy.ontology.turtle import pointed_of  # noqa: PLC0415 - heavy

    return known.categories, respelt, pointed_of(known.graph)
