"""What a user's ontology may not say, by the command: names that mean two kinds, and hierarchy that is not followed.

Each of these was taken without a word once, and a leak was lost: a name found the kind that comes first in the
alphabet, and a statement about the hierarchy was none (rule S7: broader covers narrower).
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ontology.vocabulary import load
from tests.helpers.command import Cli, cli, refused

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.slow  # half a second each: the shapes are asked of the whole ontology

__all__ = ["cli"]

HEAD = """\
@prefix : <urn:e:> .
@prefix rp: <urn:x-rosprivacy:> .
@prefix pd: <https://w3id.org/dpv/pd#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix skos: <http://www.w3.org/2004/02/skos/core#> .
"""
A = """\
:A a skos:Concept ; rp:label "Aa" ; skos:broader rp:Health ;
    skos:prefLabel "first thing"@en ;
    skos:definition "The first."@en .
"""
B = A.replace(":A ", ":B ").replace("Aa", "Bb").replace("first", "second")
A_LINE = HEAD.count("\n") + 1
B_LINE = A_LINE + A.count("\n")
VIDEO = "<https://w3id.org/rosprivacy#Video>"
LAST = B_LINE + B.count("\n")  # of a statement after both

POLICY = """\
<policy version="0.2.0"><enclaves><enclave path="/r"><profiles>
  <profile ns="/" node="camera"><topics publish="ALLOW"><topic>audio</topic></topics></profile>
  <profile ns="/" node="uplink"><topics subscribe="ALLOW"><topic>audio</topic></topics></profile>
