"""Forms: what can be said is said, everything else is refused with one sentence, and never breaks the program."""

from __future__ import annotations

from typing import Any
from urllib.parse import urlencode

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.analysis.model import Element
from rosprivacy.explorer.edits import element_id
from rosprivacy.explorer.web.answered_entries import label_of
from rosprivacy.explorer.web.forms import EVERY, METHODS, EditForm, FormAnswer, FormError, answer_in, roles_of

NODE, TOPIC = Element("node", "/recorder"), Element("topic", "/video")
STORE = Element("storage", "disk")
THERE = {element_id(one.identity): one for one in (NODE, TOPIC, STORE)}
KINDS = ("Video", "Voice", "FaceTemplate")


def said(element: Element, **fields: Any) -> FormAnswer:
    pairs = [(key, one) for key, value in fields.items() for one in (value if isinstance(value, list) else [value])]
    body = urlencode([("element", element_id(element.identity)), *pairs]).encode()
    return answer_in(EditForm(body), THERE, KINDS)


def test_what_can_be_said_is_understood() -> None:
    assert said(NODE, role="leak", about=["Video", "Voice"]) == FormAnswer(NODE, "leak", ("Video", "Voice"))
    assert said(NODE, role="conduit", about=["Video", "*"]) == FormAnswer(NODE, "conduit")
    assert said(NODE, role="source", brings="Voice", about=["Video"]) == FormAnswer(NODE, "source", ("Voice",))
    assert said(NODE, role="sanitizer", about="Video", method="drop") == FormAnswer(
        NODE, "sanitizer", ("Video",), "drop"
    )
    assert said(NODE, role="derives", about="Video", makes="FaceTemplate").to == "FaceTemplate"
    assert said(TOPIC, role="mundane", about="*", note=" no  pictures ", by="A. Lee")[-2:] == ("no pictures", "A. Lee")
    assert said(TOPIC, role="sensitive", about=["Video", ""]) == FormAnswer(TOPIC, "sensitive", ("Video",))
    assert said(NODE, role="absent", reason="only in tests").note == "only in tests"
    assert said(NODE, role="nothing") == FormAnswer(NODE, "nothing")


@pytest.mark.parametrize(
    ("element", "fields"),
    [
        (NODE, {"role": "mundane", "about": "Video"}),  # of a channel
        (TOPIC, {"role": "leak", "about": "Video"}),  # of a node
        (STORE, {"role": "absent", "reason": "x"}),  # of a node
        (NODE, {"role": "__class__", "about": "Video"}),
        (NODE, {"role": ["leak", "conduit"], "about": "Video"}),
        (NODE, {"about": "Video"}),
        (NODE, {"role": "leak"}),
        (NODE, {"role": "leak", "about": EVERY}),  # names no kind that leaks
        (NODE, {"role": "leak", "about": ["Video", "Nothing"]}),
        (NODE, {"role": "source", "brings": ""}),
        (NODE, {"role": "source", "brings": "../../etc/passwd"}),
        (NODE, {"role": "sanitizer", "about": "Video", "method": "absent"}),  # no method of a person
        (NODE, {"role": "sanitizer", "about": "Video"}),
        (NODE, {"role": "derives", "about": "Video", "makes": "*"}),
        (NODE, {"role": "absent", "reason": "  "}),
        (NODE, {"role": "conduit", "about": "Video", "note": "x" * 501}),
        (NODE, {"role": "conduit", "about": "Video", "by": "a\u202eb"}),
        (NODE, {"role": "conduit", "about": "Video", "note": "a\x00b"}),
    ],
)
def test_what_cannot_be_said_is_one_sentence(element: Element, fields: dict[str, Any]) -> None:
    with pytest.raises(FormError) as error:
        said(element, **fields)
    assert str(error.value).endswith(".")
    assert len(str(error.value).splitlines()) == 1


@pytest.mark.parametrize(
    "chosen", ["", "e0", "/recorder", "../labels.yaml", "e" + "0" * 16, element_id(NODE.identity)[:-1]]
)
def test_an_element_is_named_by_its_id_only(chosen: str) -> None:
    with pytest.raises(FormError, match="no such element"):
        answer_in(EditForm(urlencode({"element": chosen, "role": "nothing"}).encode()), THERE, KINDS)


@pytest.mark.parametrize("body", [b"a", b"&&", b"a=%ff", b"\xff=1", "a=ä".encode(), b"&".join([b"a=1"] * 1001)])
def test_a_form_that_cannot_be_read_is_told(body: bytes) -> None:
    with pytest.raises(FormError):
        EditForm(body)


@pytest.mark.parametrize("number", ["", "-1", "1.0", "²", "1e3", "9" * 10, " 1", "None"])
def test_a_number_is_one(number: str) -> None:
    with pytest.raises(FormError):
        EditForm(urlencode({"version": number}).encode()).number("version")


@given(st.binary(max_size=300))
def test_no_bytes_break_it(body: bytes) -> None:
    with pytest.raises(FormError):  # no bytes that chance makes name an element
        answer_in(EditForm(body), THERE, KINDS)


values = st.one_of(st.text(max_size=20), st.sampled_from([*KINDS, *METHODS, EVERY, *THERE]))
names = st.sampled_from(["element", "role", "about", "brings", "method", "makes", "note", "by", "reason", "x"])
roles = st.sampled_from([("role", role) for role in ("source", "leak", "sanitizer", "conduit", "derives", "mundane")])


