"""A few rules about names, and what they are about, for the examples in docstrings."""

from __future__ import annotations

from rosprivacy.analysis.model import Confidence, Place
from rosprivacy.analysis.suggesting.name_rules import NameRules, Rule

_AT = Place("names.yaml", 1)
_VIDEO = Rule(("Video",), Confidence.MAY, "pictures", _AT)
NAMES = NameRules(
    carries={
        ("camera",): _VIDEO,
        ("image",): _VIDEO,
        ("video",): _VIDEO,
        ("depth",): Rule(("DepthImage",), Confidence.MAY, "distances", _AT, instead_of=("Video",)),
        ("faces",): Rule(("FaceTemplate",), Confidence.MAY, "faces", _AT),
    },
    nothing={("cmd", "vel"): Rule((), Confidence.MAY, "a velocity", _AT)},
    brings_in={("camera",): _VIDEO},
    lets_out={("archive",): Rule((), Confidence.MAY, "it keeps what it gets", _AT)},
    silent=frozenset([("info",)]),
    neutral=frozenset(["raw"]),
    becomes={"Video": {"FaceTemplate": Rule(("FaceTemplate",), Confidence.MAY, "faces are found in it", _AT)}},
)
