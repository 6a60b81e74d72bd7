"""The words after ``ros2 bag record`` -> which topics are recorded, and what the recorder is called.

What an option takes out of a recording, or chooses by something else than a name, is not followed: all may be recorded.

Source: rosbag2, ``ros2bag/ros2bag/verb/record.py`` of the commits 0027003608d8 and 7beb5845fe7c; in the second one
topics have no option before them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

RECORDER = "rosbag2_recorder"  # the node, unless an option says otherwise
EVERY = ("-a", "--all", "--all-topics", "-e", "--regex", "--topic-types", "--static-topics-path")
TOPICS = ("", "--topics")  # a word that belongs to no option is a topic
WITHOUT_VALUE = (
    "-a", "--all", "--all-topics", "--all-services", "--all-actions", "--include-unpublished-topics",
    "--include-hidden-topics", "--no-discovery", "--ignore-leaf-topics", "--start-paused", "--use-sim-time",
    "--snapshot-mode", "--disable-keyboard-controls",
)  # fmt: skip
WITH_VALUES = (
    "--topics", "--services", "--actions", "--topic-types", "--exclude-topics", "--exclude-topic-types",
    "--exclude-services", "--exclude-actions", "--custom-data", "--repeat-transient-local",
)  # fmt: skip


class Recording(NamedTuple):
    """What a command records.

    Attributes
    ----------
    topics
        As they are written.
    every
        Whether it may be any topic.
    """

    topics: tuple[str, ...]
    every: bool = False


def recording(words: Sequence[str]) -> Recording:
    """Return what the words after ``ros2 bag record`` record.

    >>> recording("-o day /image /scan".split()), recording(["-a", "-x", "/image.*"])
    (Recording(topics=('/image', '/scan'), every=False), Recording(topics=(), every=True))
    """
    values = list(_values(words))
    topics = dict.fromkeys(word for option, word in values if word and option in TOPICS)
    return Recording(tuple(topics), any(option in EVERY for option, _ in values))


def recorder_name(words: Sequence[str]) -> str:
    """Return what the node of ``ros2 bag record`` is called.

    >>> recorder_name(["-a", "--node-name", "black_box"]), recorder_name(["-a"])
    ('black_box', 'rosbag2_recorder')
    """
    return next((word for option, word in _values(words) if option == "--node-name" and word), RECORDER)


def _values(words: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Each option with what ``=`` gives it, if anything, and each word with the option whose value it is."""
    option, full = "", False
    for word in words:
        if word.startswith("-"):
            option, _, value = word.partition("=")
            full = bool(value) or option in WITHOUT_VALUE
            yield option, value
        else:
            yield ("" if full and option not in WITH_VALUES else option), word
            full = True
