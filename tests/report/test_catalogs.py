"""The catalogues of words: each language has the same keys and places, every key is used, and every use has a word."""

from __future__ import annotations

import ast
import json
import re
import string

from rosprivacy.analysis.model import REASONS
from rosprivacy.report.catalogs import LANGUAGES
from rosprivacy.report.catalogs.words import table
from tests.helpers.house import MODULES, PACKAGE, parsed
from tests.helpers.paths import ROOT

PLURALS = ("_one", "_other")
QUOTED = re.compile(r"""["']([\w.-]+)["']( ~)?""")  # in a template: a key, or with ~ what it begins with
PATHS = {"fleet.patterns"}  # texts like keys that are places in a document
FILES = {"xml", "ttl", "yaml", "json", "j2", "js", "css", "html", "md"}  # how names end that are of files
HEADS = {key.partition(".")[0] for key in table("en") if "." in key}


def named_texts() -> tuple[set[str], set[str]]:
    """All texts in the code and templates of what speaks to people; and those that a key only begins with."""
    whole, beginnings = set(), set()
    for module, file in MODULES.items():
        if (
            not module.startswith(("rosprivacy.report.", "rosprivacy.analysis.durations"))
            and PACKAGE not in file.parents
        ):
            continue  # the durations have the units of time
        nodes = list(ast.walk(parsed(file)))
        joined = [node.values for node in nodes if isinstance(node, ast.JoinedStr)]
        beginnings |= {str(first.value) for first, *_ in joined if isinstance(first, ast.Constant)}
        parts = {id(part) for values in joined for part in values}
        constants = (node for node in nodes if isinstance(node, ast.Constant) and id(node) not in parts)
        whole |= {node.value for node in constants if isinstance(node.value, str)}
    for folder in (ROOT / "report", PACKAGE / "explorer"):
        for template in folder.rglob("*.j2"):
            for text, more in QUOTED.findall(template.read_text("utf-8")):
                (beginnings if more else whole).add(text)
    return whole, {text for text in beginnings if re.fullmatch(r"[\w-]+\.[\w.-]*", text)}


def test_every_key_is_used_and_every_use_has_a_word() -> None:
    whole, beginnings = named_texts()
    words = table("en")
    stems = {key.removesuffix(end) for key in words for end in PLURALS if key.endswith(end)}
    for key in words:
        stem = next((key.removesuffix(end) for end in PLURALS if key.endswith(end)), key)
        assert {key, stem} & whole or key.startswith(tuple(beginnings)), f"nobody uses {key}"
    keys = words.keys() | stems
    dotted = {text for text in whole if re.fullmatch(r"[a-z]\w*(\.[a-z0-9][\w-]*)+", text)}
    like_keys = {text for text in dotted if text.partition(".")[0] in HEADS and text.rpartition(".")[2] not in FILES}
    modules = {text for text in like_keys if f"rosprivacy.{text}" in MODULES}
    assert like_keys - keys - modules - PATHS == set()
    ours = {text for text in beginnings if text.partition(".")[0] in HEADS}
    assert {text for text in ours if not any(key.startswith(text) for key in keys)} == set()


def test_every_language_has_the_same_words_with_the_same_places() -> None:
    def places(text: str) -> set[str]:
        return {name for _, name, _, _ in string.Formatter().parse(text) if name}

    def shared(key: str) -> bool:  # whom a decision covers stands in English in the list of countries
        return not key.startswith("adequacy.")

    english, *others = (
        {key: places(text) for key, text in table(language).items() if shared(key)} for language in LANGUAGES
    )
    for other in others:
        assert other == english


def test_a_catalogue_is_sorted_with_one_entry_a_line() -> None:
    for language in LANGUAGES:
        text = (ROOT / "report" / "catalogs" / f"{language}.json").read_text("utf-8")
        assert text == json.dumps(json.loads(text), ensure_ascii=False, indent=2, sort_keys=True) + "\n", language


def test_the_reasons_in_english_are_those_of_the_analysis() -> None:
    words = {key.removeprefix("reason."): text for key, text in table("en").items() if key.startswith("reason.")}
    assert words == REASONS
