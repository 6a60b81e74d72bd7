"""What is left of the answers of a language model: closed lists, and a quote of what was sent."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.model import Confidence, Element
from rosprivacy.analysis.suggesting.evidence import HIDING, MODEL, NAMED, TYPE, Evidence
from rosprivacy.analysis.suggesting.weighing import proposals
from rosprivacy.labelling.model_interview import KEYS, MAX_ANSWERS, AskedModel, Mask, judged

KINDS = ("FaceTemplate", "Video", "Voice")
TYPES = ("acme_msgs/msg/Badge",)
ASKED = {
    "n1": AskedModel(Element("node", "/wardlog"), "/wardlog", (), (), (("/badges", TYPES),), ("who comes",)),
    "n2": AskedModel(Element("topic", "/badges"), "/badges", TYPES, (), (), ()),
}
GOOD = {"id": "n1", "role": "leak", "kind": "Video", "to": "", "quote": "wardlog"}


@pytest.mark.parametrize("quote", ["wardlog", "/wardlog", "Badge", "badges", "who comes", "acme_msgs/msg/Badge"])
def test_a_quote_is_of_the_name_a_type_or_a_comment(quote: str) -> None:
    (one,) = judged([GOOD | {"quote": quote}], ASKED, KINDS, "m").evidence
    assert (one.ground, one.confidence) == (MODEL, Confidence.MAY)
    assert one.reason.startswith(f"language model m, by {quote!r} in the ")


@pytest.mark.parametrize(
    ("wrong", "reason"),
    [
        ({"quote": "camera"}, "no evidence in the input"),
        ({"quote": ""}, "no evidence in the input"),
        ({"quote": "/"}, "no evidence in the input"),
        ({"quote": "WARDLOG"}, "no evidence in the input"),  # word for word
        ({"id": "n2", "role": "sensitive"}, "no evidence in the input"),  # of another element
        ({"id": "n99"}, "no element that was sent"),
        ({"id": "/wardlog"}, "no element that was sent"),
        ({"role": "never"}, "no role that was asked for"),
        ({"role": "sanitizer"}, "no role that was asked for"),
        ({"role": "conduit"}, "no role that was asked for"),
        ({"role": "mundane"}, "no role that was asked for"),
        ({"role": "sensitive"}, "no role that was asked for"),  # it is a node
        ({"id": "n2", "role": "source"}, "no role that was asked for"),  # it is a topic
        ({"kind": "Soul"}, "no kind that there is"),
        ({"kind": ""}, "no kind that there is"),
        ({"role": "derivation", "to": "Soul"}, "no kind that there is"),
        ({"role": "derivation", "to": "Video"}, "no kind that there is"),  # of itself
        ({"quote": 7}, "not of the form asked for"),
        ({"more": "x"}, "not of the form asked for"),
    ],
)
def test_what_is_in_no_closed_list_or_has_no_quote_is_dropped_and_counted(wrong: dict[str, Any], reason: str) -> None:
    done = judged([GOOD | wrong, GOOD], ASKED, KINDS, "m")
    assert dict(done.dropped) == {reason: 1}
    assert [one.label.role for one in done.evidence] == ["leak"]


@pytest.mark.parametrize("odd", [None, 7, "x", [], {}, [GOOD], {"id": "n1"}])
def test_an_answer_of_any_form_is_counted(odd: Any) -> None:
    assert dict(judged([odd], ASKED, KINDS, "m").dropped) == {"not of the form asked for": 1}


def test_no_element_gets_more_than_a_person_would_read() -> None:
    kinds = [f"Kind{number}" for number in range(9)]
    done = judged([GOOD | {"kind": kind} for kind in (*kinds, *kinds[:MAX_ANSWERS])], ASKED, kinds, "m")
    assert len(done.evidence) == MAX_ANSWERS
    assert done.dropped.total() == 9 - MAX_ANSWERS


WORDS = st.sampled_from(["n1", "n2", "n3", "leak", "never", "source", "sanitizer", "derivation", *KINDS, "", "badges"])
ANSWER = st.fixed_dictionaries(dict.fromkeys(KEYS, WORDS)) | st.dictionaries(st.sampled_from([*KEYS, "x"]), WORDS)


@given(st.lists(ANSWER))
def test_whatever_is_answered_nothing_that_hides_comes_of_it(answers: list[dict[str, str]]) -> None:
    done = judged(answers, ASKED, KINDS, "m")
    assert len(done.evidence) + done.dropped.total() <= len(answers)
    for one in done.evidence:
        assert one.label.role not in HIDING
        assert one.label.element in {asked.element for asked in ASKED.values()}
        assert one.label.kind in KINDS
        assert one.confidence is Confidence.MAY


@pytest.mark.parametrize("other", [NAMED, TYPE])
def test_that_a_model_agrees_makes_nothing_surer(other: str) -> None:
    (said,) = judged([GOOD], ASKED, KINDS, "m").evidence
    (one,) = proposals([said, Evidence(said.label, other, Confidence.MAY, "a word", said.place)])
    assert one.confidence is Confidence.MAY


# ---------------------------------------------------------------- masked names

KNOWN = {"face", "image", "msgs", "msg", "x"}
PARTS = st.sampled_from(["face", "Image", "x", "acme", "7", "Mueller", "/", "_", "x1", "é", "ab", " "])


@given(st.lists(st.lists(PARTS).map("".join) | st.text(max_size=8)))
def test_no_word_that_is_not_known_is_left(texts: list[str]) -> None:
    mask = Mask(KNOWN)
    for text in texts:
        masked = mask.masked(text)
        assert masked.isascii()
        assert not [word for word in ("acme", "mueller") if word in masked.casefold()]
        assert mask.masked(text) == masked


@given(st.lists(st.lists(PARTS).map("".join)))
def test_the_words_come_back(texts: list[str]) -> None:
    mask = Mask(KNOWN)
    assert [mask.unmasked(mask.masked(text)).casefold() for text in texts] == [text.casefold() for text in texts]
