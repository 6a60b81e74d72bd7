"""The measure of a scan, on a system made up for it: what counts as found, wrong, named and lost."""

from __future__ import annotations

import hashlib
import json
from typing import TYPE_CHECKING

from rosprivacy.ingest.scan.checkout import Checkout
from rosprivacy.ingest.scan.scan_facts import (
    CodeEndpoint,
    CodeFacts,
    CodeNode,
    CodePlace,
    Gap,
    LaunchedSystem,
    NamePiece,
    StartedNode,
)
from tests.scanned.measuring import measured, scanned_ends
from tests.scanned.truth import HERE, READERS, WRITTEN, End, Start, Truth, systems, truth

if TYPE_CHECKING:
    from pathlib import Path

CAMERA, LOST, OPEN = (CodePlace("cam.py", line) for line in (10, 20, 30))
NONE = Truth(frozenset(), frozenset(), frozenset(), frozenset(), frozenset(), frozenset())


def node(*endpoints: CodeEndpoint, name: str = "cam") -> CodeNode:
    return CodeNode(CodePlace("cam.py", 1), "Camera", "python", ((NamePiece(name),),), endpoints=endpoints)


def checkout(facts: CodeFacts, *launches: LaunchedSystem) -> Checkout:
    return Checkout("", facts, (), launches)


def published(place: CodePlace, *pieces: NamePiece) -> CodeEndpoint:
    return CodeEndpoint(place, "publish", (pieces,))


def test_a_name_is_that_of_a_start_without_a_launch_file() -> None:
    endpoints = (published(CAMERA, NamePiece("~/raw")), published(LOST, NamePiece("a", "default"), NamePiece("/b")))
    assert scanned_ends(CodeFacts((node(*endpoints),))) == {
        End("cam.py", 10, "publish", "/cam/raw"): "literal",
        End("cam.py", 20, "publish", "/a/b"): "default",
    }


def test_what_is_missed_is_named_by_a_gap_at_its_line_or_lost() -> None:
    true = NONE._replace(
        ends=frozenset(End("cam.py", place.line, "publish", f"/{place.line}") for place in (CAMERA, LOST, OPEN))
    )
    facts = CodeFacts((node(published(CAMERA, NamePiece("10"))),), (Gap(OPEN, "name", "depends on x"),))
    counts = measured("s", checkout(facts), true)
    assert (counts.found["python"], counts.named["python"], counts.lost["python"]) == (1, 1, 1)
    assert counts.precision("python") == 1.0


def test_an_open_piece_is_a_gap_and_a_name_of_one_is_wrong() -> None:
    true = NONE._replace(runtime=frozenset({("cam.py", 10, "publish"), ("cam.py", 20, "publish")}))
    open_name = published(CAMERA, NamePiece(None, why="argument"), NamePiece("/raw"))
    counts = measured("s", checkout(CodeFacts((node(open_name, published(LOST, NamePiece("made_up"))),))), true)
    assert (counts.found["runtime"], counts.wrong["python"]) == (1, 1)


def test_what_is_guessed_is_not_found_and_what_is_disputed_is_not_wrong() -> None:
    true = NONE._replace(
        ends=frozenset({End("cam.py", 10, "publish", "/x")}), disputed=frozenset({("cam.py", 20, "publish", "/y")})
    )
    endpoints = (published(CAMERA, NamePiece("x", "guessed")), published(LOST, NamePiece("y")))
    counts = measured("s", checkout(CodeFacts((node(*endpoints),))), true)
    assert (counts.found["python"], counts.wrong["python"]) == (0, 0)


def test_a_started_node_is_found_by_name_and_namespace_and_its_remaps_by_themselves() -> None:
    place = CodePlace("a.launch.py", 5)
    started = StartedNode(place, "p", "e", "n", "/ns", (("a", "b"),))
    launched = LaunchedSystem("a.launch.py", (started,))
    right = Start("a.launch.py", 5, "p", "e", "n", "ns", (("a", "b"),))
    counts = measured("s", checkout(CodeFacts(), launched), NONE._replace(started=frozenset({right})))
    assert (counts.found["started"], counts.found["remaps"]) == (1, 1)
    other = right._replace(remaps=(("a", "c"),))
    counts = measured("s", checkout(CodeFacts(), launched), NONE._replace(started=frozenset({other})))
    assert (counts.found["started"], counts.lost["remaps"]) == (1, 1)


def test_both_readers_have_to_say_it_without_a_doubt(tmp_path: Path) -> None:
    item = {"item": "endpoint", "file": "a.py", "role": "publishes", "known": "literal", "type": "", "class": "A"}
    said = {
        "reader_a": [(1, "/x", False), (2, "/y", False), (3, "/z", False)],
        "reader_b": [(1, "/x", False), (3, "/z", True)],
    }
    for reader, rows in said.items():
        (tmp_path / reader).mkdir()
        lines = [json.dumps({**item, "line": line, "name": name, "unsure": doubt}) for line, name, doubt in rows]
        (tmp_path / reader / "s.jsonl").write_text("\n".join(lines), "utf-8")
    true = truth("s", tmp_path)
    assert {end.line for end in true.ends} == {1}
    assert {one[1] for one in true.disputed} == {2, 3}


def test_half_of_the_systems_is_sealed_or_is_what_the_hashes_say() -> None:
    every = systems()
    sealed = {one.system for one in every if one.half == "sealed"}
    assert (len(every), len(sealed)) == (20, 10)
    lines = (HERE / "sealed.sha256").read_text("utf-8").splitlines()
    hashes = {name: digest for digest, _, name in (line.partition("  ") for line in lines)}
    assert {name.partition("/")[2].removesuffix(".jsonl") for name in hashes} == sealed
    for name, digest in hashes.items():
        file = HERE / f"reader_{name}"
        assert not file.is_file() or hashlib.sha256(file.read_bytes()).hexdigest() == digest
    assert all(
        (HERE / reader / f"{one.system}.jsonl").is_file()
        for reader in READERS
        for one in every
        if one.system not in sealed
    )


def test_the_roles_of_the_readers_are_those_of_policies() -> None:
    assert set(WRITTEN.values()) == {"publish", "subscribe", "reply", "request", "execute", "call"}
