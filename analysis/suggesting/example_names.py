"""A few rules about names, and what they are about, for the examples in docstrings."""

from __future__ import annotations

from rosprivacy.analysis.model import Confidence, Place
from rosprivacy.analysis.suggesting.name_rules import NameRule, NameRules

_AT = Place("names.yaml", 1)
_VIDEO = NameRule(("Video",), Confidence.MAY, "pictures", _AT)
NAMES = NameRules(
    carries={
        ("camera",): _VIDEO,
        ("image",): _VIDEO,
        ("video",): _VIDEO,
        ("depth",): NameRule(("DepthImage",), Confidence.MAY, "distances", _AT, instead_of=("Video",)),
        ("faces",): NameRule(("FaceTemplate",), Confidence.MAY, "faces", _AT),
    },
    nothing={("cmd", "vel"): NameRule((), Confidence.MAY, "a velocity", _AT)},
    brings_in={("camera",): _VIDEO},
    lets_out={("archive",): NameRule((), Confidence.MAY, "it keeps what it gets", _AT)},
    silent=frozenset([("info",)]),
    neutral=frozenset(["raw"]),
    becomes={"Video": {"FaceTemplate": NameRule(("FaceTemplate",), Confidence.MAY, "faces are found in it", _AT)}},
)
