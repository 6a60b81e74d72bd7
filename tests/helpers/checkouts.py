"""A small checkout: a camera, an uploader and a launch file that starts both; written into a folder of a test."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

MANIFEST = "<package format='3'><name>guide</name><export><build_type>ament_python</build_type></export></package>\n"
SETUP = """from setuptools import setup

setup(
    name="guide",
    entry_points={"console_scripts": ["camera = guide.camera:main", "uploader = guide.uploader:main"]},
)
"""
CAMERA = """import cv2
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import Image


class Camera(Node):
    def __init__(self):
        super().__init__("camera")
        self.device = cv2.VideoCapture(0)
        self.images = self.create_publisher(Image, "image", 10)


def main():
    rclpy.init()
    rclpy.spin(Camera())
"""
UPLOADER = """import rclpy
import requests
from rclpy.node import Node
from sensor_msgs.msg import Image


class Uploader(Node):
    def __init__(self):
        super().__init__("uploader")
        self.create_subscription(Image, "video", self.send, 10)

    def send(self, message):
        requests.post("https://cloud.example/upload?key=hidden", data=bytes(message.data))


def main():
    rclpy.init()
    rclpy.spin(Uploader())
"""
LAUNCH = """from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package="guide", executable="camera", namespace="robot"),
        Node(package="guide", executable="uploader", remappings=[("video", "/robot/image")]),
    ])
"""
FILES = {
    "package.xml": MANIFEST,
    "setup.py": SETUP,
    "guide/camera.py": CAMERA,
    "guide/uploader.py": UPLOADER,
    "launch/guide.launch.py": LAUNCH,
}


def put_checkout(folder: Path, **more: str) -> Path:
    """Write the checkout; ``more`` are further files, with ``__`` for ``/`` and ``_dot_`` for a dot."""
    named = {name.replace("__", "/").replace("_dot_", "."): text for name, text in more.items()}
    for name, text in (FILES | named).items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, "utf-8")
    return folder
