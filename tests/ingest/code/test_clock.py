"""Time for one source file is bounded, and a file that was not read to its end is told by name (rule S11)."""

from __future__ import annotations

import json
import time
from typing import TYPE_CHECKING

import pytest

from rosprivacy.analysis.errors import InputErrors
from rosprivacy.ingest.code import source_code
from rosprivacy.ingest.code.source_files import read_sources
from rosprivacy.labelling.annotating import annotated
from rosprivacy.ontology.vocabulary import load

if TYPE_CHECKING:
    from pathlib import Path

    from tests.helpers.command import Cli

# The library that reads C++ takes a time that grows with the square of these: minutes for a megabyte.
NESTED = "int x = " + "create_publisher<A<" * 12_000 + "1" + '>>("a")' * 12_000 + ";"
CODE = {"nested.cpp": NESTED, "long.py": "a = f(1)  # privacy: leak Video\n" * 20_000}
POLICY = """<policy version="0.2.0"><enclaves><enclave path="/e"><profiles><profile ns="/" node="camera">
<topics publish="ALLOW"><topic>image</topic></topics></profile></profiles></enclave></enclaves></policy>"""


@pytest.mark.slow
@pytest.mark.parametrize("name", CODE)
def test_a_file_that_takes_too_long_is_told_and_the_others_are_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.setattr(source_code, "SECONDS", 0.3)
    (tmp_path / name).write_text(CODE[name])
    (tmp_path / "other.py").write_text("import cv2\ncv2.VideoCapture(0)\n")
    begun = time.thread_time()
    late, other = read_sources([str(tmp_path)]).codes
    assert time.thread_time() - begun < 4
    assert [error.file for error in late.problems] == [str(tmp_path / name)]
    assert "not read to its end" in late.problems[0].problem
    assert (late.comments, late.sites, late.uses) == ((), (), ())  # half a file is no answer
    assert [use.name for use in other.uses] == ["cv2.VideoCapture"]
    with pytest.raises(InputErrors, match="not read to its end"):
        annotated([str(tmp_path)], load())


def test_what_was_not_read_stands_in_the_answer(cli: Cli, tmp_path: Path) -> None:
    """A file with so many names that each of them may mean anything, as one that takes too long."""
    (tmp_path / "p.xml").write_text(POLICY)
    code = "".join(f"using namespace n{number};\n" for number in range(100))
    (tmp_path / "many.cpp").write_text(code + "int main() { VideoCapture camera(0); }\n")
    done = cli("suggest", "p.xml", "--source", "many.cpp", "-f", "json", cwd=tmp_path)
    (unread,) = json.loads(done.stdout)["unread"]
    assert (unread["file"], "more than 50 namespaces" in unread["problem"]) == ("many.cpp", True)
    assert "many.cpp" in cli("suggest", "p.xml", "--source", "many.cpp", cwd=tmp_path).stdout
