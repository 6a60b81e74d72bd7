"""The types of the JSON documents and the published schemas say the same: keys, which are required, what they hold."""

from __future__ import annotations

import json
import types
import typing
from typing import TYPE_CHECKING, Any, NotRequired, get_args, get_origin, get_type_hints

import jsonschema
import pytest

import rosprivacy
from rosprivacy.mitigation import run_mitigation
from rosprivacy.report.contract import analysis, bags, fleet, mitigation, records, stated
from tests.helpers.cases import CASES, FLEETS
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

Schema = dict[str, Any]
MODULES = (analysis, bags, fleet, mitigation, records, stated)
NAMES = {name: value for module in MODULES for name, value in vars(module).items()}
PLAIN = {"string": str, "integer": int, "boolean": bool}
DOCUMENTS = {"analysis": analysis.AnalysisDocument, "mitigation": mitigation.MitigationDocument}
PUBLISHED = DOCUMENTS | {"bags": bags.BagsDocument}


def published(name: str) -> Schema:
    """A schema; what proposals rest on is 'those of rosprivacy.analysis/1, and these'."""
    schema: Schema = json.loads((ROOT / "docs" / f"{name}.schema.json").read_text("utf-8"))
    if name == "mitigation":
        whole = published("analysis")
        schema["$defs"] |= {key: value for key, value in whole["$defs"].items() if key not in schema["$defs"]}
        for key in ("properties", "required"):
            also, own = whole["properties"]["assumptions"][key], schema["properties"]["assumptions"][key]
            schema["properties"]["assumptions"][key] = also | own if isinstance(own, dict) else also + own
        schema["properties"] |= {key: whole["properties"][key] for key in ("diagnostics", "doubts")}
    return schema


class Comparison:
    """Where a type and a schema differ."""

    def __init__(self, schema: Schema) -> None:
        self.definitions: dict[str, Schema] = schema.get("$defs", {})

    def differences(self, hint: Any, schema: Schema, at: str) -> Iterator[str]:
        schema = self.whole(schema)
        if typing.is_typeddict(hint):
            yield from self.objects(hint, schema, at)
        elif get_origin(hint) is list:
            if schema.get("type") == "array" and "items" in schema:
                yield from self.differences(get_args(hint)[0], schema["items"], f"{at}[]")
            else:
                yield f"{at}: a list here, {schema} there"
        elif get_origin(hint) is dict and schema.get("type") == "object":
            values = [schema["additionalProperties"]] if schema.get("additionalProperties") else []
            for value in values or schema.get("properties", {}).values() or [{}]:
                yield from self.differences(get_args(hint)[1], value, f"{at}{{}}")
        elif isinstance(hint, types.UnionType):
            yield from self.unions(hint, schema, at)
        elif hint is not Any and self.plain(schema) is not hint:
            yield f"{at}: {hint} here, {schema} there"

    def objects(self, hint: Any, schema: Schema, at: str) -> Iterator[str]:
        if schema.keys() & {"anyOf", "enum", "const"} or schema.get("type", "object") != "object":
            yield f"{at}: an object here, {schema} there"
            return
        hints, properties = get_type_hints(hint, localns=NAMES), schema.get("properties", {})
        marked = get_type_hints(hint, localns=NAMES, include_extras=True)
        may_lack = {key for key, value in marked.items() if get_origin(value) is NotRequired} | hint.__optional_keys__
        yield from (f"{at}.{key}: no key of the schema" for key in hints.keys() - properties.keys())
        yield from (f"{at}.{key}: no key of {hint.__name__}" for key in properties.keys() - hints.keys())
        for key in (hints.keys() - may_lack) ^ set(schema.get("required", ())):
            yield f"{at}.{key}: required {'by the schema' if key in may_lack else 'by the type'} only"
        for key in sorted(hints.keys() & properties.keys()):
            yield from self.differences(hints[key], properties[key], f"{at}.{key}")

    def unions(self, hint: Any, schema: Schema, at: str) -> Iterator[str]:
        """Each alternative is one of the other side."""
        kinds = schema.get("type")
        left = [{"type": kind} for kind in kinds] if isinstance(kinds, list) else list(schema.get("anyOf", ()))
        for one in get_args(hint):
            same = [each for each in left if not [*self.differences(one, each, at)]]
            if same:
                left.remove(same[0])
            else:
                yield f"{at}: {one} here, none of {schema} there"
        yield from (f"{at}: {each} there, not here" for each in left)

    def whole(self, schema: Schema) -> Schema:
        """A schema without references; one that is put together of several, as one."""
        if "$ref" in schema:
            return self.whole(self.definitions[schema["$ref"].rpartition("/")[2]])
        merged: Schema = {key: value for key, value in schema.items() if key != "allOf"}
        for each in map(self.whole, schema.get("allOf", ())):
            merged["properties"] = merged.get("properties", {}) | each["properties"]
            merged["required"] = merged.get("required", []) + each.get("required", [])
        return merged

    def plain(self, schema: Schema) -> Any:
        values = schema.get("enum") or [schema[key] for key in ("const",) if key in schema]
        if values:
            (kind,) = {type(value) for value in values}
            return kind
        return type(None) if schema.get("type") == "null" else PLAIN.get(str(schema.get("type")))


@pytest.mark.parametrize("name", PUBLISHED)
def test_the_types_are_the_published_schema(name: str) -> None:
    schema = published(name)
    assert [*Comparison(schema).differences(PUBLISHED[name], schema, name)] == []


@pytest.mark.parametrize("name", DOCUMENTS)
@pytest.mark.parametrize("change", ["a key more", "a key less", "another type", "not required"])
def test_a_change_on_one_side_is_seen(name: str, change: str) -> None:
    schema = published(name)
    if change == "a key more":
        schema["properties"]["assumptions"]["properties"]["new"] = {"type": "string"}
    elif change == "a key less":
        del schema["$defs"]["element"]["properties"]["leg"]
    elif change == "another type":
        schema["$defs"]["element"]["properties"]["name"] = {"type": "integer"}
    else:
        schema["required"].remove("diagnostics")
    assert [*Comparison(schema).differences(DOCUMENTS[name], schema, name)]


def closed(value: Any) -> Any:
    """The schema, with no other keys than those that it names."""
    if isinstance(value, list):
        return [closed(item) for item in value]
    if not isinstance(value, dict):
        return value
    whole = {key: closed(item) for key, item in value.items()}
    keep = isinstance(value.get("properties"), dict) and "additionalProperties" not in value
    return whole | {"additionalProperties": False} if keep else whole


def validator(name: str) -> jsonschema.Draft202012Validator:
    schema = published(name)
    decisions = schema["properties"].get("decisions", {}).get("items")
    if decisions:  # two parts that each do without the keys of the other
        schema["properties"]["decisions"]["items"] = Comparison(schema).whole(decisions)
    return jsonschema.Draft202012Validator(closed(schema))


@pytest.mark.parametrize("case", [*CASES, *FLEETS], ids=lambda path: str(path.name))
def test_documents_hold_no_other_keys(case: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT / "examples")
    fleet_case = case / "fleet.json"
    given = json.loads((fleet_case if fleet_case.is_file() else case / "case.json").read_text("utf-8"))
    options = given.get("options", {})
    if "fleet" in given:
        validator("analysis").validate(rosprivacy.analyze_fleet(given["fleet"], **options).document())
        return
    result = rosprivacy.analyze(given["policies"], given["labels"], **options)
    validator("analysis").validate(result.document())
    validator("mitigation").validate(run_mitigation(result).document())
