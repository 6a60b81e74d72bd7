"""Random annotations in random programs are read back, and the label file of them means the same (rules S7, S8, S11).

What a label means is stated once more here, as a label file says it, and not taken from the program.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rosprivacy.ingest.code.annotated_elements import attach, conflicts, label_text
from rosprivacy.ingest.code.cpp_code import read_cpp
from rosprivacy.ingest.code.python_code import read_python
from rosprivacy.ingest.labels.label_file import parse_labels
from rosprivacy.ingest.labels.label_writer import without_places
from rosprivacy.ontology.vocabulary import load

pytest.importorskip("tree_sitter_cpp", reason="without the [code] extra")

OF_NODE: list[tuple[str, Any]] = [
    ("leak Voice, video", {"leak": ["Voice", "Video"]}),
    ("leak none", {"leak": "none"}),
    ("sanitizer Location drop, Health", {"sanitizer": {"Location": "drop", "Health": None}}),
    ("derives Video -> FaceTemplate", {"derives": [{"from": "Video", "to": "FaceTemplate"}]}),
    ("conduit HomeMap", {"conduit": ["HomeMap"]}),
]
ALONE: list[tuple[str, Any]] = [("conduit", "conduit"), ("source Voice", {"source": ["Voice"]})]
OF_CHANNEL: list[tuple[str, Any]] = [
    ("mundane", "mundane"),
    ("sensitive", "sensitive"),
    ("only Video, Voice", {"only": ["Video", "Voice"]}),
    ("never Location", {"never": ["Location"]}),
]
CALLS = {  # section -> call in Python, call in C++, whether it writes
    "topics": [
        ("self.create_publisher(Image,{}{!r}, 10)", 'create_publisher<Image>({}"{}", 10);', True),
        ("self.create_subscription(Image,{}{!r}, self.f, 10)", 'create_subscription<Image>({}"{}", 10, f);', False),
    ],
    "services": [("self.create_service(S,{}{!r}, f)", 'this->create_service<S>({}"{}", f);', True)],
    "actions": [
        ("x = [ActionClient(self, A,{}{!r})]", 'x_ = rclcpp_action::create_client<A>(this,{}"{}");', True),
    ],
}  # fmt: skip
NOISE = {
    ".py": ['s = "# privacy: leak Voice"', '"""\n# privacy: conduit\n"""', "# plain words", "", "self.f(1)"],
    ".cpp": ['auto s = "// privacy: leak Voice";', 'auto r = R"q(\n// privacy: conduit\n)q";', "// words", "", "f(1);"],
}


class Call(NamedTuple):
    place: tuple[str, int]  # section, and which of its calls
    label: int | None
    source: bool
    where: str
    noise: int


def calls() -> st.SearchStrategy[Call]:
    places = st.sampled_from([(section, which) for section, some in CALLS.items() for which in range(len(some))])
    labels = st.none() | st.integers(0, len(OF_CHANNEL) - 1)
    where = st.sampled_from(["above", "behind", "inside", "named"])
    return st.builds(Call, places, labels, st.booleans(), where, st.integers(0, 9))


class Class(NamedTuple):
    labels: tuple[int, ...]
    alone: int | None
    calls: tuple[Call, ...]
    where: str


CLASSES = st.lists(
    st.builds(
        Class,
        st.sets(st.integers(0, len(OF_NODE) - 1), max_size=2).map(
            lambda some: tuple(sorted(some - {1} if 0 in some else some))
        ),
        st.none() | st.integers(0, len(ALONE) - 1),
        st.lists(calls(), max_size=4).map(tuple),
        st.sampled_from(["class", "constructor", "named"]),
    ),
    max_size=3,
)


