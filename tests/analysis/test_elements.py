"""Elements: the same in every process, whatever the seed of its hashes (rules S1, S14)."""

from __future__ import annotations

import copy
import os
import pickle
import subprocess
import sys

from rosprivacy.analysis.model import Element

ELEMENT = Element("topic", "/camera*", "robot1", "", "write", ("rt/camera1",))
READ = """
import pickle, sys
from rosprivacy.analysis.model import Element
known = Element("topic", "/camera*", "robot1", "", "write", ("rt/camera1",))
assert pickle.loads(sys.stdin.buffer.read()) in {known}
"""


def test_an_element_from_another_process_is_found_in_a_set() -> None:
    """As Spark's workers send them: a hash is another one there."""
    for seed in ("1", "2"):
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        subprocess.run([sys.executable, "-c", READ], input=pickle.dumps(ELEMENT), env=environment, check=True)


def test_a_copy_is_the_same_element() -> None:
    assert {copy.deepcopy(ELEMENT), copy.copy(ELEMENT)} == {ELEMENT}
    assert "hash" not in repr(ELEMENT)
