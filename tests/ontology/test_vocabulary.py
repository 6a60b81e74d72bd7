"""Categories: the shipped ontology, names that find one, the hierarchy, and a cache that may vanish or rot."""

from __future__ import annotations

import hashlib
import re
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.analysis.hierarchy import Hierarchy
from rosprivacy.analysis.model import Category
from rosprivacy.ontology import vocabulary
from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize(
    "text",
    [
        "FaceTemplate", "facetemplate", "face template", "Face Embedding", "urn:x-rosprivacy:FaceTemplate",
        "https://w3id.org/rosprivacy#FaceTemplate", "https://w3id.org/rosprivacy#facetemplate", "rp:FaceTemplate",
    ],
)  # fmt: skip
def test_a_category_is_found_by_name_title_synonym_and_iri(text: str) -> None:
    category = load().find(text)
    assert category is not None
    assert category.name == "FaceTemplate"
    assert category.iri == "urn:x-rosprivacy:FaceTemplate"


def test_one_that_is_not_there_is_not_found_but_its_neighbours_are() -> None:
    assert load().find("Vidoe") is None
    assert load().nearest("Vidoe")[0] == "Video"
    assert load().nearest("qqqqqq") == []


def test_the_hierarchy_is_closed_with_the_least_distance() -> None:
    rows = {"A": (), "B": ("A",), "C": ("B",), "D": ("C", "A"), "E": ("elsewhere",)}
    closed = Hierarchy.of(Category(n, n, n, n, n, up) for n, up in rows.items())
    assert closed.ancestors["D"] == {"D": 0, "C": 1, "A": 1, "B": 2}
    assert closed.distance("C", "A") == 2
    assert closed.distance("A", "C") is None
    assert closed.broader("D") == ["A", "C", "B"]
    assert closed.narrowest({"A", "C", "E"}) == ("C", "E")


MINE = """\
@prefix :     <urn:example:clinic:> .
@prefix rp:   <urn:x-rosprivacy:> .
@prefix pd:   <https://w3id.org/dpv/pd#> .
@prefix skos: <http://www.w3.org/2004/02/skos/core#> .

:PulseCurve a skos:Concept ;
    rp:label "PulseCurve" ; skos:broader rp:Health ;
    skos:prefLabel "pulse curve"@en , "Pulskurve"@de ;
    skos:definition "The pulse of a patient over time."@en ;
    rp:dataType "number" ; rp:identityFactor "physiological" .
:WardBadge a skos:Concept ;
    rp:label "WardBadge" ; skos:broader rp:PersonalData , pd:OfficialID ;
    skos:prefLabel "ward badge"@en ;
    skos:definition "The badge of a member of the staff."@en ;
    rp:article9 "no" ; rp:reason "it says who works here, nothing else"@en .
"""
EMPTY = "@prefix skos: <http://www.w3.org/2004/02/skos/core#> ."


