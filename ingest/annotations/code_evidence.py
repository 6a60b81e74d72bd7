"""What code says plainly of channels: types and literal names, as evidence for suggestions; no graph is made of it.

Measured on public packages: two thirds of the ends of channels have a literal name, a third a node that is known.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from rosprivacy.analysis.model import Place
from rosprivacy.ingest.annotations.code_names import ROOT, CodeNames
from rosprivacy.ingest.annotations.source_code import NODE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rosprivacy.ingest.annotations.source_code import Code


class CodeEvidence(NamedTuple):
    """One call that makes an end of a channel.

    Attributes
    ----------
    kind
        ``topic``, ``service`` or ``action``.
    role
        ``publish``, ``subscribe``, ``reply``, ``request``, ``execute``, ``call``.
    name, node
        Full names of the channel and of its node; empty where the code does not say.
    type
        ``pkg/msg/Name``; empty where the file does not say.
    """

    place: Place
    kind: str
    role: str
    name: str = ""
    type: str = ""
    node: str = ""


def code_evidence(codes: Sequence[Code], namespace: str = ROOT) -> tuple[CodeEvidence, ...]:
    """Return what some files say of channels, by file and line.

    Parameters
    ----------
    namespace
        Of nodes that state none.
    """
    names = CodeNames(codes, namespace)
    return tuple(
        sorted(
            CodeEvidence(
                Place(code.file, site.lines.first),
                site.kind,
                site.role,
                names.name(code, site),
                site.type,
                names.node(code, site.owner),
            )
            for code in codes
            for site in code.sites
            if site.kind != NODE
        )
    )
