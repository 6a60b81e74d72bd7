"""YAML or JSON from anybody: values that know their line, or one problem at its line; nothing is built or called."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest
import yaml

from rosprivacy.analysis.errors import LabelError
from rosprivacy.ingest.reading import yaml_values

if TYPE_CHECKING:
    from pathlib import Path

    from rosprivacy.ingest.reading.yaml_values import Value

LINE = re.compile(r".+:\d+: .+; .+")


def fail(line: int, problem: str, hint: str) -> LabelError:
    return LabelError("f.yaml", line, problem, hint)


def parse(text: str) -> Value:
    return yaml_values.parse(text, fail)


def plain(value: Value) -> object:
    """A value without its lines."""
    if value.kind == "map":
        return {key: plain(child) for key, _, child in value.entries}
    if value.kind == "list":
        return [plain(item) for item in value.items]
    return None if value.kind == "empty" else value.text


def refused(text: str) -> tuple[int, str]:
    with pytest.raises(LabelError) as caught:
        parse(text)
    assert LINE.fullmatch(str(caught.value))
    return caught.value.line, caught.value.problem


def refused_file(file: str) -> str:
    with pytest.raises(LabelError) as caught:
        yaml_values.read(file, fail)
    assert re.fullmatch(".+: .+; .+", str(caught.value))
    return str(caught.value).removeprefix("f.yaml:").strip()


# ---------------------------------------------------------------- values


@pytest.mark.parametrize(
    ("text", "kind", "written"),
    [
        ("Video", "text", "Video"),
        ("'1'", "text", "1"),  # quoted is text
        ('"true"', "text", "true"),
        ("1", "number", "1"),
        ("1.5", "number", "1.5"),
        ("true", "number", "true"),
        ("off", "number", "off"),  # YAML 1.1
        ("2024-01-01", "number", "2024-01-01"),
        ("null", "empty", "null"),
        ("~", "empty", "~"),
        ("[]", "list", ""),
        ("{}", "map", ""),
        ("|\n  a\n  b\n", "text", "a\nb\n"),
        ("!!python/object/apply:os.system [x]", "list", ""),  # tags build nothing
    ],
)
def test_a_value_has_a_kind_and_its_text(text: str, kind: str, written: str) -> None:
    value = parse(text)
    assert (value.kind, value.text) == (kind, written)


def test_every_value_and_key_knows_its_line() -> None:
    top = parse("# x\na: 1\n\nb:\n  - c\n  - {d: e,\n     f: g}\n")
    assert [(key, line) for key, line, _ in top.entries] == [("a", 2), ("b", 4)]
    second = top.get("b")
    assert second is not None
    assert [item.line for item in second.items] == [5, 6]
    assert [(key, line) for key, line, _ in second.items[1].entries] == [("d", 6), ("f", 7)]
    assert top.get("z") is None


@pytest.mark.parametrize(
    ("text", "data"),
    [
        ('{"a": ["b", {"c": null}]}', {"a": ["b", {"c": None}]}),
        ('{\t"a":\t[\n\t\t"b"\n\t]\n}', {"a": ["b"]}),  # tabs between tokens
        ('{"a":"b"}', {"a": "b"}),
        ('{"a\\tb": "\\u00e9\\/"}', {"a\tb": "é/"}),
        ('{"a": "\\ud83d\\ude00"}', {"a": "\U0001f600"}),  # a surrogate pair is one character
        ('{"\\ud83d\\ude00": "x"}', {"\U0001f600": "x"}),
        ('{"a": "\\ud83d"}', {"a": "\ufffd"}),  # half of one is none
        ('{"a"\n: "b"}', {"a": "b"}),  # JSON does not care where lines end
        ('{"%s": "b"}' % ("a" * 2000), {"a" * 2000: "b"}),  # YAML's short keys end at 1024
        ('{"a": "x\u2028y\x7fz"}', {"a": "x\u2028y\x7fz"}),  # YAML would fold the one and refuse the other
        ('{"a": "no", "b": "1", "c": "~"}', {"a": "no", "b": "1", "c": "~"}),
        ('\ufeff{"a": "b"}'.removeprefix("\ufeff"), {"a": "b"}),
    ],
)
def test_json_is_read_as_json(text: str, data: object) -> None:
    assert plain(parse(text)) == data


def test_json_keeps_its_lines() -> None:
    top = parse('{\n\t"a": [\n\t\t"b",\n\t\t"c"\n\t]\n}')
    (only,) = top.entries
    assert (only[1], [item.line for item in only[2].items]) == (2, [3, 4])


def test_without_libyaml_the_same_is_read(monkeypatch: pytest.MonkeyPatch) -> None:  # wheels without the C parser
    text = "a: [b, {c: 1}]\n'd': |\n  x\n"
    quick = parse(text)
    monkeypatch.setattr(yaml_values, "_LOADER", yaml.SafeLoader)
    assert parse(text) == quick


# ---------------------------------------------------------------- what is refused


@pytest.mark.parametrize(
    ("text", "line", "problem"),
    [
        ("", 1, "the file is empty"),
        (" \n\t\n", 1, "the file is empty"),
        ("# only a comment\n", 1, "the file is empty"),
        ("a: b\n c: d\n", 2, "not YAML"),
        ("a: 'b\n", 2, "not YAML"),
        ("a: b\n---\na: c\n", 2, "not YAML"),
        ("a: b\n\tc: d", 2, "not YAML"),
        ('{"a": 1,, }', 1, "not YAML"),
        ("%YAML 9.9\n---\na: b", 1, "not YAML"),
        ("a: !<> b", 1, "not YAML"),
        ("a: b\nc: d\na: e", 3, "'a' again, first in line 1"),  # duplicate keys
        ('{"a": 1, "a": 2}', 1, "'a' again, first in line 1"),
        ("a: 1\n'a': 2", 2, "'a' again, first in line 1"),
        ("[a, b]: c", 1, "a key that is not a name"),
        ("a: b\n? {c: d}\n: e", 2, "a key that is not a name"),
    ],
)
def test_what_cannot_be_read_is_one_problem_at_its_line(text: str, line: int, problem: str) -> None:
    at, what = refused(text)
    assert (at, what[: len(problem)]) == (line, problem)


@pytest.mark.parametrize("text", ["a: b\n\nc: \x01", "a: b\n\nc: d\ue000\x00"])
def test_a_control_character_is_refused_at_its_line(text: str) -> None:
    line, problem = refused(text)
    assert (line, problem[:8]) == (3, "not YAML")


@pytest.mark.parametrize(
    "text",
    [
        "a: &x [b]\nc: *x",
        "a: &x {b: c}\nd: *x",
        "a: &x {b: c}\nd: {<<: *x}",  # merge keys
        "&x [*x]",  # without end
        "&x {a: *x}",
        "a: &x [b,b]\nc: &y [*x,*x]\nd: &z [*y,*y]\ne: [*z,*z]",  # a bomb
        "a: &x b\nc: *x",  # of a scalar too: long text, many times, is a bomb as well
        "a: &x b\n*x : c",
    ],
)
def test_anchors_and_aliases_are_refused(text: str) -> None:
    _, problem = refused(text)
    assert problem == "anchors and aliases are not read"


@pytest.mark.parametrize(
    "text",
    ["[" * 2000 + "]" * 2000, "{a: " * 2000 + "b" + "}" * 2000, '{"a": ' * 2000 + "1" + "}" * 2000, "- " * 2000 + "a"],
)
def test_what_is_nested_too_deeply_is_refused(text: str) -> None:
    _, problem = refused(text)
    assert problem in ("more than the bound of 64 levels of lists and maps", "nested more deeply than can be read")


@pytest.mark.parametrize("text", ["'[' * 60_000 + ']' * 60_000", "'{a: ' * 60_000 + '}' * 60_000", "'- ' * 60_000"])
def test_deep_nesting_does_not_end_the_process(text: str) -> None:  # libyaml's composer recurses on the C stack
    program = f"""
