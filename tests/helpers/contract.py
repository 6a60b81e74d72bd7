"""The JSON documents as their types declare them -> JSON schemas, and a page of the fields of each.

``python -m tests.test_docs`` writes both.
"""

from __future__ import annotations

import json
import types
from typing import TYPE_CHECKING, Annotated, Any, Union, get_args, get_origin

from typing_extensions import get_type_hints, is_typeddict  # of Python 3.11, on 3.10 too

from rosprivacy.analysis.python_311 import NotRequired
from rosprivacy.report.schemas.analysis import AnalysisDocument, ShortDocument
from rosprivacy.report.schemas.bags import BagsDocument, SharedBagDocument
from rosprivacy.report.schemas.mitigation import MitigationDocument
from rosprivacy.report.schemas.policies import CheckDocument, LintDocument
from rosprivacy.report.schemas.suggested import ExchangesDocument, SuggestionsDocument
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

Schema = dict[str, Any]
DOCUMENTS: dict[str, Any] = {
    "analysis": AnalysisDocument,
    "analysis-2": ShortDocument,
    "mitigation": MitigationDocument,
    "suggestions": SuggestionsDocument,
    "model-exchanges": ExchangesDocument,
    "bags": BagsDocument,
    "shared-bag": SharedBagDocument,
    "check": CheckDocument,
    "lint": LintDocument,
}
PLAIN = {str: "string", int: "integer", bool: "boolean", type(None): "null"}
IN_WORDS = {"string": "text", "integer": "number", "boolean": "true or false", "null": "null", "object": "object"}
ABSENT = "A field in *italics* may be absent: where there is nothing to say, or in documents of earlier versions."


def file_of(name: str) -> Path:
    """Where the schema of a document is kept."""
    return ROOT / "docs" / f"{name}.schema.json"


def schema(document: Any) -> Schema:
    """The JSON schema of a document; each type in it stands under its name."""
    whole = _object(document)
    definitions: dict[str, Schema] = {}
    left = [document]
    while left:
        for used in _used(left.pop()):
            if used.__name__ not in definitions:
                definitions[used.__name__] = _object(used)
                left.append(used)
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": whole["properties"]["format"]["const"],
        "description": _about(document),
        **whole,
        **({"$defs": dict(sorted(definitions.items()))} if definitions else {}),
    }


def text(document: Any) -> str:
    """A schema as it is written into a file."""
    return json.dumps(schema(document), ensure_ascii=False, indent=2) + "\n"


def fields(document: Any) -> dict[str, Any]:
    """The fields of an object and what each holds; without those that the document of another one describes."""
    elsewhere = getattr(document, "__elsewhere__", None)
    others = elsewhere.__annotations__ if elsewhere else {}
    return {key: hint for key, hint in get_type_hints(document, include_extras=True).items() if key not in others}


def parts(hint: Any) -> tuple[Any, Schema, str]:
    """What a field holds, the keywords of its schema, and its description."""
    keywords: Schema = {}
    description = ""
    while get_origin(hint) in (Annotated, NotRequired):
        hint, *notes = get_args(hint)
        for note in notes:
            if isinstance(note, str):
                description = note
            else:
                keywords = note.keywords | keywords
    return hint, keywords, description


def _about(document: Any) -> str:
    return " ".join(document.__doc__.split())


def _object(document: Any) -> Schema:
    held = fields(document)
    required = [key for key in held if key in document.__required_keys__]
    return {
        "type": "object",
        "properties": {key: _value(hint) for key, hint in held.items()},
        **({"required": required} if required else {}),
        **({"additionalProperties": False} if getattr(document, "__closed__", None) else {}),
    }


def _value(hint: Any) -> Schema:
    hint, keywords, description = parts(hint)
    whole = _type(hint) if keywords.keys().isdisjoint(("type", "enum", "const")) else {}
    return whole | keywords | ({"description": description} if description else {})


