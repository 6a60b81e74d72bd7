"""Categories kept in the user's cache folder, so that rdflib is imported only after a change.

In and out: categories under a key, the hash of the files that they were read from. The cache may be deleted at any
time; a damaged one is not used.
"""

from __future__ import annotations

import hashlib
import json
import os
import tempfile
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any

from rosprivacy.analysis.model import Category, Legal, Pointer, Situation
from rosprivacy.ontology.pointed import Pointed

FORMAT = 9  # one more when what is kept, or what is refused, changes
_TUPLES = ("broader", "synonyms", "data_types", "identity_factors", "same_as", "within", "stated_of", "look_at")


def default_folder() -> Path:
    """Return the user's cache folder."""
    from platformdirs import user_cache_path  # noqa: PLC0415 - light start

    return user_cache_path("rosprivacy")


Kept = tuple[tuple[Category, ...], dict[str, str], Pointed]


def get(folder: Path, key: str) -> Kept | None:
    """Return what an earlier run kept, if it is whole and of these files."""
    try:
        digest, text = _path(folder, key).read_bytes().split(b"\n", 1)
        if digest != _digest(key, text):
            return None
        kept = json.loads(text)
        categories = tuple(_category(facts) for facts in kept["categories"])
        return categories, dict(kept["respelt"]), _pointed(kept["pointed"])
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None


def keep(folder: Path, key: str, categories: tuple[Category, ...], respelt: dict[str, str], pointed: Pointed) -> None:
    """Write them, whole or not at all; a folder that cannot be written is no error."""
    facts = [asdict(category) for category in categories]
    text = json.dumps({"categories": facts, "respelt": respelt, "pointed": asdict(pointed)}).encode()
    with suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=folder)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(_digest(key, text) + b"\n" + text)
            Path(name).replace(_path(folder, key))
        except BaseException:
            Path(name).unlink(missing_ok=True)
            raise


def _path(folder: Path, key: str) -> Path:
    return folder / f"categories-{FORMAT}-{key[:16]}.json"


def _digest(key: str, text: bytes) -> bytes:
    """The first line of a file: of which Turtle files it is, and that it is whole."""
    return hashlib.sha256(key.encode() + text).hexdigest().encode()


def _category(facts: dict[str, Any]) -> Category:
    law = {part: tuple(map(_legal, facts[part])) for part in ("law", "in_context")}
    return Category(**{**facts, **{name: tuple(facts[name]) for name in _TUPLES}, **law})


def _legal(facts: dict[str, Any]) -> Legal:
    return Legal(**{**facts, "sources": tuple(facts["sources"])})


def _pointed(facts: dict[str, Any]) -> Pointed:
    situations = (Situation(**{**said, "look_at": tuple(said["look_at"])}) for said in facts["situations"])
    at_stake = tuple((kind, tuple(names)) for kind, names in facts["at_stake"])
    return Pointed(tuple(Pointer(**said) for said in facts["provisions"]), tuple(situations), at_stake)