from rosprivacy.analysis.errors import LabelError
from rosprivacy.ingest.reading.yaml_values import parse
try:
    parse({text}, lambda *args: LabelError("f", *args))
except LabelError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert LINE.fullmatch(done.stdout.strip())


@pytest.mark.parametrize("text", ["a: b\x85: c", "'\n\x85\u2028'", "a: '\u202e'\nb: [", '"\\x00": ['])
def test_a_message_is_one_line_whatever_the_file_says(text: str) -> None:
    try:
        parse(text)
    except LabelError as error:
        assert LINE.fullmatch(str(error))  # noqa: PT017 - either will do


def test_a_long_key_does_not_make_a_long_message() -> None:
    key = "a" * 900
    assert len(refused(f"{key}: 1\n{key}: 2")[1]) < 300


# ---------------------------------------------------------------- files


def test_a_file_is_returned_with_the_bytes_that_were_read(tmp_path: Path) -> None:
    file = tmp_path / "f.yaml"
    file.write_bytes(b"\xef\xbb\xbfa: \xc3\xa9\r\n")  # a byte order mark and Windows' lines
    value, data = yaml_values.read(str(file), fail)
    assert (plain(value), data) == ({"a": "é"}, file.read_bytes())


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "1: the file is empty; "),
        (b"\xef\xbb\xbf", "1: the file is empty; "),
        (b"a: b\nc: caf\xe9\n", "2: not UTF-8; save the file as UTF-8"),
        ("a: b".encode("utf-16"), "1: not UTF-8; "),
        (b"\x00\xff\x00", "1: not UTF-8; "),
        (b"\xed\xa0\x80", "1: not UTF-8; "),  # a surrogate is no character
    ],
)
def test_a_file_that_is_no_utf8_text_is_refused(tmp_path: Path, data: bytes, message: str) -> None:
    file = tmp_path / "f.yaml"
    file.write_bytes(data)
    assert refused_file(str(file)).startswith(message)


def test_what_is_no_file_is_refused_and_does_not_wait(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    assert refused_file(str(tmp_path / "none")).startswith("file not found")
    assert refused_file(str(tmp_path)).startswith("not a regular file")
    assert refused_file(str(tmp_path / "pipe")).startswith("not a regular file")
    assert refused_file("/dev/zero").startswith("not a regular file")
    assert refused_file("a" * 5000).startswith("cannot be read")
    assert refused_file("a\0b").startswith("file not found")


def test_a_file_that_is_too_large_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(yaml_values, "MAX_BYTES", 10)
    (tmp_path / "f.yaml").write_text("a: bcdefgh")
    assert plain(yaml_values.read(str(tmp_path / "f.yaml"), fail)[0]) == {"a": "bcdefgh"}
    (tmp_path / "f.yaml").write_text("a: bcdefghi")
    assert refused_file(str(tmp_path / "f.yaml")).startswith("more than 10 bytes")
