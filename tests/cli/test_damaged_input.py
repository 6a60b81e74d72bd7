"""Files of ours that came to harm are refused in one line for each problem, exit code 2, whichever command reads them.

Saved analyses and saved graphs here; Parquet is in ``tests/parts/test_damaged_results.py``.
"""

from __future__ import annotations

import gzip
import json
import shutil
from random import Random
from typing import TYPE_CHECKING, Any

import pytest

from rosprivacy.analysis.errors import InputError
from rosprivacy.report.compare.earlier import read_earlier
from tests.helpers.command import Cli, refused
from tests.helpers.daily import one_in
from tests.helpers.damages import damaged, one_line_each
from tests.helpers.paths import ROOT, TESTS
from tests.helpers.policies import everything

if TYPE_CHECKING:
    from pathlib import Path

EARLIER = TESTS / "cases" / "earlier"
SYSTEM = ("care-home.policy.xml", "-l", "care-home.labels.yaml")
SIGNED = ("--reason", "x", "--owner", "y")
READERS = {
    "diff from": ("diff", "bad.json", "ok.json"),
    "diff to": ("diff", "ok.json", "bad.json", "-f", "markdown"),
    "since": ("report", *SYSTEM, "--since", "bad.json", "-f", "markdown", "-o", "r.md"),
    "since, redacted": ("report", *SYSTEM, "--since", "bad.json", "--redact", "-o", "r.html", "--lang", "de"),
    "decide": ("decide", "accept", "59dc", "--report", "bad.json", *SIGNED),
}
GRAPH_READERS = {
    "analyze": ("analyze", "--add", "bad.json", "-f", "json"),
    "analyze with labels": ("analyze", "--add", "bad.json", "-l", "care-home.labels.yaml", "-o", "a.txt"),
    "diff": ("diff", "bad.json", "care-home.policy.xml"),
    "report": ("report", "--add", "bad.json", "-l", "care-home.labels.yaml", "-f", "markdown", "-o", "r.md"),
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    shutil.copytree(ROOT / "examples" / "care-home", tmp_path, dirs_exist_ok=True)
    shutil.copyfile(EARLIER / "care-home" / "analysis.json", tmp_path / "ok.json")
    return tmp_path


def original(name: str) -> Any:
    return json.loads((EARLIER / name).read_text("utf-8"))


def changed(document: Any, way: str, value: Any = ...) -> bytes:
    """The document with another value at ``a.0.b``, or without what stands there."""
    *path, last = [int(step) if step.isdigit() else step for step in way.split(".")]
    inside = document
    for step in path:
        inside = inside[step]
    if value is ...:
        del inside[last]
    else:
        inside[last] = value
    return json.dumps(document).encode()


ANALYSIS = "care-home/analysis.json"
SAME = "verdict: leak", "nothing differs"  # the first line and the last
BYTES = [
    (b"", "bad.json: the file is empty; "),
    (b" \n", "bad.json: the file is empty; "),
    (gzip.compress(b"{}"), "bad.json: the file is compressed; unpack it with gunzip"),
    ("{}".encode("utf-16"), "bad.json:1: not UTF-8; let rosprivacy write the file with -o"),
    (b'{"format": "rosprivacy.analysis/1",\n"a\xff": 1}', "bad.json:2: not UTF-8; "),
    (b'{"format": "rosprivacy.analysis/1",\n"a": }', "bad.json:2: not JSON, or not to its end: "),
    (b'{"format": "rosprivacy.analysis/1", "a": NaN}', "bad.json: NaN is no number of JSON; "),
    (b'{"format": "rosprivacy.analysis/1", "a": 1e999}', "bad.json: a is too large a number; "),
    (b'{"format": "rosprivacy.analysis/1", "a": 1%s}' % (b"0" * 400), "bad.json: a is too large a number; "),
    (b'{"format": "rosprivacy.analysis/1", "a": 1%s}' % (b"0" * 5000), "bad.json: a number of thousands of digits; "),
    (b'{"format": "rosprivacy.analysis/1", "a": 1, "a": 1}', "bad.json: the key 'a' stands twice; "),
    (b'{"format": "rosprivacy.analysis/1", "a": [{"b": "\\ud800"}]}', "bad.json: a[0].b is no text: half of a "),
    (b'{"format": "rosprivacy.analysis/1", "\\udfff": 1}', "bad.json: the document has a key that is no text: half "),
    (b'{"format": "rosprivacy.analysis/1", "a": %s1%s}' % (b"[" * 90, b"]" * 90), " is nested too deeply; "),
    (b'{"format": "rosprivacy.analysis/1", "a": %s' % (b"[" * 90_000), "bad.json: nested too deeply; "),
    (b'{"format": "rosprivacy.analysis/3"}', "/3, and this version reads rosprivacy.analysis/1 and "),
    (b'{"format": "rosprivacy.diff/1"}', "bad.json: is not a document of the format rosprivacy.analysis/1; give what"),
    (b'["rosprivacy.analysis/1"]', "bad.json: is not a document of the format rosprivacy.analysis/1; give what"),
]  # fmt: skip
PLACES = [
    ("findings", ..., "the document lacks findings"),
    ("findings", {}, "findings is an object, not a list"),
    ("findings.0", [], "findings[0] is a list, not an object"),
    ("findings.0.source", None, "findings[0].source is null, not an object"),
    ("findings.0.source.name", ["/a"], "findings[0].source.name is a list, not text"),
    ("findings.0.source.kind", "robot", 'findings[0].source.kind is not "node" or '),
    ("findings.0.disjoint_paths", 1.0, "findings[0].disjoint_paths is a number, not a whole number"),
    ("findings.0.dismissed", 0, "findings[0].dismissed is a number, not true or false"),
    ("findings.0.steps.0.policy.0.line", "1", "findings[0].steps[0].policy[0].line is text, not a whole number"),
    ("findings.0.steps", [], "findings[0].steps are not as many as its witness has"),
    ("findings.0.witness", [], "findings[0].witness is empty"),
    ("findings.0.source.name", "/other", "findings[0].witness does not lead from its source to its leak"),
    ("findings.0.category", "Nothing", "findings[0].category is not in categories"),
    ("findings.1.id", "59dc667b0ca44e0f", " stands twice"),
    ("findings.0.kind", "rumour", 'findings[0].kind is not "disclosure" or '),
    ("findings.0.law.0", {}, "findings[0].law[0] lacks provision, verdict"),
    ("carries.0.categories", None, "carries[0].categories is null, not a list"),
    ("outside", [{"element": 1, "file": "f", "line": 1, "holds": []}], "outside[0].element is a number, not an object"),
    ("assumptions.policies.0.sha256", "x", "assumptions.policies[0].sha256 is not what the format says"),
    ("assumptions.policies", "x", "assumptions.policies is text, not a list"),
    ("verdict", "no-leak-found", "verdict is no-leak-found, and a finding stands in findings"),
    ("verdict", "compliant", 'verdict is not "leak" or "undetermined" or "no-leak-found"'),
]


def refused_as(cli: Cli, folder: Path, reader: str, said: str, data: bytes) -> None:
    (folder / "bad.json").write_bytes(data)
    there = everything(folder)
    (line,) = refused(cli(*READERS[reader], cwd=folder))
    assert said in line
    assert line.startswith("bad.json:")
    assert everything(folder) == there


@pytest.mark.parametrize("reader", one_in(5, READERS))
@pytest.mark.parametrize(("data", "said"), BYTES, ids=[said for _, said in BYTES])
def test_what_is_no_document_is_refused(cli: Cli, folder: Path, reader: str, data: bytes, said: str) -> None:
    if reader.startswith("diff") and b'"rosprivacy.analysis/' not in data:  # a policy or a fleet file, by its beginning
        (folder / "bad.json").write_bytes(data)
        lines = refused(cli(*READERS[reader], cwd=folder))
        assert all(line.startswith("bad.json:") for line in lines)
    else:
        refused_as(cli, folder, reader, said, data)


@pytest.mark.parametrize("reader", one_in(5, READERS))
@pytest.mark.parametrize(("way", "value", "said"), PLACES, ids=[said for *_, said in PLACES])
def test_a_damaged_analysis_is_refused_with_the_place(
    cli: Cli, folder: Path, reader: str, way: str, value: Any, said: str
) -> None:
    refused_as(cli, folder, reader, said, changed(original(ANALYSIS), way, value))


@pytest.mark.parametrize(
    ("way", "value", "said"),
    [
        ("fleet.patterns.0.finding", "0" * 16, "fleet.patterns[0].finding is not in findings"),
        ("fleet.patterns.0.dismissed", 10**6, "fleet.patterns[0].findings is less than it counts of them"),
        ("fleet.patterns.0.robots", ..., "fleet.patterns[0] lacks robots"),
        ("fleet.alike.0.robot", "nobody", "fleet.alike[0].robot is not in its robots"),
        ("fleet.alike.0", ..., "fleet.robots is not their number in fleet.alike and fleet.models"),
        ("fleet.robots", 3, "fleet.robots is not their number in fleet.alike and fleet.models"),
        ("fleet.models", {}, "fleet.robots is not their number in fleet.alike and fleet.models"),
        ("fleet", [], "fleet is a list, not an object"),
    ],
)
def test_a_damaged_analysis_of_a_fleet_is_refused_with_the_place(
    cli: Cli, folder: Path, way: str, value: Any, said: str
) -> None:
    refused_as(cli, folder, "decide", said, changed(original("fleet/analysis.json"), way, value))


def test_a_library_user_gets_an_input_error(folder: Path) -> None:
    """No KeyError, whatever is in the file; the documented class, of one problem, and how many more there are."""
    document = original(ANALYSIS)
    del document["open"]
    (folder / "bad.json").write_bytes(changed(document, "findings.0.kind", 1))
    with pytest.raises(InputError, match=r"damaged or changed: findings\[0\].kind is not .* \(1 more\); give what"):
        read_earlier(str(folder / "bad.json"))


@pytest.mark.parametrize("reader", READERS)
def test_no_file_and_a_folder_are_refused(cli: Cli, folder: Path, reader: str) -> None:
    refused(cli(*READERS[reader], cwd=folder))
    (folder / "bad.json").mkdir()
    refused(cli(*READERS[reader], cwd=folder))


def test_a_byte_order_mark_and_keys_that_are_not_known_are_read(cli: Cli, folder: Path) -> None:
    """A later version may add keys (DESIGN.md, Contracts); an editor adds the mark."""
    document = original(ANALYSIS)
    document["findings"][0]["new"] = document["new"] = {"a": [1.5]}
    (folder / "bad.json").write_bytes(b"\xef\xbb\xbf" + json.dumps(document).encode())
    done = cli("diff", "bad.json", "ok.json", cwd=folder)
    assert (done.returncode, *done.stdout.splitlines()[:1], done.stdout.splitlines()[-1]) == (0, *SAME)


BASES = ("6(1)(f)", "6(4)", "9(2)(h)", "9(3)", "10", "45", "46(2)(c)", "46(3)", "47", "49(1)(a)")


def test_what_is_written_today_is_read(cli: Cli, folder: Path) -> None:
    """With all that a decision can say."""
    bases = [word for basis in BASES for word in ("--legal-basis", basis)]
    cli("decide", "accept", "59dc", "--report", "ok.json", *SIGNED, *bases, "--expires", "2999-01-01", cwd=folder)
    cli("analyze", *SYSTEM, "--decisions", "decisions.jsonl", "-f", "json", "-o", "new.json", cwd=folder)
    assert json.loads((folder / "new.json").read_text("utf-8"))["decisions"][0]["legal_basis"] == [*BASES]
    done = cli("diff", "new.json", "new.json", cwd=folder)
    assert (done.returncode, *done.stdout.splitlines()[:1], done.stdout.splitlines()[-1]) == (0, *SAME)


GRAPHS = [
    ("policies", [], "policies is empty"),
    ("policies.0.grants.0.rule", "MAY", 'policies[0].grants[0].rule is not "ALLOW" or "DENY"'),
    ("policies.0.grants.0.line", 1.0, "policies[0].grants[0].line is a number, not a whole number"),
    ("policies.0.grants.0.line", -1, "policies[0].grants[0].line is not what the format says"),
    ("policies.0.grants.0.file", "x.xml", "policies[0].grants[0].file is not in the sources of its policy"),
    ("policies.0.grants.0.node", "/x", "policies[0].grants[0] is of a node that has no profile in its enclave"),
    ("policies.0.profiles.0", 5, "policies[0].profiles[0] is a number, not an object"),
    ("policies.0.sources", [], "policies[0].sources is a list, not an object"),
    ("policies.0.diagnostics", [{}], "policies[0].diagnostics[0] lacks file, line"),
    ("policies.0.grants.0.name", "/\ud800", "policies[0].grants[0].name is no text: half of a "),
    ("policies.0.grants.0.name", ["x"] * 10_000, "policies[0].grants[0].name is a list, not text"),
    ("not_read", [1], "not_read[0] is a number, not an object"),
    ("format", "rosprivacy.graph/2", "not a saved graph (rosprivacy.graph/1); use the version of rosprivacy"),
]


@pytest.mark.parametrize("reader", one_in(4, GRAPH_READERS))
@pytest.mark.parametrize(("way", "value", "said"), GRAPHS, ids=[said for *_, said in GRAPHS])
def test_a_damaged_graph_is_refused_with_the_place(
    cli: Cli, folder: Path, reader: str, way: str, value: Any, said: str
) -> None:
    (folder / "bad.json").write_bytes(changed(original("care-home/graph.json"), way, value))
    there = everything(folder)
    lines = refused(cli(*GRAPH_READERS[reader], cwd=folder))
    assert any(said in line for line in lines)
    assert all(line.startswith("bad.json: ") for line in lines)
    assert everything(folder) == there


# A few for each change; each week all, and the fuzzing (``tests/fuzzing``) makes others.
SEEDS = [0, *(pytest.param(n, marks=pytest.mark.slow if n < 4 else pytest.mark.thorough) for n in range(1, 30))]
DAMAGED = [
    *((reader, file) for reader in READERS.values() for file in (ANALYSIS, "fleet/analysis.json")),
    *((reader, "care-home/graph.json") for reader in GRAPH_READERS.values()),
]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("reader", "file"), DAMAGED, ids=lambda value: value if isinstance(value, str) else value[0])
def test_any_damage_ends_as_documented(cli: Cli, folder: Path, reader: tuple[str, ...], file: str, seed: int) -> None:
    data = damaged(Random(f"{reader} {file} {seed}"), (EARLIER / file).read_bytes())  # noqa: S311 - repeatable
    (folder / "bad.json").write_bytes(data)
    one_line_each(cli(*reader, cwd=folder), {0, 1, 2, 4})
