"""Folders with what pages of the documentation name: policies, labels, code, keystores, bags, fleets."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

from tests.helpers.bags import rosbag2
from tests.helpers.keystores import Keystore, governance, grant, permissions, rule
from tests.helpers.paths import ROOT

EXAMPLES = ROOT / "examples"
FACTORY = EXAMPLES / "factory"
CAMERA_AND_UPLINK = "labels: 1\nnodes: {/camera: {source: [Video]}, /uplink: {leak: [Video]}}\n"
RECORDED = "labels: 1\nnodes: {/cam: {source: {Video: [/camera]}}}\nchannels: {/odom: {only: [Location]}}\n"
POLICY = """<?xml version="1.0"?>
<policy version="0.2.0"><enclaves>{enclaves}</enclaves></policy>
"""
ENCLAVE = """<enclave path="/{enclave}"><profiles><profile ns="/" node="{node}">
<topics {use}="ALLOW">{topics}</topics>
</profile></profiles></enclave>
"""
ACCESS_LIST = """{{  // what one session of Zenoh may do
  access_control: {{
    enabled: true, default_permission: "deny",
    rules: [{{id: "video", permission: "allow", messages: ["put"], flows: ["{flow}"], key_exprs: ["0/video/*/*"]}}],
    subjects: [{{id: "any"}}], policies: [{{rules: ["video"], subjects: ["any"]}}],
  }},
}}
"""
SUGGESTED = """labels: 1
nodes:
  /safety_camera: {source: [Video]}
# suggest: likely {"nodes": {"/robot_camera": {"source": ["Video"]}}} because of its name
# suggest: may {"nodes": {"/display": {"leak": ["PersonalData"]}}} because of its name
"""
DESCRIPTION = """nodl_version: "2"
publishers:
  - {topic: image, type: sensor_msgs/msg/Image}
