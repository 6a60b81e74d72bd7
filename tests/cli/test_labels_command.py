"""``rosprivacy labels``: a first label file, the schema, the files that come with the program."""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING, Any

import pytest
import yaml
from jsonschema import Draft202012Validator

from rosprivacy.ingest.labels.label_file import read_labels, shipped_text
from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli
from tests.helpers.policies import document, elements, policy


def without_assumptions(result: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in result.items() if key != "assumptions"}


SHIPPED_CHANNELS = set(re.findall(r'"\*/(\w+)"', shipped_text("standard")))


def test_a_first_label_file_names_every_element_once_but_those_of_the_shipped_files(
    cli: Cli, before: Path, tmp_path: Path
) -> None:
    done = cli("labels", "--init", before, "-o", tmp_path / "l.yaml")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    text = (tmp_path / "l.yaml").read_text("utf-8")
    read = read_labels(str(tmp_path / "l.yaml"), load()).entries
    named = [(kind, entry.name) for entry in read for kind in entry.kinds]
    shipped = {(kind, name) for kind, name in elements(before) if name.rpartition("/")[2] in SHIPPED_CHANNELS}
    assert sorted(named) == sorted(elements(before) - shipped)
    assert f"# Not listed: {len(shipped)} standard channels" in text
    schema = json.loads((tmp_path / "labels.schema.json").read_text("utf-8"))  # the first line names it
    assert text.startswith("# yaml-language-server: $schema=labels.schema.json\n")
    assert Draft202012Validator(schema).is_valid(yaml.safe_load(text))


def test_a_schema_that_is_there_stays(cli: Cli, before: Path, tmp_path: Path) -> None:
    (tmp_path / "labels.schema.json").write_text("{}")
    assert cli("labels", "--init", before, "-o", tmp_path / "l.yaml").returncode == 0
    assert (tmp_path / "labels.schema.json").read_text() == "{}"


def test_a_first_label_file_is_valid_as_it_is_and_says_nothing(cli: Cli, before: Path, tmp_path: Path) -> None:
    (tmp_path / "l.yaml").write_text(cli("labels", "--init", before).stdout)
    assert all(entry.statements == () for entry in read_labels(str(tmp_path / "l.yaml"), load()).entries)
    with_it, without = document(cli, before, "-l", tmp_path / "l.yaml"), document(cli, before)
    assert without_assumptions(with_it) == without_assumptions(without)


def test_a_first_label_file_lists_standard_channels_where_they_are_not_taken(cli: Cli, before: Path) -> None:
    assert "/rosout:" not in cli("labels", "--init", before).stdout
    assert "  /rosout:" in cli("labels", "--init", before, "--standard-channels", "none").stdout


@pytest.mark.parametrize(
    ("name", "ns"),
    [
        ("x", "/"),
        ("a b: #c", "/"),
        ("q\"'\\", "/"),
        ("é", "/"),
        ("\U0001f600", "/"),
        ("a\nb\tc", "/"),
        ("\u2028\x85\ufeff", "/"),
        ("-", "/"),
        ("&a", "/"),
        ("*", "/"),
        ("[a-c]?", "/"),
        ("x" * 1200, "/"),
        ("x", "relative"),  # sros2 does not repair a namespace; the element is called so
        ("x", ""),
        ("", "/"),
    ],
)
def test_a_first_label_file_is_valid_whatever_the_names(cli: Cli, tmp_path: Path, name: str, ns: str) -> None:
    escaped = name.replace("&", "&amp;")
    body = f'<topics publish="ALLOW"><topic>{escaped}</topic></topics>'
    (tmp_path / "p.xml").write_text(policy(body, ns), "utf-8")
    done = cli("labels", "--init", "p.xml", "-o", "l.yaml", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    done = cli("analyze", "p.xml", "-l", "l.yaml", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (4, "")


def test_the_schema_is_a_json_schema(cli: Cli) -> None:
    schema = json.loads(cli("labels", "--schema").stdout)
    Draft202012Validator.check_schema(schema)


@pytest.mark.parametrize("name", ["standard", "infrastructure"])
def test_a_shipped_file_is_printed_as_it_is(cli: Cli, name: str, tmp_path: Path) -> None:
    done = cli("labels", f"--{name}")
    assert (done.returncode, done.stdout) == (0, shipped_text(name))
    cli("labels", f"--{name}", "-o", tmp_path / "s.yaml")
    assert (tmp_path / "s.yaml").read_text("utf-8") == shipped_text(name)
