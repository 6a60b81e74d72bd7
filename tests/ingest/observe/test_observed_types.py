"""Types are told of those alone who use a channel with known types only (rules S15, S16)."""

from __future__ import annotations

from rosprivacy.ingest.observe.observed_policy import prepared
from rosprivacy.ingest.observe.observed_types import types_yaml
from tests.helpers.observed import endpoint, saw


def test_who_also_writes_what_is_not_known_is_no_known_writer() -> None:
    """A limit holds only where the type of every writer is known; a type that is none is not known."""
    writers = [
        endpoint("/good", "publish", "/x", "std_msgs/msg/Bool"),
        endpoint("/odd", "publish", "/x", "std_msgs/msg/Bool"),
        endpoint("/odd", "publish", "/x", "<script>"),
        endpoint("/untold", "publish", "/x"),
    ]
    text = types_yaml(prepared(saw(*writers)).observation)
    assert "writers: [/good]" in text
    assert "/odd" not in text
    assert "/untold" not in text
