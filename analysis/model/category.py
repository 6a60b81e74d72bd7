"""A category of personal data, the law that can apply to it, and what a finding about it can be of (rule S10)."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

DISCLOSURE, STORAGE_LIMITATION, THIRD_COUNTRY = "disclosure", "storage-limitation", "third-country-transfer"
UNPROTECTED = "unprotected-channel"  # who is on the network can read what flows there
ARTICLE_9, ARTICLE_10 = "GDPR Art. 9(1)", "GDPR Art. 10"
SPECIAL, MAY_REVEAL = ("always", "conditional"), "may-reveal"
CONCERNS = "concerns"  # of a context: a provision is about such data there, and names nothing that they could reveal
ARTICLE_9_VERDICTS = (*SPECIAL, MAY_REVEAL, "no", "unknown")
SENSED = ("video", "audio", "image", "thermal", "point-cloud", "depth")  # data types of a sensor: what it saw or heard
FORMS = (
    *SENSED,
    "template",
    "text",
    "record",
    "map",
    "position",
    "identifier",
    "number",
    "class-label",
)  # the rawest first
_BY_LAW = (*SPECIAL, MAY_REVEAL, "unknown")

Weight = tuple[int, tuple[int, ...]]


def weight(verdicts: Collection[str], data_types: Iterable[str]) -> Weight:
    """Return the place of a kind of data in the order in which people look at kinds: the heaviest is the least.

    First what Article 9 or 10 names, then what may reveal it; of these what is rawest: video before a position.

    Parameters
    ----------
    verdicts
        Of provisions, and the one of Article 9.

    Examples
    --------
    >>> video, pose, template = (weight({one}, of) for one, of in (
    ...     ("may-reveal", ["video"]), ("may-reveal", ["position"]), ("conditional", ["template"])))
    >>> template < video < pose
    True
    """
    law = next((place for place, verdict in enumerate(_BY_LAW) if verdict in verdicts), len(_BY_LAW))
    forms = sorted(FORMS.index(form) if form in FORMS else len(FORMS) for form in data_types)
    return law, tuple(forms) or (len(FORMS),)


def is_article_9(provision: str) -> bool:
    """Return whether a provision is Article 9(1) GDPR, or one of the kinds of data that it names.

    >>> is_article_9("GDPR Art. 9(1) biometric data"), is_article_9("GDPR Art. 10")
    (True, False)
    """
    return provision == ARTICLE_9 or provision.startswith(f"{ARTICLE_9} ")


class Legal(NamedTuple):
    """That data of a category can be what a provision speaks of.

    Attributes
    ----------
    iri, name, meaning
        Of the provision; its meaning in one sentence of our own.
    as_of
        Date of the law, ``YYYY-MM-DD``.
    verdict
        ``always``, ``conditional`` or ``may-reveal``; in a context ``may-reveal`` or ``concerns``.
    condition
        When, where it is not always.
    sources
        Names of the provisions and guidelines that the verdict rests on, sorted.
    stated_of
        Name of the category that the ontology says it of: this one, a broader one, or narrower ones.
    translations
        Language -> ``meaning``, ``condition``, ``name`` and ``sources`` (in a row) in it.
    context
        Where it holds only: one of ``CONTEXTS``; empty where it holds everywhere.
    """

    iri: str
    name: str
    meaning: str
    as_of: str
    verdict: str
    condition: str = ""
    sources: tuple[str, ...] = ()
    stated_of: str = ""
    translations: Mapping[str, Mapping[str, str]] = {}
    context: str = ""

    @property
    def special(self) -> bool:
        """Whether it is Article 9(1) GDPR."""
        return is_article_9(self.name)

    def text(self, attribute: str, language: str) -> str:
        """Return its ``meaning``, ``condition`` or ``name`` in a language, in English if there is no translation."""
        return self.translations.get(language, {}).get(attribute) or str(getattr(self, attribute))


class Pointer(NamedTuple):
    """A provision that is to be looked at beside what is followed into paths: no verdict.

    Attributes
    ----------
    title, meaning
        What it is about; what it says in one sentence of our own.
    as_of
        The day on which the entry was last looked at, ``YYYY-MM-DD``; no word that the law was read in force then.
    applies
        The day from which it applies, or will; empty where it simply applies.
    confirmed, adopted
        Whether we found that law to be published; if not, the day on which it was adopted, or nothing where all that
        we know of it is what others write.
    country
        ISO 3166-1 code of the country whose law it is; empty for law of the Union.
    address
        Where EUR-Lex has it; empty where nothing is known.
    translations
        Language -> ``name``, ``title`` and ``meaning`` in it.
    """

    iri: str
    name: str
    title: str
    meaning: str
    as_of: str
    applies: str = ""
    country: str = ""
    address: str = ""
    translations: Mapping[str, Mapping[str, str]] = {}
    confirmed: bool = True
    adopted: str = ""


class Situation(NamedTuple):
    """A context with the names of the provisions to look at there; the one without a name is every system.

    Attributes
    ----------
    translations
        Language -> ``title`` and ``definition`` in it.
    """

    name: str
    title: str = ""
    definition: str = ""
    look_at: tuple[str, ...] = ()
    translations: Mapping[str, Mapping[str, str]] = {}


class PersonGroup(NamedTuple):
    """A group of persons that labels may name in their own words, such as children.

    Attributes
    ----------
    name
        Short name, the IRI's last part.
    term
        IRI of the group in DPV.
    words
        All that it is called in any language, in small letters, sorted.
    vulnerable
        Whether it is among the vulnerable persons of criterion 7 of WP 248 rev.01; else a person has to say.
    look_at
        Names of the provisions to look at where data are about the group, sorted.
    translations
        Language -> ``title`` in it.
    """

    name: str
    term: str
    title: str
    words: tuple[str, ...]
    vulnerable: bool = False
    look_at: tuple[str, ...] = ()
    translations: Mapping[str, Mapping[str, str]] = {}


class Category(NamedTuple):
    """A kind of personal data.

    Attributes
    ----------
    name
        Short name, the IRI's last part; used in label files.
    iri
        Full IRI.
    label
        Neo4j label name, an identifier, unique.
    title
        English name for people.
    definition
        One sentence.
    broader
        Names of the direct broader categories (``skos:broader``), sorted.
    synonyms
        Other names that find it, in any language, sorted.
    law
        Provisions that it falls under, sorted by name.
    reason
        Why it does not fall under Article 9(1), where the ontology says so.
    stated_of
        Names of the categories that ``law`` and ``reason`` are stated of; empty as read from the ontology.
    data_types
        How it is represented: image, audio, position, …, sorted.
    identity_factors
        What of a person's identity it tells of, as Article 4(1) GDPR names it: name, location, economic, …, sorted;
        empty where the ontology does not say it.
    gdpr
        Name of the provision that defines its GDPR category.
    same_as, within
        IRIs of other vocabularies: the same concept, broader ones; sorted.
    note
        For readers of the ontology.
    in_context
        What data of it may reveal in a context, sorted; each ``Legal`` names its context.
    look_at
        Names of further provisions to look at, sorted.
    translations
        Language -> ``title``, ``definition``, ``reason`` and ``gdpr`` in it.
    """

    name: str
    iri: str
    label: str
    title: str
    definition: str
    broader: tuple[str, ...] = ()
    synonyms: tuple[str, ...] = ()
    law: tuple[Legal, ...] = ()
    reason: str = ""
    stated_of: tuple[str, ...] = ()
    data_types: tuple[str, ...] = ()
    identity_factors: tuple[str, ...] = ()
    gdpr: str = ""
    same_as: tuple[str, ...] = ()
    within: tuple[str, ...] = ()
    note: str = ""
    in_context: tuple[Legal, ...] = ()
    look_at: tuple[str, ...] = ()
    translations: Mapping[str, Mapping[str, str]] = {}

    @property
    def names(self) -> tuple[str, ...]:
        """All that it is called: a text that is one of them, in upper or lower case, means it."""
        return tuple(filter(None, (self.name, self.iri, self.label, self.title, *self.synonyms)))

    @property
    def article9(self) -> str:
        """The strongest verdict under Article 9(1) GDPR: one of ``ARTICLE_9_VERDICTS``."""
        verdicts = {legal.verdict for legal in self.law if legal.special}
        stated = "no" if self.reason else "unknown"
        return next((verdict for verdict in ARTICLE_9_VERDICTS[:3] if verdict in verdicts), stated)

    @property
    def weight(self) -> Weight:
        """Its place in the order of kinds, the heaviest first."""
        return weight({self.article9, *(legal.verdict for legal in self.law)}, self.data_types)

    def text(self, attribute: str, language: str) -> str:
        """Return its ``title``, ``definition``, ``reason`` or ``gdpr`` in a language, else in English."""
        return self.translations.get(language, {}).get(attribute) or str(getattr(self, attribute))
