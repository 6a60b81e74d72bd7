"""Annotations in code that is not read, as code of others: they would be lost without a word (rule S11).

In: files in folders such as ``vendor`` and ``build``. Out: a problem for each annotation there. Most of such code has
none, and may be of any age: it is not parsed, and what cannot be read has none.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from rosprivacy.analysis.errors import LabelError, shown
from rosprivacy.analysis.model import Place
from rosprivacy.ingest.annotations.annotation_text import OF_NODES, SIGN, read_annotation
from rosprivacy.ingest.annotations.source_files import MAX_BYTES
from rosprivacy.ingest.reading.bounded_file import read_regular

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from rosprivacy.ingest.annotations.annotation_text import Annotation
    from rosprivacy.ontology.vocabulary import Vocabulary

COMMENT = ("#", "//", "/*", "*", "//!", "///")  # what an annotation comes behind
MARKS = (f"{SIGN}:", f"{SIGN}(")


def lost_annotations(unread: Iterable[tuple[str, str]], vocabulary: Vocabulary) -> Iterator[LabelError]:
    """Yield a problem for each annotation in code that was left out.

    Parameters
    ----------
    unread
        As of ``Sources``.
    """
    for file, folder in unread:
        for number, line in enumerate(_lines(file), 1):
            before, sign, rest = line.partition(SIGN)
            text = (sign + rest).removesuffix("*/")
            if text.startswith(MARKS) and before.rstrip().endswith(COMMENT):
                place = Place(file, number)
                if _is_meant(text, read_annotation(text, place, vocabulary)):
                    what = f"this annotation is not read, since {shown(folder)} is taken for code of others"
                    hint = "name that folder, too, to have it read; or put a file COLCON_IGNORE into it to leave it out"
                    yield LabelError(*place, what, hint)


def _is_meant(text: str, read: Annotation | LabelError | None) -> bool:
    """Whether it is an annotation, or a wrong one about what a node does: others write of privacy, too."""
    word = text.partition(":")[2].split(maxsplit=1)[:1]
    return not isinstance(read, LabelError | None) or word in ([one] for one in OF_NODES)


def _lines(file: str) -> list[str]:
    """The lines of a file that may have an annotation."""
    try:
        data = read_regular(file, MAX_BYTES, partial(LabelError, file))
    except LabelError:
        return []
    return [line.rstrip() for line in data.decode("utf-8", "replace").split("\n")] if SIGN.encode() in data else []
