"""A camera node with annotations; ``rosprivacy annotations`` reads them, and runs nothing."""

import rclpy
from rclpy.node import Node
from sensor_msgs.msg import CameraInfo, Image


class Camera(Node):
    """Publishes what it sees."""

    def __init__(self) -> None:
        super().__init__("camera")
        # privacy: source Video
        # privacy: sensitive
        # privacy: note looks at the entrance
        self.images = self.create_publisher(Image, "image", 10)
        self.info = self.create_publisher(CameraInfo, "camera_info", 10)  # privacy: mundane


# privacy: leak PersonalData
# privacy: note sends all it gets to the maker's cloud
class Uplink(Node):
    """Sends images without faces to a server."""

    def __init__(self) -> None:
        super().__init__("uplink")
        self.create_subscription(Image, "image_blurred", self.send, 10)

    def send(self, image: Image) -> None:
        """Send one image."""


def main() -> None:
    """Run both nodes."""
    rclpy.init()
    rclpy.spin(Camera())
