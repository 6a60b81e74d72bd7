"""Label files for a small system, and what is read from them."""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING, Any

import pytest
from jsonschema import Draft202012Validator

import rosprivacy
from rosprivacy.analysis.errors import InputErrors, LabelError
from rosprivacy.ingest.labels.label_file import Labels, read_labels
from rosprivacy.ingest.labels.label_schema import label_schema
from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.analysis.model import Statement


LINE = re.compile(r"[^;]+: .+; .+")  # file:line: what is wrong; what to do


# /camera -> /image -> /filter -> /clean -> /viewer, and /viewer calls /snap and /spin of /camera
SYSTEM = """<policy version="0.2.0"><enclaves><enclave path="/e"><profiles>
<profile ns="/" node="camera">
  <topics publish="ALLOW"><topic>image</topic><topic>/rosout</topic></topics>
  <services reply="ALLOW"><service>snap</service></services>
  <actions execute="ALLOW"><action>spin</action></actions>
</profile>
<profile ns="/" node="filter">
  <topics subscribe="ALLOW"><topic>image</topic></topics>
  <topics publish="ALLOW"><topic>clean</topic></topics>
</profile>
<profile ns="/" node="viewer">
  <topics subscribe="ALLOW"><topic>clean</topic></topics>
  <services request="ALLOW"><service>snap</service></services>
  <actions call="ALLOW"><action>spin</action></actions>
</profile>
</profiles></enclave></enclaves></policy>
"""


@cache
def validator() -> Any:
    schema = label_schema(load().categories.values())
    Draft202012Validator.check_schema(schema)
    return Draft202012Validator(schema)


def read(folder: Path, text: str, name: str = "l.yaml", **options: Any) -> Labels:
    (folder / name).write_text(text, encoding="utf-8")
    return read_labels(str(folder / name), load(), **options)


def problems(caught: pytest.ExceptionInfo[InputErrors], folder: Path) -> list[str]:
    """The messages, each one line of the format, without the folder."""
    lines = str(caught.value).split("\n")
    assert all(LINE.fullmatch(line) for line in lines)
    assert all(isinstance(error, LabelError) for error in caught.value.errors)
    return [line.replace(f"{folder}/", "") for line in lines]


def refused(folder: Path, text: str, **options: Any) -> list[str]:
    with pytest.raises(InputErrors) as caught:
        read(folder, text, **options)
    return problems(caught, folder)


def told(labels: Labels) -> list[str]:
    """What a file says, one line for each statement."""
    lines = []
    for entry in labels.entries:
        lines += [f"{'/'.join(entry.kinds)} {entry.name}: {_said(statement)}" for statement in entry.statements]
    for flow in labels.flows:
        lines += [f"{flow.source} -> {flow.target}: {_said(statement)}" for statement in flow.statements]
    return lines


def _said(statement: Statement) -> str:
    words = [statement.role, *statement.categories]
    words += [f"by {statement.method}" + ("" if statement.stated else "?")] if statement.method else []
    words += [f"to {statement.to}"] if statement.to else []
    words += [f"through {' '.join(statement.through)}"] if statement.through else []
    return " ".join(words)


def analyse(folder: Path, *texts: str, **options: Any) -> Any:
    """Analyse the system under label files 1.yaml, 2.yaml, …"""
    (folder / "p.xml").write_text(SYSTEM)
    files = []
    for number, text in enumerate(texts, 1):
        (folder / f"{number}.yaml").write_text(text)
        files.append(str(folder / f"{number}.yaml"))
    return rosprivacy.analyze([str(folder / "p.xml")], files, **options).analysis


def wrong(folder: Path, *texts: str, **options: Any) -> list[str]:
    with pytest.raises(InputErrors) as caught:
        analyse(folder, *texts, **options)
    return problems(caught, folder)


VIDEO = "labels: 1\nnodes: {/camera: {source: [Video]}}"
