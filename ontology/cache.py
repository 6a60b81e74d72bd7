"""Categories kept in the user's cache folder, so that rdflib is imported only after a change.

In and out: categories under a key, the hash of the files that they were read from. The cache may be deleted at any
time; a damaged one is not used.
"""

from __future__ import annotations

import hashlib
import json
import os
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rosprivacy.analysis.model import Category, Legal, PersonGroup, Pointer, Situation
from rosprivacy.ontology.pointed import Pointed

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

FORMAT = 13  # one more when what is kept, or what is refused, changes


def default_folder() -> Path:
    """Return the user's cache folder."""
    from platformdirs import user_cache_path  # noqa: PLC0415 - light start

    return user_cache_path("rosprivacy")


CachedOntology = tuple[tuple[Category, ...], dict[str, str], Pointed]


def get(folder: Path, key: str) -> CachedOntology | None:
    """Return what an earlier run kept, if it is whole and of these files."""
    try:
        digest, text = _path(folder, key).read_bytes().split(b"\n", 1)
        if digest != _digest(key, text):
            return None
        kept = json.loads(text)
        categories = tuple(_category(row) for row in kept["categories"])
        return categories, dict(kept["respelt"]), _pointed(kept["pointed"])
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None


def keep(folder: Path, key: str, categories: tuple[Category, ...], respelt: dict[str, str], pointed: Pointed) -> None:
    """Write them, whole or not at all; a folder that cannot be written is no error."""
    import tempfile  # noqa: PLC0415 - light start

    text = json.dumps({"categories": categories, "respelt": respelt, "pointed": pointed}).encode()
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


def _frozen(row: list[Any]) -> Iterator[Any]:
    """The fields of a fact; what JSON makes a list is a tuple."""
    return (tuple(value) if isinstance(value, list) else value for value in row)


def _category(row: list[Any]) -> Category:
    kept = Category(*_frozen(row))
    return kept._replace(law=_legal(kept.law), in_context=_legal(kept.in_context))


def _legal(rows: Iterable[Any]) -> tuple[Legal, ...]:
    return tuple(Legal(*_frozen(row)) for row in rows)


def _pointed(row: list[Any]) -> Pointed:
    provisions, situations, at_stake, groups = row
    return Pointed(
        tuple(Pointer(*each) for each in provisions),
        tuple(Situation(*_frozen(each)) for each in situations),
        tuple((kind, tuple(names)) for kind, names in at_stake),
        tuple(PersonGroup(*_frozen(each)) for each in groups),
    )
