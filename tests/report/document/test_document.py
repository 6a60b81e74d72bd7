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


@pytest.fixture(scope="module", params=["witness", "all"])
def document(request: pytest.FixtureRequest) -> dict[str, Any]:
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(ROOT)
        return rosprivacy.analyze(*CARE_HOME, paths=request.param).document()


def test_it_is_valid_under_its_schema(document: dict[str, Any]) -> None:
    schema = json.loads((ROOT / "docs" / "analysis.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    jsonschema.Draft202012Validator(schema).validate(document)


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
