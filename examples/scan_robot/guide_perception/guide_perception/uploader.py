"""Pictures of the day, for the web page of the museum."""

import rclpy
import requests
from rclpy.node import Node
from sensor_msgs.msg import Image


class Uploader(Node):
    """Sends each hundredth image to a cloud."""

    def __init__(self) -> None:
        super().__init__("uploader")
        self.declare_parameter("server", "https://pictures.example.org/upload")
        self.number = 0
        self.create_subscription(Image, "image", self.upload, 10)

    def upload(self, message: Image) -> None:
        """Send an image."""
        self.number += 1
        if self.number % 100 == 0:
            requests.post(self.get_parameter("server").value, data=bytes(message.data), timeout=10)


def main() -> None:
    """Run the node."""
    rclpy.init()
    rclpy.spin(Uploader())
