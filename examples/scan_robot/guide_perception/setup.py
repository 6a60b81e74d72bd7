"""What this package runs."""

from setuptools import setup

setup(
    name="guide_perception",
    version="1.0.0",
    packages=["guide_perception"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/guide_perception"]),
        ("share/guide_perception", ["package.xml"]),
    ],
    entry_points={
        "console_scripts": [
            "camera = guide_perception.camera:main",
            "door_sign = guide_perception.door_sign:main",
            "face_recogniser = guide_perception.face_recogniser:main",
            "listener = guide_perception.listener:main",
            "uploader = guide_perception.uploader:main",
        ],
    },
)
