"""Greets on the sign at the door."""

import paho.mqtt.client as mqtt
import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class DoorSign(Node):
    """Tells the sign, by MQTT, who comes and what was said."""

    def __init__(self) -> None:
        super().__init__("door_sign")
        self.client = mqtt.Client()
        self.client.connect("mosquitto")
        for topic in ("visitor", "speech"):
            self.create_subscription(String, topic, lambda message, topic=topic: self.show(topic, message), 10)

    def show(self, topic: str, message: String) -> None:
        """Send a text to the sign."""
        self.client.publish(f"door/{topic}", message.data)


def main() -> None:
    """Run the node."""
    rclpy.init()
    rclpy.spin(DoorSign())
