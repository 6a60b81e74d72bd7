"""Choices -> rules about names, and label files with suggestions as comments, about elements of ``BASE``."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import CLEANS, Confidence
from tests.fuzzing.label_texts import labels, written
from tests.fuzzing.words import CHANNELS, KINDS, NODES, ODD_TEXT, with_fault

if TYPE_CHECKING:
    from tests.fuzzing.choices import Choices

WORDS = ("a", "image", "camera_info", "c", "eye", "arm", "n", "parameter_events")


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