</profiles></enclave></enclaves></policy>
"""
LABELS = "labels: 1\nnodes:\n  /camera: {source: [Voice]}\n  /uplink: {leak: [voice]}\n"


def said(cli: Cli, folder: Path, *files: str) -> list[str]:
    """What is said of files that are refused; each is ``a.ttl``, ``b.ttl``, … and gets the prefixes."""
    options: list[str] = []
    for name, text in zip("abc", files, strict=False):
        (folder / f"{name}.ttl").write_text(HEAD + text, "utf-8")
        options += ["--ontology", f"{name}.ttl"]
    return refused(cli("categories", *options, cwd=folder))


@pytest.fixture(autouse=True)
def _no_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))


class TestNames:
    def test_no_name_of_a_shipped_kind_finds_another_one(self, cli: Cli, tmp_path: Path) -> None:
        """The label ``voice`` meant :A, and so the leak was none; a ``conduit: [Voice]`` made it no-leak-found."""
        (tmp_path / "p.policy.xml").write_text(POLICY, "utf-8")
        (tmp_path / "l.yaml").write_text(LABELS, "utf-8")
        (tmp_path / "a.ttl").write_text(HEAD + A.replace("skos:def", 'skos:altLabel "voice"@en ; skos:def'), "utf-8")
        command = ("analyze", "p.policy.xml", "-l", "l.yaml")
        assert cli(*command, cwd=tmp_path).returncode == 1
        (line,) = refused(cli(*command, "--ontology", "a.ttl", cwd=tmp_path))
        assert line.startswith(f"a.ttl:{A_LINE}: <urn:e:A> has the name 'voice', ")

    @pytest.mark.parametrize(
        ("statement", "name", "other"),
        [
            ('skos:altLabel "face embedding"@en', "face embedding", "FaceTemplate"),
            ('skos:altLabel "Stimme"@de', "Stimme", "Voice"),
            ('skos:altLabel "STIMME"@sv', "STIMME", "Voice"),
            ('skos:altLabel "urn:x-rosprivacy:voice"', "https://w3id.org/rosprivacy#voice", "Voice"),
            ('skos:prefLabel "voix"@fr', "voix", "Voice"),
        ],
    )
    def test_in_all_languages_and_without_case(
        self, cli: Cli, tmp_path: Path, statement: str, name: str, other: str
    ) -> None:
        (line,) = said(cli, tmp_path, A.replace("skos:def", f"{statement} ; skos:def"))
        assert line.startswith(f"a.ttl:{A_LINE}: <urn:e:A> has the name '{name}', ")
        assert f"<https://w3id.org/rosprivacy#{other}>, which comes with the program; " in line

    @pytest.mark.parametrize(("old", "new"), [('"Aa"', '"video"'), (":A ", "<urn:e:sub/VIDEO> ")])
    def test_of_labels_and_iris_too(self, cli: Cli, tmp_path: Path, old: str, new: str) -> None:
        (line,) = said(cli, tmp_path, A.replace(old, new))
        assert re.match(
            rf"a\.ttl:{A_LINE}: <urn:e:.*> has the name '(?i:video)', .*<https://w3id.org/rosprivacy#Video>", line
        )

    @pytest.mark.parametrize("both", ["one", "two"])
    def test_two_kinds_of_users_with_one_name(self, cli: Cli, tmp_path: Path, both: str) -> None:
        first = A.replace("skos:def", 'skos:altLabel "thing"@en ; skos:def')
        second = B.replace("skos:def", 'skos:altLabel "Thing"@de ; skos:def')
        files = (first + second,) if both == "one" else (first, second)
        file, at = ("a.ttl", B_LINE) if both == "one" else ("b.ttl", A_LINE)
        (line,) = said(cli, tmp_path, *files)
        assert line == (
            f"{file}:{at}: <urn:e:B> has the name 'Thing', and so has <urn:e:A> (a.ttl:{A_LINE}); take another name"
        )

    def test_a_term_of_dpv_is_the_match_of_one_kind(self, cli: Cli, tmp_path: Path) -> None:
        (line,) = said(cli, tmp_path, A.replace("skos:def", "skos:exactMatch pd:FacialPrint ; skos:def"))
        assert line.startswith(
            f"a.ttl:{A_LINE}: <urn:e:A> has the exact match <https://w3id.org/dpv/pd#FacialPrint>, and so has "
            "<https://w3id.org/rosprivacy#FaceTemplate>, which comes with the program; "
        )

    def test_names_of_one_kind_may_be_alike(self, cli: Cli, tmp_path: Path) -> None:
        text = A.replace("skos:def", 'skos:altLabel "AA"@en , "aa"@de , "First Thing"@de ; skos:def')
        (tmp_path / "a.ttl").write_text(HEAD + text, "utf-8")
        done = cli("categories", "--ontology", "a.ttl", "aa", cwd=tmp_path)
        assert (done.returncode, done.stderr) == (0, "")
        assert "urn:e:A" in done.stdout


class TestHierarchy:
    @pytest.mark.parametrize(
        ("statement", "target", "instead"),
        [
            (":A skos:narrower :B", "<urn:e:B>", "skos:broader on the narrower kind"),
            (":A skos:narrower rp:Video", VIDEO, "on the narrower kind"),
            (":A skos:narrowerTransitive :B", "<urn:e:B>", "on the narrower kind"),
            (":A skos:broaderTransitive rp:Video", VIDEO, "on the narrower kind"),
            (":A rdfs:subClassOf rp:Video", VIDEO, "on the narrower kind"),
            (":A skos:broadMatch rp:Video", VIDEO, "write skos:broader"),
            (":A skos:broadMatch :B", "<urn:e:B>", "write skos:broader"),
            (":A skos:narrowMatch rp:Video", VIDEO, "write skos:broader"),
            (":A skos:exactMatch rp:Video", VIDEO, "write skos:broader"),
            (":A skos:closeMatch rp:Video", VIDEO, "write skos:broader"),
            (":A owl:sameAs rp:Video", VIDEO, "write skos:broader"),
            ("pd:Salary skos:broader rp:Video", VIDEO, "kind of this file"),
            (":C skos:broader rp:Video", VIDEO, "a skos:Concept"),
        ],
    )
    def test_what_is_not_followed_is_refused_with_its_line(
        self, cli: Cli, tmp_path: Path, statement: str, target: str, instead: str
    ) -> None:
        """Also where the statement stands far from what else is said of its subject."""
        (line,) = said(cli, tmp_path, f"{A}{B}{statement} .\n")
        assert re.match(rf"a\.ttl:{LAST}: <\S+> says {statement.split()[1]} {target}", line), line
        assert instead in line.partition("; ")[2]

    @pytest.mark.parametrize(
        "statement",
        [
            "rp:Video skos:broader :A",
            "rp:Video rdfs:subClassOf :A",
            'rp:Video skos:altLabel "moving pictures"@en',
            'rp:GDPR-9-1-health skos:definition "Something else."@en',
        ],
    )
    def test_nothing_shipped_is_spoken_about(self, cli: Cli, tmp_path: Path, statement: str) -> None:
        (line,) = said(cli, tmp_path, f"{A}{B}{statement} .\n")
        assert line.startswith(f"a.ttl:{LAST}: <https://w3id.org/rosprivacy#")
        assert "comes with the program and cannot be changed; " in line
        assert "skos:broader" in line

    def test_nor_what_an_earlier_file_defines(self, cli: Cli, tmp_path: Path) -> None:
        (line,) = said(cli, tmp_path, A, f"{B}:A skos:broader rp:Video .\n")
        assert line.startswith(f"b.ttl:{B_LINE}: <urn:e:A> is defined by another file (a.ttl:{A_LINE}); ")

    def test_the_line_within_a_block_is_that_of_the_statement(self, cli: Cli, tmp_path: Path) -> None:
        (line,) = said(cli, tmp_path, A.replace(";\n    skos:def", ";\n    skos:narrower :B ;\n    skos:def") + B)
        assert line.startswith(f"a.ttl:{A_LINE + 2}: <urn:e:A> says skos:narrower <urn:e:B>")

    def test_matches_with_other_vocabularies_stay(self, cli: Cli, tmp_path: Path) -> None:
        matches = "skos:exactMatch pd:Salary ; skos:broadMatch pd:Financial ; skos:closeMatch <urn:f:X>"
        (tmp_path / "a.ttl").write_text(f"{HEAD}{A}:A {matches} .\n", "utf-8")
        done = cli("categories", "--ontology", "a.ttl", "pd:Salary", cwd=tmp_path)
        assert (done.returncode, done.stderr) == (0, "")
        assert "urn:e:A" in done.stdout

    def test_a_kind_below_one_of_an_earlier_file_is_a_kind_of_it(self, cli: Cli, tmp_path: Path) -> None:
        """It was a kind of nothing, so a leak of Health let it pass (rule S7)."""
        (tmp_path / "a.ttl").write_text(HEAD + A, "utf-8")
        (tmp_path / "b.ttl").write_text(HEAD + B.replace("rp:Health", ":A"), "utf-8")
        (tmp_path / "p.policy.xml").write_text(POLICY, "utf-8")
        labels = LABELS.replace("Voice", "B").replace("voice", "Health")
        (tmp_path / "l.yaml").write_text(labels, "utf-8")
        files = ("--ontology", "a.ttl", "--ontology", "b.ttl")
        done = cli("analyze", "p.policy.xml", "-l", "l.yaml", *files, cwd=tmp_path)
        assert (done.returncode, done.stderr) == (1, "")


CARE = "rp:context rp:CareContext ; rp:provision rp:GDPR-88"
REVEAL = 'rp:verdict "may-reveal" ; rp:condition "x"@en'


@pytest.mark.parametrize(
    ("said", "message"),
    [
        (f"rp:inContext [ rp:context rp:Market ; rp:provision rp:GDPR-88 ; {REVEAL} ]", "a context that is not known"),
        (f'rp:inContext [ {CARE} ; rp:verdict "always" ]', "something else of a context than what may be revealed"),
        (f"rp:inContext [ rp:context rp:CareContext ; {REVEAL} ]", "what no known provision speaks of"),
        ("rp:lookAt rp:NoLaw", "points at a provision that is not known"),
    ],
)
def test_contexts_and_pointers_that_are_none(tmp_path: Path, said: str, message: str) -> None:
    file = tmp_path / "mine.ttl"
    file.write_text(
        f'{HEAD}\n:Bed a skos:Concept ; rp:label "Bed" ; skos:broader rp:Location ; skos:prefLabel "bed sensor"@en ;\n'
        f'  skos:definition "Who lies in a bed."@en ; {said} .\n',
        "utf-8",
    )
    with pytest.raises(InputErrors) as raised:
        load(ontologies=[str(file)])
    assert message in str(raised.value)
