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

from rosprivacy.analysis.model import Category, Legal

FORMAT = 7  # one more when what is kept, or what is refused, changes
_TUPLES = ("broader", "synonyms", "data_types", "identity_factors", "same_as", "within", "stated_of")


def default_folder() -> Path:
    """Return the user's cache folder."""
    from platformdirs import user_cache_path  # noqa: PLC0415 - light start

    return user_cache_path("rosprivacy")


def get(folder: Path, key: str) -> tuple[tuple[Category, ...], dict[str, str]] | None:
    """Return the categories and former spellings that an earlier run kept, if they are whole and of these files."""
    try:
        kept = json.loads(_path(folder, key).read_text("utf-8"))
        if kept["key"] != key or kept["digest"] != _digest(kept["categories"], kept["respelt"]):
            return None
        return tuple(_category(facts) for facts in kept["categories"]), dict(kept["respelt"])
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None


def keep(folder: Path, key: str, categories: tuple[Category, ...], respelt: dict[str, str]) -> None:
    """Write them, whole or not at all; a folder that cannot be written is no error."""
    facts = json.loads(json.dumps([asdict(category) for category in categories]))
    text = json.dumps({"key": key, "digest": _digest(facts, respelt), "categories": facts, "respelt": respelt})
    with suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=folder)
        try:
            with os.fdopen(handle, "w", encoding="utf-8") as file:
                file.write(text)
            Path(name).replace(_path(folder, key))
        except BaseException:
            Path(name).unlink(missing_ok=True)
            raise


def _path(folder: Path, key: str) -> Path:
    return folder / f"categories-{FORMAT}-{key[:16]}.json"


def _digest(categories: Any, respelt: Any) -> str:
    return hashlib.sha256(json.dumps([categories, respelt], sort_keys=True).encode()).hexdigest()


def _category(facts: dict[str, Any]) -> Category:
    law = tuple(Legal(**{**legal, "sources": tuple(legal["sources"])}) for legal in facts["law"])
    return Category(**{**facts, **{name: tuple(facts[name]) for name in _TUPLES}, "law": law})
