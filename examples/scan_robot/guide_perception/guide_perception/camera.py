"""The camera of the guide."""

import cv2
import rclpy
from cv_bridge import CvBridge
from rclpy.node import Node
from sensor_msgs.msg import Image


class Camera(Node):
    """Publishes what the camera sees, under a name that a parameter gives."""

    def __init__(self) -> None:
        super().__init__("camera")
        self.declare_parameter("topic", "image_raw")
        topic = self.get_parameter("topic").value
        self.images = self.create_publisher(Image, topic, 10)
        self.capture = cv2.VideoCapture(0)
        self.bridge = CvBridge()
        self.create_timer(0.1, self.look)

    def look(self) -> None:
        """Publish one image."""
        seen, frame = self.capture.read()
        if seen:
            self.images.publish(self.bridge.cv2_to_imgmsg(frame, "bgr8"))


def main() -> None:
    """Run the node."""
    rclpy.init()
    rclpy.spin(Camera())
