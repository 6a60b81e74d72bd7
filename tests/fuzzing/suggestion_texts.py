"""Choices -> rules about names and libraries, label files with suggestions, answers of models: all about ``BASE``."""

from __future__ import annotations

import hashlib
import json
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import CLEANS, Confidence
from tests.fuzzing.label_texts import labels, written
from tests.fuzzing.words import CHANNELS, KINDS, NODES, ODD_TEXT, with_fault

if TYPE_CHECKING:
    from tests.fuzzing.choices import Choices

WORDS = ("a", "image", "camera_info", "c", "eye", "arm", "n", "parameter_events")
USED = ("cv2", "cv2.VideoCapture", "cv::imshow", "curl_*", "open(w)", "ros2 bag", "a.b(input)")


def name_rules(choices: Choices) -> dict[str, str]:
    words = list(WORDS)
    top: dict[str, Any] = {"name_rules": 1}
    for section in ("carries", "brings_in", "lets_out", "nothing"):
        said = choices.some(words, least=1)
        rule: dict[str, Any] = {"words": said, "why": "x"}
        if section in ("carries", "brings_in"):
            rule["kinds"] = choices.some(KINDS, least=1)
        if choices.once_in(3):
            rule["confidence"] = choices.pick(("likely", "may", "certain"))
        top[section] = [rule]
    top["becomes"] = [{"from": choices.pick(KINDS), "to": choices.some(KINDS, least=1), "why": "x"}]
    top["silent"], top["neutral"] = choices.some(words), choices.some(words)
    return {"names.yaml": written(choices, top)}


def library_rules(choices: Choices) -> dict[str, str]:
    top: dict[str, Any] = {"library_rules": 1}
    for section in ("brings_in", "lets_out", "makes", "silent"):
        rule: dict[str, Any] = {choices.pick(("python", "c++", "programs")): choices.some(USED, least=1)}
        if section != "silent":
            sure = "certain" if choices.once_in(12) else choices.pick(("likely", "may"))
            rule |= {"why": "x", "confidence": sure}
        if section in ("brings_in", "makes"):
            rule["kinds"] = choices.some(KINDS, least=1)
        if section == "makes":
            rule["to"] = choices.some(KINDS, least=1)
        if section == "lets_out":
            rule["where"] = "moon" if choices.once_in(6) else choices.pick(("network", "file"))
        top[section] = [rule]
    return {"libraries.yaml": written(choices, top)}


def suggested(choices: Choices) -> dict[str, str]:
    text = labels(choices)["labels.yaml"]
    lines = [_suggestion(choices) for _ in range(1 + choices.below(5))]
    return {"labels.yaml": text + ("" if text.endswith("\n") else "\n") + "".join(lines)}


def _suggestion(choices: Choices) -> str:
    kind = choices.pick(KINDS)
    of_node: tuple[dict[str, Any], ...] = (
        {"source": [kind]}, {"leak": [kind]}, {"conduit": [kind]}, {"sanitizer": {kind: str(choices.pick(CLEANS))}},
        {"derives": [{"from": kind, "to": choices.pick(KINDS)}]},
    )  # fmt: skip
    of_channel: tuple[dict[str, Any], ...] = ({"sensitive": [kind]}, {"never": [kind]})
    node = choices.once_in(2)
    said: Any = {choices.pick(NODES if node else CHANNELS): choices.pick(of_node if node else of_channel)}
    top: Any = {"nodes" if node else choices.pick(("topics", "channels")): said}
    if choices.once_in(6):
        top = with_fault(choices, top)
    why = choices.pick(("a word", *(one for one in ODD_TEXT if one.isprintable())))
    return f"# suggest: {choices.pick(tuple(Confidence))} {json.dumps(top)} because {why}\n"


def recorded(choices: Choices) -> dict[str, str]:
    """What a language model answered to one question, as it is kept; most of it of the form that was asked for."""
    inner: Any = {"suggestions": [_answer(choices) for _ in range(choices.below(4))]}
    if choices.once_in(6):
        inner = with_fault(choices, inner)
    message: Any = {"content": choices.pick((json.dumps(inner), json.dumps(inner), "Sure! Here", None))}
    if choices.once_in(8):
        message["refusal"] = choices.pick(ODD_TEXT)
    outer: Any = {"choices": [{"message": message, "finish_reason": choices.pick(("stop", "length", None))}]}
    text = json.dumps(with_fault(choices, outer) if choices.once_in(8) else outer)
    question, digests = "{}", [hashlib.sha256(one.encode()).hexdigest() for one in ("{}", text)]
    one = {"question": question, "question_sha256": digests[0], "answer": text, "answer_sha256": digests[1]}
    top: Any = {"format": "rosprivacy.model-exchanges/1", "model": "m", "url": "http://localhost/v1", "masked": False}
    top |= {"date": "2026-06-01", "exchanges": [one]}
    return {"asked.json": json.dumps(with_fault(choices, top) if choices.once_in(8) else top)}


def _answer(choices: Choices) -> Any:
    role = choices.pick(("source", "leak", "derivation", "sensitive", "never", "sanitizer", "conduit"))
    said: Any = {"id": choices.pick(("n1", "n2", "n9")), "role": role, "kind": choices.pick(KINDS)}
    said |= {"to": choices.pick(("", *KINDS)), "quote": choices.pick(("eye", "image", "/c", *ODD_TEXT))}
    return with_fault(choices, said) if choices.once_in(6) else said
