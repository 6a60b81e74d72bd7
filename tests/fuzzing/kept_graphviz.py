"""One Graphviz for many reports: the real one draws, and is started once instead of once for each picture."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING
from unittest.mock import patch

from rosprivacy.report.pictures.graphviz import Graphviz

if TYPE_CHECKING:
    from collections.abc import Iterator


@contextmanager
def kept_graphviz() -> Iterator[None]:
    """Within this, the process of a ``Graphviz`` goes to the next one; one that was ended is started anew."""
    kept = Graphviz()

    def take(graphviz: Graphviz) -> Graphviz:
        graphviz._process, kept._process = kept._process, None
        return graphviz

    def leave(graphviz: Graphviz, *_: object) -> None:
        kept._process, graphviz._process = graphviz._process, None

    with patch.object(Graphviz, "__enter__", take), patch.object(Graphviz, "__exit__", leave):
        try:
            yield
        finally:
            kept.close()