def _type(hint: Any) -> Schema:
    if is_typeddict(hint):
        return {"$ref": f"#/$defs/{hint.__name__}"}
    if get_origin(hint) in (Union, types.UnionType):
        return {"anyOf": [_value(each) for each in get_args(hint)]}
    if get_origin(hint) is list:
        return {"type": "array", "items": _value(get_args(hint)[0])}
    if get_origin(hint) is dict:
        values = _value(get_args(hint)[1])
        return {"type": "object", **({"additionalProperties": values} if values else {})}
    return {} if hint in (Any, object) else {"type": PLAIN[hint]}


def _used(document: Any) -> Iterator[Any]:
    """The types that stand in a document's schema, one step down."""
    for hint in fields(document).values():
        yield from _named(hint)


def _named(hint: Any) -> Iterator[Any]:
    hint, keywords, _ = parts(hint)
    if is_typeddict(hint):
        yield hint
    elif "items" not in keywords:
        for each in get_args(hint):
            yield from _named(each)


def index(written_by: str) -> str:
    """The page that lists all documents; ``written_by`` says where pages come from."""
    rows = [f"| [{_format(name)}](documents/{name}.md) | {_about(one)} |" for name, one in DOCUMENTS.items()]
    return "\n".join(["# JSON documents", "", written_by, "| document | what it is |", "| --- | --- |", *rows, ""])


def page(name: str, written_by: str) -> str:
    """A document and all that stands in it, as tables; what an earlier document describes is a link to its page."""
    described: set[Any] = set()
    for earlier, document in DOCUMENTS.items():
        if earlier == name:
            break
        described |= _within(document)
    schemas = f"As a JSON schema: [{name}.schema.json](../../{name}.schema.json). {ABSENT}"
    lines = [f"# {_format(name)}", "", written_by, schemas, ""]
    left = [("", DOCUMENTS[name])]
    while left:
        heading, each = left.pop(0)
        if each not in described:
            described.add(each)
            about = _about(each) if each.__doc__ and "TypedDict" not in each.__doc__ else ""
            lines += [*([heading, ""] if heading else []), *([about, ""] if about else []), *_rows(each, name), ""]
            left[:0] = [(f"## {used.__name__}", used) for used in _used(each)]
    return "\n".join(lines)


def _format(name: str) -> str:
    """What a document calls its format."""
    constant: str = parts(fields(DOCUMENTS[name])["format"])[1]["const"]
    return constant


def _within(document: Any) -> set[Any]:
    """A document and the types that stand in it."""
    within: set[Any] = set()
    left = [document]
    while left:
        each = left.pop()
        if each not in within:
            within.add(each)
            left += _used(each)
    return within


def _rows(document: Any, name: str) -> Iterator[str]:
    yield "| field | holds | meaning |"
    yield "| --- | --- | --- |"
    for key, hint in fields(document).items():
        shown = f"`{key}`" if key in document.__required_keys__ else f"*`{key}`*"
        yield f"| {shown} | {_holds(hint, name)} | {parts(hint)[2]} |".replace("  |", " |")


def _holds(hint: Any, name: str) -> str:
    """What a field of a document holds, in words; a type that an earlier document describes is a link to its page."""
    hint, keywords, _ = parts(hint)
    values = keywords.get("enum", [keywords["const"]] if "const" in keywords else [])
    if values:
        return ", ".join(f"`{json.dumps(value)}`" for value in values)
    if is_typeddict(hint):
        first = next(other for other, document in DOCUMENTS.items() if other == name or hint in _within(document))
        return f"[{hint.__name__}]({'' if first == name else f'{first}.md'}#{hint.__name__.lower()})"
    inside = [_holds(each, name) for each in get_args(hint) if each not in (Any, object)]
    if get_origin(hint) in (Union, types.UnionType):
        return " or ".join(inside)
    if get_origin(hint) is list:
        return f"list of {inside[0]}"
    if get_origin(hint) is dict:
        return " of ".join(["object", *inside[1:]])
    return IN_WORDS[PLAIN[hint]]
