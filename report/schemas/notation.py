"""How a field of a document is written down, and the kinds of values that stand in several.

``Annotated[type, keywords, "description"]``: keywords are those of JSON Schema that the type does not say itself.
``NotRequired`` is what a document may do without: where there is nothing to say, or since it is newer than the format.
"""

from typing import Annotated, Any, TypeVar, get_type_hints

Type = TypeVar("Type")
SHA256 = "^[0-9a-f]{64}$"


class Keywords:
    """Keywords of JSON Schema, for what a type does not say itself."""

    def __init__(self, **keywords: object) -> None:
        self.keywords = keywords


class Term:
    """The term of linked data that says what a field says of an element."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.keywords: dict[str, object] = {}


def terms_of(entry: type) -> dict[str, str]:
    """Return the terms of the fields of an entry, of those that have one.

    >>> class Entry:
    ...     country: Annotated[str, Term("country"), "ISO 3166-1."]
    >>> terms_of(Entry)
    {'country': 'country'}
    """
    notes = {
        field: getattr(hint, "__metadata__", ()) for field, hint in get_type_hints(entry, include_extras=True).items()
    }
    return {field: note.name for field, of_field in notes.items() for note in of_field if isinstance(note, Term)}


def closed(document: type[Type]) -> type[Type]:
    """Mark an object that has no other keys than those that are named; others may gain some."""
    document.__closed__ = True  # type: ignore[attr-defined]
    return document


def without_keys_of(extended: type) -> Any:
    """Mark an object that has the keys of another one, too, which are described in the document of that."""

    def marked(document: type[Type]) -> type[Type]:
        document.__elsewhere__ = extended  # type: ignore[attr-defined]
        return document

    return marked


def one_of(*values: str) -> Keywords:
    """Return what says that a value is one of these."""
    return Keywords(enum=[*values])


def texts(*keys: str) -> Keywords:
    """Return what says which texts there are in each language."""
    of_a_language = {"type": "object", "properties": {key: {"type": "string"} for key in keys}}
    return Keywords(additionalProperties=of_a_language | {"additionalProperties": False})


Sha256 = Annotated[str, Keywords(pattern=SHA256)]
Id = Annotated[str, Keywords(pattern="^[0-9a-f]{16}$")]
Day = Annotated[str, Keywords(pattern=r"^\d{4}-\d{2}-\d{2}$")]
Count = Annotated[int, Keywords(minimum=0)]
Positive = Annotated[int, Keywords(minimum=1)]
Always = Annotated[bool, Keywords(const=True)]  # absent where it is not so
Texts = dict[str, dict[str, str]]  # language -> what -> text

Verdict = Annotated[str, one_of("leak", "undetermined", "no-leak-found")]
BagVerdict = Annotated[str, one_of("personal-data", "undetermined", "nothing-found")]
View = Annotated[str, one_of("declared", "enforced")]
Severity = Annotated[str, one_of("error", "warning", "notice")]
Confidence = Annotated[str, one_of("certain", "likely", "may")]
Article9 = Annotated[str, one_of("always", "conditional", "may-reveal", "no", "unknown")]
LawVerdict = Annotated[str, one_of("always", "conditional", "may-reveal")]
ContextVerdict = Annotated[str, one_of("always", "conditional", "may-reveal", "concerns")]
Context = Annotated[str, one_of("care", "public-space", "school", "union", "workplace", "worship")]
GdprScope = Annotated[str, one_of("open", "denied")]
Method = Annotated[str, one_of("anonymise", "aggregate", "drop", "pseudonymise")]
Leg = Annotated[str, one_of("request", "response")]
NotStated = Annotated[str, one_of("country", "occasional")]
Cause = Annotated[str, one_of("not-encrypted", "strangers")]
Change = Annotated[str, one_of("review", "filter", "deny")]
ElementKind = Annotated[
    str,
    one_of(
        "node", "device", "display", "external-system", "participant", "person", "shared-memory", "side-channel",
        "storage", "topic", "service", "action",
    ),
]  # fmt: skip
