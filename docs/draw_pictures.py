"""Draw the pictures of the pages, by the commands that stand there; needs the corpus.

    python docs/draw_pictures.py [NAME…]

To add a system, add it to ``SYSTEMS``, and its pictures to ``PICTURES``.
"""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

DOCS = Path(__file__).resolve().parent
EXAMPLES = DOCS.parent / "examples"
CORPUS = Path(os.environ.get("ROSPRIVACY_CORPUS", DOCS.parent.parent / "shared" / "corpus"))


@dataclass(frozen=True, slots=True)
class System:
    """What is drawn.

    Attributes
    ----------
    folder
        Where the files are; the pictures name policy lines as seen from there.
    files
        As on the command line.
    """

    folder: Path
    files: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Drawing:
    """One picture.

    Attributes
    ----------
    name
        Of the file in ``pictures``. Those that end in ``-all`` are to be opened, not to be read on the page.
    system
        Key of ``SYSTEMS``.
    options
        Of ``rosprivacy graph``.
    """

    name: str
    system: str
    options: str = ""


TB3 = "policies/ros-swg__turtlebot3_demo/policies/tb3_gazebo_policy.xml"
TB3_LABELS = "categorizations/JonasWoh__ROS2PrivacyGraph/categorizations/categorization_turtlebot3_step_5.json"
SYSTEMS = {
    "factory": System(EXAMPLES / "factory", ("before.policy.xml", "-l", "run2.labels.yaml")),
    "factory-filtered": System(EXAMPLES / "factory", ("after.policy.xml", "-l", "run4.labels.yaml")),
    "care-home": System(EXAMPLES / "care-home", ("care-home.policy.xml", "-l", "care-home.labels.yaml")),
    "fleet": System(EXAMPLES / "fleet", ("--fleet", "fleet.yaml")),
    "scan-robot": System(EXAMPLES, ("scan_robot", "-l", "scan_robot/guide.labels.yaml")),
    "turtlebot3": System(CORPUS, (TB3, "-l", TB3_LABELS)),
}
NEAR = "--around /turtlebot3_laserscan --fold --no-loose-ends"
PICTURES = (
    Drawing("factory-ros", "factory"),
    Drawing("factory-privacy", "factory", "--show privacy"),
    Drawing("factory-filtered-privacy", "factory-filtered", "--show privacy"),
    Drawing("care-home-ros", "care-home", "--fold --cluster enclave --direction down"),
    Drawing("care-home-privacy", "care-home", "--show privacy --fold"),
    Drawing("care-home-finding", "care-home", "--show privacy --finding 59dc667b --direction down"),
    Drawing("fleet-ros", "fleet", "--robot carrier_01 --fold --cluster robot --direction down"),
    Drawing("fleet-ros-all", "fleet", "--fold --cluster robot"),
    Drawing("fleet-privacy", "fleet", "--show privacy --categories Video --fold --cluster robot --direction down"),
    Drawing("fleet-privacy-all", "fleet", "--show privacy --fold --cluster robot"),
    Drawing("scan-robot-privacy", "scan-robot", "--show privacy --fold"),
    Drawing("turtlebot3-ros", "turtlebot3", NEAR),
    Drawing("turtlebot3-ros-all", "turtlebot3", "--fold"),
    Drawing("turtlebot3-privacy", "turtlebot3", "--show privacy --fold --most 16 --direction down"),
    Drawing("turtlebot3-privacy-all", "turtlebot3", "--show privacy --fold"),
)


def main(wanted: list[str]) -> None:
    """Draw the pictures that are named, or all."""
    for drawing in PICTURES:
        if not wanted or drawing.name in wanted:
            system = SYSTEMS[drawing.system]
            output = DOCS / "pictures" / f"{drawing.name}.svg"
            command = ["rosprivacy", "graph", *system.files, *drawing.options.split(), "--output", str(output)]
            print(" ".join(command))
            subprocess.run([sys.executable, "-P", "-m", *command], cwd=system.folder, check=True)


if __name__ == "__main__":
    main(sys.argv[1:])
