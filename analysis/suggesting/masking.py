"""Names as others may see them: words that everybody uses stay, each other word becomes a placeholder.

``/acme/ward_7/face_camera`` -> ``/x1/x2_x3/face_camera``. The same word is the same placeholder all through a run.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from rosprivacy.analysis.suggesting.name_rules import NameRules, Phrase

# Between a small and a capital letter, and beside a number, a word ends. What is no ASCII is a word of its own.
_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|[0-9]+|[^\x00-\x7f]+")
_PLACEHOLDER = re.compile("x[0-9]+")


class Mask:
    """What hides the words that are not known.

    Parameters
    ----------
    words
        Those that stay, in small letters.
    whole
        Texts that stay as they are: message types that everybody has.

    Examples
    --------
    >>> mask = Mask({"face", "camera", "cloud"}, {"sensor_msgs/msg/PointCloud2"})
    >>> [mask.masked(one) for one in ("/acme/ward_7/face_camera", "/acme/AcmeCloud7", "sensor_msgs/msg/PointCloud2")]
    ['/x1/x2_x3/face_camera', '/x1/x1Cloudx3', 'sensor_msgs/msg/PointCloud2']
    >>> mask.unmasked("x2_x3/face")
    'ward_7/face'
    """

    def __init__(self, words: Collection[str], whole: Collection[str] = ()) -> None:
        self._words, self._whole = frozenset(words), frozenset(whole)
        self._placeholders: dict[str, str] = {}
        self._meant: dict[str, str] = {}

    def masked(self, text: str) -> str:
        """Return a text with placeholders; upper and lower case count alike."""
        return text if text in self._whole else _WORD.sub(self._hidden, text)

    def unmasked(self, text: str) -> str:
        """Return a text with the words in place of their placeholders, each as it was first written."""
        return _PLACEHOLDER.sub(lambda found: self._meant.get(found[0], found[0]), text)

    def _hidden(self, found: re.Match[str]) -> str:
        word = found[0].casefold()
        if word in self._words:
            return found[0]
        if word not in self._placeholders:
            made = f"x{len(self._placeholders) + 1}"
            self._placeholders[word], self._meant[made] = made, found[0]
        return self._placeholders[word]


def common_words(rules: NameRules, types: Collection[str]) -> frozenset[str]:
    """Return the words of rules about names, and those of message types.

    >>> from rosprivacy.analysis.suggesting.example_names import NAMES
    >>> sorted(common_words(NAMES, ["sensor_msgs/msg/LaserScan"]) - common_words(NAMES, []))
    ['laser', 'msg', 'msgs', 'scan', 'sensor']
    """
    of_types = (word.lower() for name in types for word in _WORD.findall(name) if word.isalpha())
    return frozenset([*(word for phrase in _phrases(rules) for word in phrase), *of_types])


def _phrases(rules: NameRules) -> Iterator[Phrase]:
    for phrases in (rules.carries, rules.nothing, rules.brings_in, rules.lets_out, rules.silent, rules.wanted):
        yield from phrases
    for words in (rules.neutral, rules.reworked, rules.simulated):
        yield from ((word,) for word in words)