class TestOwnOntology:
    @pytest.fixture
    def mine(self, tmp_path: Path) -> Path:
        path = tmp_path / "mine.ttl"
        path.write_text(MINE, "utf-8")
        return path

    def test_its_categories_stand_beside_ours(self, mine: Path, tmp_path: Path) -> None:
        found = load(tmp_path / "cache", [str(mine)])
        assert set(found.categories) == {*load().categories, "PulseCurve", "WardBadge"}
        assert found.find("Pulskurve") == found.categories["PulseCurve"]
        assert "PersonalData" in found.hierarchy.ancestors["PulseCurve"]
        assert found.sources == ((str(mine), hashlib.sha256(mine.read_bytes()).hexdigest()),)

    def test_without_what_checks_it_none_is_read_unless_it_was_checked_before(
        self, mine: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        checked = load(tmp_path / "cache", [str(mine)])
        monkeypatch.setitem(sys.modules, "pyshacl", None)
        vocabulary._vocabulary.cache_clear()
        assert load(tmp_path / "cache", [str(mine)]) == checked
        with pytest.raises(InputErrors) as refused:
            load(tmp_path / "empty", [str(mine), str(mine.with_name("mine.ttl"))])
        (line,) = map(str, refused.value.errors)
        assert line.startswith(f"{mine}: ")
        assert "pyshacl is not installed; install " in line
        assert refused.value.exit_code == 2

    def test_the_law_of_broader_ones_holds_unless_something_is_stated(self, mine: Path, tmp_path: Path) -> None:
        found = load(tmp_path / "cache", [str(mine)]).categories
        assert (found["PulseCurve"].article9, found["PulseCurve"].stated_of) == ("always", ("Health",))
        assert (found["WardBadge"].article9, found["WardBadge"].law) == ("no", ())

    def test_the_identity_factor_is_what_the_file_says_and_is_not_inherited(self, mine: Path, tmp_path: Path) -> None:
        """As the data type: a narrower kind can tell of something else, so what is not said is not known."""
        found = load(tmp_path / "cache", [str(mine)]).categories
        assert found["PulseCurve"].identity_factors == ("physiological",)
        assert found["WardBadge"].identity_factors == ()

    @pytest.mark.slow
    def test_a_second_reading_needs_no_rdflib_and_gives_the_same(self, mine: Path, tmp_path: Path) -> None:
        code = (
            "import sys, pathlib\nfrom rosprivacy.ontology.vocabulary import load\n"
            f"found = load(pathlib.Path({str(tmp_path / 'cache')!r}), [{str(mine)!r}])\n"
            "print(sorted(found.categories), 'rdflib' in sys.modules)"
        )
        runs = [subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True) for _ in "12"]
        assert [done.stdout.split()[-1] for done in runs] == ["True", "False"]
        assert runs[0].stdout.rpartition(" ")[0] == runs[1].stdout.rpartition(" ")[0]

    @pytest.mark.slow
    @pytest.mark.parametrize(
        ("old", "new", "problem"),
        [
            ("skos:broader rp:Health", "skos:broader :PulseCurve", "is broader than itself"),
            ("skos:broader rp:Health", "skos:broader :B . :B a skos:Concept ; skos:broader :PulseCurve", "than itself"),
            ('"WardBadge"', '"PulseCurve"', "has the name 'PulseCurve', and so has <urn:example:clinic:PulseCurve> "),
            ('skos:prefLabel "pulse curve"@en , "Pulskurve"@de ;', "", "PulseCurve> has no English name"),
            ("rp:Health", "rp:Helth", "has the unknown parent <https://w3id.org/rosprivacy#Helth>"),
            ("skos:broader rp:Health ;", "", "has no parent among the categories"),
            ("skos:broader rp:Health", "skos:broader pd:Purchase", "leads to none of the shipped categories"),
            ('rp:label "PulseCurve"', 'rp:label "X`) DETACH DELETE n //"', "label"),
            ('"physiological"', '"physiologic"', "PulseCurve> has an unknown identity factor; write one of name"),
            (":PulseCurve a skos:Concept ;", ":PulseCurve a skos:Concept", "not Turtle"),
            (":PulseCurve a", "rp:Video a", "is there already; what is there is not changed"),
            (":PulseCurve a", "[] a", "has no IRI of its own"),
            (MINE, EMPTY, "has no category"),
            (MINE, "", "has no category"),
        ],
    )
    def test_each_fault_is_one_line_with_the_subject_and_what_to_do(  # what shapes refuse: test_shapes
        self, mine: Path, tmp_path: Path, old: str, new: str, problem: str
    ) -> None:
        assert old in MINE
        mine.write_text(MINE.replace(old, new, 1), "utf-8")
        with pytest.raises(InputErrors) as caught:
            load(tmp_path / "cache", [str(mine)])
        lines = str(caught.value).splitlines()
        assert any(problem in line for line in lines), lines
        assert all(re.match(rf"{re.escape(str(mine))}(:\d+)?: .+; .+", line) for line in lines)
        assert not (tmp_path / "cache").exists()

    def test_the_line_is_that_of_the_subject(self, mine: Path, tmp_path: Path) -> None:
        mine.write_text(MINE.replace("rp:PersonalData , pd:OfficialID", "pd:Purchase"), "utf-8")
        line = MINE.splitlines().index(":WardBadge a skos:Concept ;") + 1
        with pytest.raises(InputErrors, match=rf"mine\.ttl:{line}: "):
            load(tmp_path / "cache", [str(mine)])

    @pytest.mark.parametrize(
        ("data", "problem"),
        [(b"\xff\xfe", "not UTF-8"), (b"# " + b"x" * 50 * 2**20, "50 MB are too large"), (None, "is not a file")],
        ids=["bytes", "large", "nothing"],  # not 50 MB of a name
    )
    def test_what_cannot_be_read(self, tmp_path: Path, data: bytes | None, problem: str) -> None:
        path = tmp_path / "bad.ttl"
        if data is not None:
            path.write_bytes(data)
        with pytest.raises(InputErrors, match=problem):
            load(tmp_path / "cache", [str(path)])


def test_a_former_spelling_of_a_term_is_known() -> None:
    assert load().respelt_as("pd:Behavioral") == "https://w3id.org/dpv/pd#Behavioural"
    assert load().respelt_as("pd:Behavioural") is None


def anew(folder: Path) -> vocabulary.Vocabulary:
    """Read as another process does, which remembers nothing."""
    vocabulary._vocabulary.cache_clear()
    return load(folder)


class TestCache:
    def test_it_gives_what_was_read(self, tmp_path: Path) -> None:
        first, second = anew(tmp_path), anew(tmp_path)
        assert first == second
        assert len(list(tmp_path.iterdir())) == 1

    @pytest.mark.parametrize("damage", ["", "{", "[]", '{"key": 1}', "0\n{}", "swap"])
    def test_a_damaged_one_is_not_trusted(self, tmp_path: Path, damage: str) -> None:
        whole = anew(tmp_path)
        (file,) = tmp_path.iterdir()
        text = file.read_text()
        file.write_text(text.replace("FaceTemplate", "Facetemplate") if damage == "swap" else damage)
        assert anew(tmp_path) == whole
        assert file.read_text() == text  # and written anew

    def test_a_folder_that_cannot_be_written_is_no_error(self, tmp_path: Path) -> None:
        (tmp_path / "file").write_text("")
        assert anew(tmp_path / "file" / "below").categories

    @pytest.mark.slow
    def test_a_full_disk_leaves_nothing_behind(self, tmp_path: Path) -> None:
        """A temporary file stayed for each run."""
        code = (
            "import resource, signal, sys\n"
            "from pathlib import Path\n"
            "from rosprivacy.ontology.vocabulary import load\n"
            "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
            "resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000))\n"
            f"assert load(Path({str(tmp_path)!r})).categories\n"
        )
        subprocess.run([sys.executable, "-B", "-c", code], check=True, timeout=60)
        assert list(tmp_path.iterdir()) == []

    @pytest.mark.slow
    def test_two_that_write_it_at_once(self, tmp_path: Path) -> None:
        code = (
            f"from pathlib import Path; from rosprivacy.ontology.vocabulary import load; load(Path({str(tmp_path)!r}))"
        )
        both = [subprocess.Popen([sys.executable, "-c", code]) for _ in range(2)]
        assert [process.wait(60) for process in both] == [0, 0]
        (file,) = tmp_path.iterdir()
        written = file.read_bytes()
        anew(tmp_path)
        assert file.read_bytes() == written
