"""JSON5 -> values that know their line; what is not JSON5 is refused at its line."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import json5
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.errors import PolicyError
from rosprivacy.ingest.deployed.access_file import MAX_BYTES, parse_json5, read_json5
from rosprivacy.ingest.reading.yaml_values import parse as parse_yaml

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.ingest.reading.yaml_values import Value

WRITTEN = """\ufeff// a comment with "quotes" and {
{
  id: 'one', /* two
  lines */ "key": [1, +.5, 0x1F,
    "a//b", 'it\\'s', "two\\
lines",
  ],
  nothing: null, // {
  on: true,
}
"""


def fail(line: int, problem: str, hint: str) -> PolicyError:
    return PolicyError("f.json5", line, problem, hint)


def test_values_know_their_lines() -> None:
    top = parse_json5(WRITTEN, fail)
    assert [(key, line, value.kind, value.text) for key, line, value in top.entries] == [
        ("id", 3, "text", "one"),
        ("key", 4, "list", ""),
        ("nothing", 8, "empty", "null"),
        ("on", 9, "number", "true"),
    ]
    listed = top.get("key")
    assert listed is not None
    assert [(item.line, item.kind, item.text) for item in listed.items] == [
        (4, "number", "1"),
        (4, "number", "+.5"),
        (4, "number", "0x1F"),
        (5, "text", "a//b"),
        (5, "text", "it's"),
        (5, "text", "twolines"),
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{\n a: 1,\n b: }", 'f.json5:3: not JSON5: Unexpected "}" at column 5; correct the syntax'),
        ("", "f.json5:1: not JSON5: Empty strings are not legal JSON5; correct the syntax"),
        ("{a: 1,\n a: 2}", "f.json5:2: 'a' again, first in line 1; merge the two"),
        ("[" * 5000 + "]" * 5000, "f.json5:1: nested more deeply than can be read; write it flatter"),
    ],
)
def test_what_is_no_json5_is_refused_at_its_line(text: str, message: str) -> None:
    with pytest.raises(PolicyError) as caught:
        parse_json5(text, fail)
    assert str(caught.value) == message


def test_a_large_file_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "large.json5"
    file.write_text(" " * (MAX_BYTES + 1), "utf-8")
    with pytest.raises(PolicyError, match=f"more than {MAX_BYTES} bytes"):
        read_json5(str(file), fail)


def plain(value: Value) -> Any:
    if value.kind == "map":
        return {key: plain(child) for key, _, child in value.entries}
    if value.kind == "list":
        return [plain(item) for item in value.items]
    return value.text if value.kind == "text" else json5.loads(value.text)


TREES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.text(st.characters(exclude_categories=["Cs"])),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(st.characters(exclude_categories=["Cs"])), inner),
    max_leaves=10,
)


@given(TREES)
def test_what_is_written_is_what_is_read(tree: Any) -> None:
    for text in (json.dumps(tree, indent=1, ensure_ascii=False), json5.dumps(tree, quote_keys=False)):
        assert plain(parse_json5(text, fail)) == tree
    if tree is not None:
        assert parse_json5(json.dumps([tree], indent=1), fail) == parse_yaml(
            "{" + f'"a": {json.dumps([tree], indent=1)}' + "}", fail
        ).get("a")
