"""Starts all that the guide runs, in a namespace of its own."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_xml.launch_description_sources import XMLLaunchDescriptionSource


def generate_launch_description() -> LaunchDescription:
    """Return what is started."""
    share = Path(get_package_share_directory("guide_bringup"))
    robot = LaunchConfiguration("robot")
    seen = [("image", "front/image_raw")]

    def perception(executable: str, **options: object) -> Node:
        return Node(package="guide_perception", executable=executable, namespace=robot, **options)

    motion = XMLLaunchDescriptionSource(str(share / "launch" / "motion.launch.xml"))
    return LaunchDescription(
        [
            DeclareLaunchArgument("robot", default_value="guide"),
            perception("camera", parameters=[str(share / "config" / "guide.yaml")]),
            perception("face_recogniser", remappings=seen),
            perception("uploader", remappings=seen),
            Node(package="audio_common", executable="audio_capturer_node", namespace=robot),
            perception("listener"),
            perception("door_sign", remappings=[("speech", "listener/speech")]),
            IncludeLaunchDescription(motion, launch_arguments={"robot": robot}.items()),
        ]
    )