"""


def shell(line: str, folder: Path, **variables: str) -> subprocess.CompletedProcess[str]:
    """Run a line as a reader types it, with the program of this environment; nobody answers what it asks."""
    return subprocess.run(
        ["bash", "-c", line], cwd=folder, env=environment(folder, **variables), stdin=subprocess.DEVNULL,
        capture_output=True, text=True, check=False,
    )  # fmt: skip


def environment(folder: Path, **variables: str) -> dict[str, str]:
    """The variables of a reader whose home is a folder, and who has no desktop."""
    own = {"HOME": str(folder / "home"), "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}", **variables}
    return {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")} | own


def policy(**nodes: tuple[str, tuple[str, ...]]) -> str:
    """A policy of nodes, each in an enclave of its own: ``publish`` or ``subscribe``, and topics."""
    enclaves = (
        ENCLAVE.format(enclave=node, node=node, use=use, topics="".join(f"<topic>{name}</topic>" for name in topics))
        for node, (use, topics) in nodes.items()
    )
    return POLICY.format(enclaves="".join(enclaves))


def system(folder: Path) -> None:
    """A robot under the names that pages give it, with labels."""
    for name in ("my_robot", "robot", "old", "granted"):
        shutil.copy(FACTORY / "before.policy.xml", folder / f"{name}.policy.xml")
    shutil.copy(FACTORY / "after.policy.xml", folder / "new.policy.xml")
    shutil.copy(FACTORY / "node.xml", folder)
    for name in ("labels.yaml", "robot.labels.yaml"):
        shutil.copy(FACTORY / "run3.labels.yaml", folder / name)
    (folder / "examples").symlink_to(EXAMPLES)
    (folder / "policies").mkdir()
    for name in ("before.policy.xml", "node.xml"):
        shutil.copy(FACTORY / name, folder / "policies")
    for name in ("assessment.json", "answers.json"):
        (folder / name).write_text('{"format": "rosprivacy.assessment/1", "answers": {}}', "utf-8")


def factory(folder: Path) -> None:
    shutil.copytree(FACTORY, folder, dirs_exist_ok=True)


def fleet(folder: Path) -> None:
    shutil.copytree(EXAMPLES / "fleet", folder, dirs_exist_ok=True)


def last_week(folder: Path) -> None:
    shell("rosprivacy analyze --fleet fleet.yaml --format json -o last-week.json", folder)


def reported(folder: Path) -> None:
    shell("rosprivacy analyze my_robot.policy.xml -l labels.yaml --format json -o last_month.json", folder)


def checkout(folder: Path) -> None:
    """Source code in a repository, of which the base is known."""
    shutil.copytree(EXAMPLES / "scan_robot", folder / "my_robot")
    (folder / "my_robot" / "launch").mkdir()
    launch = EXAMPLES / "scan_robot/guide_bringup/launch/guide.launch.py"
    shutil.copy(launch, folder / "my_robot/launch/robot.launch.py")
    (folder / "camera.nodl.yaml").write_text(DESCRIPTION, "utf-8")
    repository(folder)
    subprocess.run(["git", "update-ref", "refs/remotes/origin/main", "HEAD"], cwd=folder, check=True)


def repository(folder: Path) -> None:
    git = ["git", "-c", "user.name=A", "-c", "user.email=a@example.org"]
    for words in (["init", "-q"], ["add", "."], ["commit", "-qm", "base"]):
        subprocess.run([*git, *words], cwd=folder, check=True)


def labelled_checkout(folder: Path) -> None:
    checkout(folder)
    (folder / "robot.policy.xml").unlink()
    (folder / "labels.yaml").write_text("labels: 1\nnodes:\n  '*/camera': {source: [Video]}\n", "utf-8")


def annotated(folder: Path) -> None:
    (folder / "robot.labels.yaml").unlink()


def observed(folder: Path) -> None:
    shutil.copy(EXAMPLES / "telepresence" / "graph.txt", folder)
    for name in ("robot.policy.xml", "labels.yaml"):
        (folder / name).unlink()


def begun(folder: Path) -> None:
    """What somebody has who begins: a text of what runs, and nothing of this program."""
    shutil.copy(EXAMPLES / "telepresence" / "graph.txt", folder)
    for name in ("robot.policy.xml", "robot.labels.yaml", "labels.yaml"):
        (folder / name).unlink()


def suggested(folder: Path) -> None:
    cameras = {"safety_camera": ("publish", ("video",)), "robot_camera": ("publish", ("new_pose",))}
    text = policy(**cameras, display=("subscribe", ("video", "new_pose")))
    (folder / "robot.policy.xml").write_text(text, "utf-8")
    (folder / "robot.labels.yaml").write_text(SUGGESTED, "utf-8")


def typed(folder: Path) -> None:
    (folder / "robot.types.yaml").write_text(
        "types: 1\ntopics:\n  /new_pose: [{type: geometry_msgs/msg/Pose}]\n", "utf-8"
    )


def deployed(folder: Path) -> None:
    """A camera and an uplink: a keystore and files that ``openssl`` has signed, access lists, and their policy."""
    video = "rt/video"
    rules = {"camera": rule("allow", publish=(video,)), "uplink": rule("allow", subscribe=(video,))}
    made = Keystore(folder / "keystore")
    made.governance(governance())
    for name, allowed in rules.items():
        made.enclave(f"/{name}", permissions(grant(f"/{name}", allowed)))
        (folder / name).mkdir()
    made.sign(permissions(grant("/camera", rules["camera"])), folder / "camera" / "permissions.p7s")
    (folder / "uplink" / "permissions.xml").write_text(permissions(grant("/uplink", rules["uplink"])), "utf-8")
    (folder / "governance.xml").write_text(governance(), "utf-8")
    (folder / "ours").mkdir()
    shutil.copy(folder / "keystore" / "public" / "permissions_ca.cert.pem", folder / "ours")
    for name, flow in (("camera", "egress"), ("uplink", "ingress")):
        (folder / f"{name}.json5").write_text(ACCESS_LIST.format(flow=flow), "utf-8")
    text = policy(camera=("publish", ("video",)), uplink=("subscribe", ("video",)))
    (folder / "robot.policy.xml").write_text(text, "utf-8")
    (folder / "robot.labels.yaml").write_text(CAMERA_AND_UPLINK, "utf-8")


def recorded(folder: Path) -> None:
    """Bags with a camera and a place, in MCAP, and the policy of the robot that recorded them."""
    for name in ("run1", "recordings/monday", "recordings/tuesday"):
        (folder / name).parent.mkdir(exist_ok=True)
        rosbag2(folder / name)
    text = policy(cam=("publish", ("camera", "odom")), recorder=("subscribe", ("camera", "odom")))
    (folder / "my_robot.policy.xml").write_text(text, "utf-8")
    (folder / "labels.yaml").write_text(RECORDED, "utf-8")


def decided(folder: Path) -> None:
    """A repository, a key to sign with, and a topic that nobody reads."""
    file = folder / "my_robot.policy.xml"
    text = file.read_text("utf-8")
    more = '<topics publish="ALLOW"><topic>other</topic></topics>'
    file.write_text(text.replace('node="safety_camera">', f'node="safety_camera">{more}'), "utf-8")
    (folder / "home" / ".ssh").mkdir(parents=True)
    key = str(folder / "home" / ".ssh" / "id_ed25519")
    subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", key], check=True)
    repository(folder)


def project(folder: Path) -> None:
    """A project file that names the policy of the robot and its labels."""
    (folder / "robot.labels.yaml").unlink()
    text = 'policies = ["robot.policy.xml"]\nlabels = ["labels.yaml"]\n'
    (folder / "rosprivacy.toml").write_text(text, "utf-8")
