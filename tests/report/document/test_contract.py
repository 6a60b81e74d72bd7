"""The JSON documents are as their types declare them, with no other keys; ``test_docs`` holds the published schemas."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import jsonschema
import pytest

import rosprivacy
from rosprivacy.mitigation import run_mitigation
from rosprivacy.report.schemas.analysis import Assumptions
from tests.helpers import contract
from tests.helpers.cases import CASES, FLEETS
from tests.helpers.daily import one_in
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path


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
    return jsonschema.Draft202012Validator(closed(contract.schema(contract.DOCUMENTS[name])))


@pytest.mark.parametrize("name", contract.DOCUMENTS)
def test_the_schemas_are_schemas(name: str) -> None:
    jsonschema.Draft202012Validator.check_schema(contract.schema(contract.DOCUMENTS[name]))


@pytest.mark.parametrize("case", one_in(4, [*CASES, *FLEETS], in_ci=1), ids=lambda path: str(path.name))
def test_documents_hold_no_other_keys(case: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT / "examples")
    fleet_case = case / "fleet.json"
    given = json.loads((fleet_case if fleet_case.is_file() else case / "case.json").read_text("utf-8"))
    options = {"paths": "all", **given.get("options", {})}
    if "fleet" in given:
        validator("analysis").validate(rosprivacy.analyze_fleet(given["fleet"], **options).document())
        return
    result = rosprivacy.analyze(given["policies"], given["labels"], **options)
    validator("analysis").validate(result.document())
    proposals: dict[str, Any] = {**run_mitigation(result).document()}
    own = {key: value for key, value in proposals["assumptions"].items() if key not in Assumptions.__annotations__}
    assert len(own) < len(proposals["assumptions"])
    validator("mitigation").validate(proposals | {"assumptions": own})