def program(classes: list[Class], ending: str) -> tuple[str, dict[str, Any]]:
    """A program, and the label file that its annotations mean."""
    meant: dict[str, Any] = {}
    python = ending == ".py"
    sign = "#" if python else "//"
    lines = []
    for number, one in enumerate(classes):
        node = f"/r/n{number}"
        label: dict[str, Any] = {}
        alone = one.alone is not None and not one.labels and not any(call.source for call in one.calls)
        said = [ALONE[one.alone or 0]] if alone else [OF_NODE[at] for at in one.labels]
        whole: Any = said[0][1] if alone else {key: value for _, part in said for key, value in part.items()}
        body: list[str] = []
        for at, call in enumerate(one.calls):
            name = f"/r/c{number}_{at}"
            body += [NOISE[ending][call.noise]] if call.noise < len(NOISE[ending]) else []
            section, which = call.place
            in_python, in_cpp, writes = CALLS[section][which]
            words = []
            if call.label is not None:
                words.append(OF_CHANNEL[call.label][0])
                meant.setdefault("channels" if call.where == "named" else section, {})[name] = OF_CHANNEL[call.label][1]
            if call.source and writes:
                words.append("source Video")
                label.setdefault("Video", []).append(name)
            body += _placed(in_python if python else in_cpp, name, node, words, call.where, sign)
        if label and not alone:
            whole = {**whole, "source": label} if isinstance(whole, dict) else whole
        comments = [f"{sign} privacy{f'({node})' if one.where == 'named' else ''}: {text}" for text, _ in said]
        if whole:
            meant.setdefault("nodes", {})[node] = whole
        lines += _class(number, comments, body, one.where, python=python)
    return "\n".join(lines), {"labels": 1, **meant}


def _placed(call: str, name: str, node: str, words: list[str], where: str, sign: str) -> list[str]:
    short = name.removeprefix("/r/") if len(words) % 2 else name
    if where == "named":
        through = f" through {name}"
        named = [
            f"{sign} privacy({node}): {one}{through}" if one.startswith("source") else f"{sign} privacy({name}): {one}"
            for one in words
        ]
        return [*named, "", call.format(" ", short)]
    comments = [f"{sign} privacy: {one}" for one in words]
    if where == "above" or len(words) > 1:
        return ["", f"{sign} words", *comments, call.format(" ", short)]
    if where == "inside":
        return call.format(f"\n{comments[0]}\n" if comments else " ", short).split("\n")
    return [call.format(" ", short) + "  " + "".join(comments)]


def _class(number: int, comments: list[str], body: list[str], where: str, *, python: bool) -> list[str]:
    above, inside = (comments, []) if where == "class" else ([], comments)
    loose = where == "named"
    if python:
        made = [f"super().__init__('n{number}')"]
        first = ["", *inside, "", *made] if loose else [*inside, *made]
        text = "\n".join([*first, *body]).split("\n")
        return [*above, f"class K{number}(Node):", " def __init__(self):", *(f"  {line}" for line in text)]
    head = [*inside, ""] if loose else inside
    return [
        *above, f"class K{number} : public rclcpp::Node {{", " int x_;", "public:", *head,
        f' K{number}() : Node("n{number}") {{', *body, " }", "};",
    ]  # fmt: skip


@pytest.mark.parametrize("ending", [".py", ".cpp"])
@given(classes=CLASSES)
def test_annotations_come_back_and_mean_the_same(ending: str, classes: list[Class]) -> None:
    text, meant = program(classes, ending)
    vocabulary = load()
    code = (read_python if ending == ".py" else read_cpp)(f"a{ending}", text.encode())
    labelled, problems = attach([code], vocabulary, "/r")
    assert not problems, (str(problems[0]), text)
    assert not list(conflicts(labelled, vocabulary))
    made = parse_labels(label_text(labelled, vocabulary, "made"), vocabulary, name="made").entries
    wanted = parse_labels(meant, vocabulary, name="meant").entries
    assert _meaning(made) == _meaning(wanted), text


def _meaning(entries: Any) -> list[Any]:
    """Entries without lines and without the order of statements."""
    return sorted(
        (entry.kinds, entry.name, sorted(map(repr, without_places(entry).statements)), entry.rank) for entry in entries
    )


@given(text=st.text(max_size=80), ending=st.sampled_from([".py", ".cpp"]))
def test_whatever_a_comment_says_is_told_or_written_as_it_is(text: str, ending: str) -> None:
    """A note of any text is one line of the file, and comes back as it can be shown."""
    note = "".join(c for c in text if c.isprintable()).strip()
    sign = "#" if ending == ".py" else "//"
    code = f"{sign} privacy(/a): leak Voice\n{sign} privacy(/a): note x{note}\n"
    read = (read_python if ending == ".py" else read_cpp)(f"a{ending}", code.encode())
    labelled, problems = attach([read], load(), "/")
    assert not problems
    (entry,) = parse_labels(label_text(labelled, load(), "made"), load(), name="made").entries
    said = "x" + note if ending == ".py" else f"x{note}".rstrip("\r \t\\").removesuffix("*/").strip("/*!< \t\r")
    assert entry.statements[0].why == said
