"""Policies with includes, and what is read from them."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.policies.policy_xml import read_policy

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.analysis.model import Policy


LINE = re.compile(r"[^;]+: .+; .+")


NEW, OLD = "http://www.w3.org/2001/XInclude", "http://www.w3.org/2003/XInclude"


CHILDREN = 'xpointer="xpointer(/profile/*)"'


HIDDEN = '<profile><topics publish="ALLOW"><topic>secret</topic></topics></profile>'


def topic(name: str) -> str:
    return f'<topics publish="ALLOW"><topic>{name}</topic></topics>'


def include(href: str, rest: str = CHILDREN, namespace: str = NEW) -> str:
    return f'<xi:include xmlns:xi="{namespace}" href="{href}" {rest}/>'


def write(file: Path, text: str) -> Path:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)
    return file


def policy(folder: Path, *bodies: str, name: str = "p.xml") -> Path:
    """A policy with one profile for each body: a, b, …"""
    profiles = "".join(f'<profile ns="/" node="{chr(97 + i)}">{body}</profile>' for i, body in enumerate(bodies))
    enclaves = f'<enclaves><enclave path="/e"><profiles>{profiles}</profiles></enclave></enclaves>'
    return write(folder / name, f'<policy version="0.2.0">{enclaves}</policy>')


def read(file: Path, **options: Any) -> Policy:
    return read_policy(str(file), **options)


def refused(file: Path, **options: Any) -> list[str]:
    with pytest.raises(InputErrors) as caught:
        read(file, **options)
    lines = str(caught.value).split("\n")
    assert all(LINE.fullmatch(line) for line in lines)
    return lines


def names(policy: Policy) -> list[str]:
    return [grant.name for grant in policy.grants]


def places(policy: Policy, folder: Path) -> list[str]:
    return [str(grant.place).removeprefix(f"{folder}/") for grant in policy.grants]
