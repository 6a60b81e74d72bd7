"""The JSON document: its contract, its schema, and that the same input gives the same bytes (rule S14)."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from typing import Any

import jsonschema
import pytest

import rosprivacy
from tests.helpers.paths import ROOT

CARE_HOME = (["examples/care-home/care-home.policy.xml"], ["examples/care-home/care-home.labels.yaml"])
ELEMENT = {"robot", "kind", "name"}


@pytest.fixture(scope="module", params=["witness", "all"])
def document(request: pytest.FixtureRequest) -> dict[str, Any]:
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(ROOT)
        return rosprivacy.analyze(*CARE_HOME, paths=request.param).document()


def test_the_fixed_keys_are_there(document: dict[str, Any]) -> None:
    assert document["format"] == "rosprivacy.analysis/1"
    assert set(document) >= {
        "verdict", "view", "categories", "findings", "open", "carries", "flows", "elements", "standard_channels",
        "diagnostics", "assumptions",
    }  # fmt: skip
    assert set(document["categories"][0]) >= {"name", "iri", "broader"}
    assert set(document["findings"][0]) >= {
        "id", "kind", "category", "pseudonymised", "source", "leak", "witness", "disjoint_paths", "through",
        "dismissed",
    }  # fmt: skip
    assert set(document["carries"][0]) >= {"element", "categories", "pseudonymised"}
    assert set(document["findings"][0]["source"]) == ELEMENT


def test_it_is_valid_under_its_schema(document: dict[str, Any]) -> None:
    schema = json.loads((ROOT / "docs" / "analysis.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.Draft202012Validator(schema).validate(document)


def test_a_leg_and_a_wildcard_are_marked(document: dict[str, Any]) -> None:
    elements = [c["element"] for c in document["carries"]]
    assert {"robot": "", "kind": "service", "name": "/notify_staff", "leg": "request"} in elements
    assert {"robot": "", "kind": "topic", "name": "/camera/*", "pattern": True} in elements


def test_it_says_what_it_assumes(document: dict[str, Any]) -> None:
    """Rule S12."""
    assumed = document["assumptions"]
    assert assumed["view"] == "declared"
    assert [file["file"] for file in assumed["labels"]] == CARE_HOME[1]
    assert all(len(file["sha256"]) == 64 for file in (*assumed["labels"], *assumed["policies"]))
    assert {file["file"] for file in assumed["policies"]} == {*CARE_HOME[0], "examples/care-home/node.xml"}
    assert assumed["standard_channels"]["file"] == "rosprivacy:standard"


def test_no_word_of_it_is_a_legal_verdict(document: dict[str, Any]) -> None:
    text = json.dumps(document).casefold()
    assert not any(word in text for word in ("compliant", "violation", "illegal", '"safe"'))


@pytest.mark.slow
@pytest.mark.parametrize("form", ["text", "json", "turtle", "json-ld", "sarif", "cnil-pia"])
def test_the_bytes_are_the_same_in_every_process(form: str) -> None:
    """Across runs, hash seeds and the order in which files are named."""
    policies = ["examples/factory/after.policy.xml", "examples/care-home/care-home.policy.xml"]
    labels = ["examples/factory/run4.labels.yaml", "examples/care-home/care-home.labels.yaml"]
    outputs = set()
    for seed, order in (("0", 1), ("1", -1), ("4711", 1)):
        command = [sys.executable, "-m", "rosprivacy", "analyze", *policies[::order], "-f", form, "--paths", "all"]
        for file in labels:
            command += ["-l", file]
        environment = {**os.environ, "PYTHONHASHSEED": seed, "SOURCE_DATE_EPOCH": "1767225600"}
        done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, check=False)
        assert done.returncode == 1, done.stderr
        outputs.add(done.stdout)
    assert len(outputs) == 1
