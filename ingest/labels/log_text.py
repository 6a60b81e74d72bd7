"""What the log of ROS holds: text (rule S13). So it is no harmless channel of what can be said in words.

In: a name or glob of a topic; the kinds of data. Out: whether it covers ``rosout``; the kinds that no text holds.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosprivacy.analysis.written_names import meant
from rosprivacy.ingest.policies.names import covers

if TYPE_CHECKING:
    from rosprivacy.ontology.vocabulary import Vocabulary

LOG = "rosout"
TEXT = frozenset({"text", "identifier"})


def is_log(name: str) -> bool:
    """Return whether a name or glob covers the log of some namespace.

    >>> [is_log(name) for name in ("*/rosout", "=/a/rosout", "/*", "/rosout_agg", "*/clock")]
    [True, True, True, False, False]
    """
    return covers(meant(name).rpartition("/")[2], LOG)


def without_text(vocabulary: Vocabulary) -> tuple[str, ...]:
    """Return the broadest kinds of which neither they nor a narrower one is text or an identifier.

    >>> from rosprivacy.ontology.vocabulary import load
    >>> kinds = without_text(load())
    >>> [name in kinds for name in ("PersonImage", "SpeechTranscript", "Location", "PersonalData")]
    [True, False, False, False]
    """
    above = vocabulary.hierarchy.ancestors
    texts = {name for name, kind in vocabulary.categories.items() if TEXT.intersection(kind.data_types)}
    holds = {broader for name in texts for broader in above[name]}
    return tuple(sorted(name for name in above if name not in holds and holds.issuperset(above[name].keys() - {name})))
