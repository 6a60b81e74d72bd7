"""What rdflib only logs is refused in our words, and nothing of rdflib's is on standard error."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.helpers.command import Cli, cli, refused

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["cli"]

HEAD = """\
@prefix : <urn:e:> .
@prefix rp: <urn:x-rosprivacy:> .
@prefix skos: <http://www.w3.org/2004/02/skos/core#> .
@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
"""
BADGE = """\
:Locker a skos:Concept ; rp:label "Locker" ; skos:broader rp:Health ;
    skos:prefLabel "locker"@en ;
    skos:definition "A locker."@en .
"""
AT = HEAD.count("\n") + 1


@pytest.fixture(autouse=True)
def _no_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        (":Locker a", "<urn:e:Lo cker> a", f"{AT}: <urn:e:Lo cker> has a sign that no IRI has; correct the IRI"),
        (":Locker a", "<urn:e:Lo\\u202Ecker> a", ": <urn:e:Lo\\u202ecker> has a sign that no IRI has; correct the IRI"),
        ("rp:Health", "rp:Health, <urn:x{y}>", "<urn:e:Locker> names <urn:x{y}>, which has a sign that no IRI has; "),
        ("skos:def", '<urn:a|b> "x" ; skos:def', "<urn:e:Locker> names <urn:a|b>, which has a sign that no IRI has; "),
        ("skos:def", 'skos:note "9-9"^^xsd:date ; skos:def', f"{AT + 2}: <urn:e:Locker> says '9-9', which is no date"),
        ("skos:def", "skos:note '1x'^^xsd:integer ; skos:def", "<urn:e:Locker> says '1x', which is no integer; "),
        ("skos:def", "skos:note '1'^^<urn:a b> ; skos:def", "<urn:e:Locker> names <urn:a b>, which has a sign that "),
        (":Locker a", "@prefix x: <urn:x y> .\n:Locker a", "<urn:x y> is a prefix with a sign that no IRI has; "),
    ],
)  # fmt: skip
def test_an_odd_term_is_refused_with_its_line(cli: Cli, tmp_path: Path, old: str, new: str, line: str) -> None:
    """Once read with 'does not look like a valid URI' or a traceback of rdflib on standard error."""
    (tmp_path / "own.ttl").write_text(HEAD + BADGE.replace(old, new), "utf-8")
    (said,) = refused(cli("categories", "--ontology", "own.ttl", cwd=tmp_path))
    assert said.startswith("own.ttl:")
    assert line in said


def test_a_relative_iri_in_a_folder_with_a_space_is_none(cli: Cli, tmp_path: Path) -> None:
    """The base of relative IRIs is the folder, and its name is no fault of the file."""
    (folder := tmp_path / "my {robots}").mkdir()
    (folder / "own.ttl").write_text(HEAD + BADGE.replace(":Locker a", "<#Locker> a"), "utf-8")
    done = cli("categories", "Locker", "--ontology", "own.ttl", cwd=folder)
    assert (done.returncode, done.stderr) == (0, "")