@given(st.lists(st.tuples(names, values), max_size=12), st.one_of(st.none(), roles), st.sampled_from([*THERE]))
def test_whatever_is_understood_is_of_closed_lists(
    fields: list[tuple[str, str]], role: tuple[str, str] | None, chosen: str
) -> None:
    pairs = [*fields, *([role] if role else []), ("element", chosen)]
    body = urlencode([(key, value.encode("utf-8", "surrogatepass")) for key, value in pairs]).encode()
    try:
        answer = answer_in(EditForm(body), THERE, KINDS)
    except FormError:
        return
    assert answer.element in THERE.values()
    assert answer.role in roles_of(answer.element)
    assert set(answer.kinds) <= set(KINDS)
    assert answer.method in ("", *METHODS)
    assert answer.to in ("", *KINDS)
    label_of(answer, None)


@pytest.mark.parametrize(
    ("now", "answer", "label"),
    [
        (None, FormAnswer(NODE, "leak", ("Video",)), {"leak": ["Video"]}),
        ({"leak": ["Video"]}, FormAnswer(NODE, "conduit", ("Voice",)), {"leak": ["Video"], "conduit": ["Voice"]}),
        (
            {"leak": ["Video", "Voice"]},
            FormAnswer(NODE, "conduit", ("Voice",)),
            {"leak": ["Video"], "conduit": ["Voice"]},
        ),
        ({"leak": ["Video"]}, FormAnswer(NODE, "conduit"), {"conduit": True}),
        ("conduit", FormAnswer(NODE, "leak", ("Voice",)), {"conduit": True, "leak": ["Voice"]}),
        ({"source": ["Video"]}, FormAnswer(NODE, "leak", ("Video",)), {"leak": ["Video"], "source": ["Video"]}),
        ({"source": ["Video"]}, FormAnswer(NODE, "conduit", ("Video",)), {"conduit": ["Video"]}),
        ({"source": ["Video"]}, FormAnswer(NODE, "conduit"), {"source": ["Video"], "conduit": True}),
        ({"source": ["Video"]}, FormAnswer(NODE, "absent", note="tests only"), {"absent": "tests only"}),
        ({"leak": ["Video"]}, FormAnswer(NODE, "source", ("Video",)), {"leak": ["Video"], "source": ["Video"]}),
        (
            {"sanitizer": {"Video": "drop"}},
            FormAnswer(NODE, "sanitizer", ("Voice",), "anonymise"),
            {"sanitizer": {"Video": "drop", "Voice": "anonymise"}},
        ),
        (
            {"derives": [{"from": "Video", "to": "FaceTemplate"}], "note": "why"},
            FormAnswer(NODE, "conduit", ("Video",)),
            {"derives": [{"from": "Video", "to": "FaceTemplate"}], "conduit": ["Video"]},
        ),
        (
            {"sanitizer": {"Video": "drop"}},
            FormAnswer(NODE, "derives", ("Video",), to="FaceTemplate"),
            {"sanitizer": {"Video": "drop"}, "derives": [{"from": "Video", "to": "FaceTemplate"}]},
        ),
        (
            {"leak": ["Video"]},
            FormAnswer(NODE, "derives", ("Video",), to="FaceTemplate"),
            {"leak": ["Video"], "derives": [{"from": "Video", "to": "FaceTemplate"}]},
        ),
        ("mundane", FormAnswer(TOPIC, "sensitive", ("Video",)), {"sensitive": ["Video"]}),
        ("sensitive", FormAnswer(TOPIC, "mundane", ("Voice",)), {"never": ["Voice"]}),
        ({"never": ["Voice"]}, FormAnswer(TOPIC, "mundane", ("Video",)), {"never": ["Voice", "Video"]}),
        ({"never": ["Voice"]}, FormAnswer(TOPIC, "mundane"), {"mundane": True}),
        ({"only": ["Location"]}, FormAnswer(TOPIC, "sensitive", ("Location",)), {"only": ["Location"]}),
        ({"only": ["Location"]}, FormAnswer(TOPIC, "sensitive", ("Video",)), {"only": ["Location", "Video"]}),
        (
            {"only": ["Location", "Voice"]},
            FormAnswer(TOPIC, "mundane", ("Voice",)),
            {"only": ["Location"], "never": ["Voice"]},
        ),
        (
            {"only": ["Biometric"]},
            FormAnswer(TOPIC, "mundane", ("FaceTemplate",)),
            {"only": ["Biometric"], "never": ["FaceTemplate"]},
        ),
        ({"only": ["Location"]}, FormAnswer(TOPIC, "mundane", ("Location",)), {"mundane": True}),
        (
            {"only": ["Location"], "never": ["Voice"]},
            FormAnswer(TOPIC, "sensitive", ("Voice",)),
            {"only": ["Location", "Voice"]},
        ),
        ({"only": ["Location"]}, FormAnswer(TOPIC, "sensitive"), {"sensitive": True}),
        ("conduit", FormAnswer(NODE, "absent", note="tests only"), {"absent": "tests only"}),
        ({"leak": "none"}, FormAnswer(NODE, "conduit", ("Video",)), {"leak": "none", "conduit": ["Video"]}),
        ({"leak": "none"}, FormAnswer(NODE, "leak", ("Video",)), {"leak": ["Video"]}),
        ({"source": "none"}, FormAnswer(NODE, "source", ("Video",)), {"source": ["Video"]}),
        ({"source": "none"}, FormAnswer(NODE, "leak", ("Video",)), {"source": "none", "leak": ["Video"]}),
    ],
)
def test_an_answer_about_some_kinds_leaves_the_others_alone(
    now: Any, answer: FormAnswer, label: dict[str, Any]
) -> None:
    assert label_of(answer, now) == label


def test_what_names_channels_is_changed_in_the_file() -> None:
    with pytest.raises(FormError, match="change it in the file"):
        label_of(FormAnswer(NODE, "source", ("Voice",)), {"source": {"Video": ["/video"]}})
