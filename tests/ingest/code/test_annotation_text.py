"""The short language of annotations means what the label file means (rules S7, S8), and nothing is lost (S11)."""

from __future__ import annotations

import time

import pytest

from rosprivacy.analysis.errors import LabelError
from rosprivacy.analysis.model import Method, Place
from rosprivacy.ingest.code.annotation_text import Annotation, read_annotation
from rosprivacy.ontology.vocabulary import load

HERE = Place("a.py", 7)


def told(text: str) -> str:
    read = read_annotation(text, HERE, load())
    assert isinstance(read, LabelError), read
    return str(read)


def said(text: str) -> list[tuple[object, ...]]:
    read = read_annotation(text, HERE, load())
    assert isinstance(read, Annotation), read
    assert all(one.place == HERE for one in read.statements)
    return [(one.role, one.categories, one.method, one.stated, one.to, one.through) for one in read.statements]


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("source Video", [("source", ("Video",), None, True, "", ())]),
        ("source face embedding, video", [
            ("source", ("FaceTemplate",), None, True, "", ()), ("source", ("Video",), None, True, "", ()),
        ]),
        ("source Video through /a, /b/*", [("source", ("Video",), None, True, "", ("/a", "/b/*"))]),
        ("source none", [("no-source", (), None, True, "", ())]),
        ("leak none", [("no-leak", (), None, True, "", ())]),
        ("leak Voice", [("leak", ("Voice",), None, True, "", ())]),
        ("conduit", [("conduit", (), None, True, "", ())]),
        ("conduit Location", [("conduit", ("Location",), None, True, "", ())]),
        ("sanitizer Video drop", [("sanitizer", ("Video",), Method.DROP, True, "", ())]),
        ("sanitizer face embedding", [("sanitizer", ("FaceTemplate",), Method.PSEUDONYMISE, False, "", ())]),
        ("derives Video -> FaceTemplate", [("derivation", ("Video",), None, True, "FaceTemplate", ())]),
        ("mundane", [("mundane", (), None, True, "", ())]),
        ("sensitive", [("sensitive", (), None, True, "", ())]),
        ("only Voice, Video", [("only", ("Video", "Voice"), None, True, "", ())]),
        ("never  Location ", [("never", ("Location",), None, True, "", ())]),
    ],
)  # fmt: skip
def test_each_word_says_what_it_says_in_a_label_file(text: str, wanted: list[tuple[object, ...]]) -> None:
    assert said(f"privacy: {text}") == wanted
    assert said(f"privacy(/x):{text}") == wanted


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("privacy: sorce Video", "unknown word 'sorce' in an annotation; did you mean 'source'?"),
        ("privacy:", "an annotation that says nothing; one of source, leak, sanitizer, conduit, derives, mundane"),
        ("privacy: source Vidoe", "unknown category 'Vidoe'; did you mean Video"),
        ("privacy: source", "source names nothing; write: privacy: source Video, or: source Video through /image"),
        ("privacy: leak Voice,", "leak with a comma too many; write: privacy: leak Voice, Video"),
        ("privacy: source Video through image", "'image' is not an absolute name; begin it with /"),
        ("privacy: source Video through", "source names nothing"),
        ("privacy: sanitizer Video anonymize", "sanitizer method 'anonymize'; did you mean anonymise?"),
        ("privacy: sanitizer Vidoe drop", "unknown category 'Vidoe'; did you mean Video"),
        ("privacy: derives Video", "derivation 'Video'; write: privacy: derives Video -> FaceTemplate"),
        ("privacy: mundane Video", "mundane takes nothing, not 'Video'; write: privacy: mundane"),
        ("privacy: note", "note without a text; write: privacy: note why it is so"),
        ("privacy(camera): conduit", "name 'camera' is not absolute; begin it with /: privacy(/camera): …"),
        ("privacy(): conduit", "name '' is not absolute"),
        ("privacy: source Video  # front", "unknown category 'Video  # front'"),
        ("Privacy: source Video", "looks like an annotation and is none; begin the comment line with privacy:"),
        ("privacy source Video", "looks like an annotation and is none"),
        ("privacy (/x): mundane", "looks like an annotation and is none"),
        ("privacy= leak Voice", "looks like an annotation and is none"),
        ("TODO privacy: leak Voice", "looks like an annotation and is none"),
        ("privcy: leak Voice", "looks like an annotation and is none"),
        ("privacy(/x: leak Voice", "looks like an annotation and is none"),
        ("privacy: leak V\x1b[31moice\u202e", r"unknown category 'V\\x1b[31moice\\u202e'"),
        ("privacy: note " + "x" * 3000, "an annotation of more than 2000 characters"),
    ],
)
def test_what_is_none_is_told(text: str, problem: str) -> None:
    """Rule S11: a label is not lost in silence, and the message is one line."""
    line = told(text)
    assert problem in line
    assert line.startswith("a.py:7: ")
    assert line.isprintable()


@pytest.mark.parametrize(
    "text",
    [
        "", "see the privacy policy", "write `privacy: source Video` beside the call", "privacy", "privacy-preserving",
        "the privacy of a source", "about privacy (leaks)", "private: source Video", "mundane", "privately: leak Voice",
    ],
)  # fmt: skip
def test_other_comments_are_no_annotations(text: str) -> None:
    assert read_annotation(text, HERE, load()) is None


def test_a_comment_as_long_as_a_file_is_looked_through_once() -> None:
    started = time.process_time()
    assert read_annotation("privacy(" * 100_000, HERE, load()) is None
    assert time.process_time() - started < 5  # seconds; it took minutes when each bracket was looked for anew
