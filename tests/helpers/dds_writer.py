"""A program of DDS that writes a topic and is no ROS node, by Cyclone DDS, as a process of its own."""

from __future__ import annotations

import subprocess
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

WRITER = """
import sys
from dataclasses import dataclass
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.pub import DataWriter
from cyclonedds.topic import Topic

@dataclass
class Text(IdlStruct, typename="std_msgs::msg::dds_::String_"):
    data: str

participant = DomainParticipant(int(sys.argv[1]))
writer = DataWriter(participant, Topic(participant, sys.argv[2], Text))
print("there", flush=True)
sys.stdin.read()
"""


@contextmanager
def dds_writer(domain: int, topic: str) -> Iterator[None]:
    """Write a topic of a domain, by its name in DDS, for as long as the block lasts."""
    words = [sys.executable, "-c", WRITER, str(domain), topic]
    with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout
        assert process.stdout.readline() == "there\n"
        yield
