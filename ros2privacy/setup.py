"""The package for colcon and bloom: no scripts, one entry point, no dependencies."""

from setuptools import setup

setup(
    name="ros2privacy",
    version="0.2.0",
    packages=["ros2privacy"],
    python_requires=">=3.8",
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/ros2privacy"]),
        ("share/ros2privacy", ["package.xml"]),
    ],
    zip_safe=True,
    author="The rosprivacy authors",
    description="The command 'ros2 privacy': where personal data can go in a ROS 2 system.",
    license="Apache-2.0",
    entry_points={"ros2cli.command": ["privacy = ros2privacy.command:PrivacyCommand"]},
)
