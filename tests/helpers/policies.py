"""Policies as text, and folders as bytes."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import rosprivacy

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli


ESCAPE = "\x1b"


def document(cli: Cli, *arguments: str | Path, cwd: Path | None = None) -> Any:
    return json.loads(cli("analyze", *arguments, "--format", "json1", cwd=cwd).stdout)


def everything(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def policy(body: str, ns: str = "/", *, twice: bool = False) -> str:
    enclave = f'<enclave path="/e"><profiles><profile ns="{ns}" node="a">{body}</profile></profiles></enclave>'
    return f'<policy version="0.2.0"><enclaves>{enclave * (1 + twice)}</enclaves></policy>'


def elements(path: Path) -> set[tuple[str, str]]:
    graph = rosprivacy.analyze([str(path)]).analysis.graph
    return {(element.kind, element.name) for element in graph.elements}
