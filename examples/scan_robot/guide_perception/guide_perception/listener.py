"""What visitors say."""

import numpy as np
import rclpy
import whisper
from audio_common_msgs.msg import AudioStamped
from rclpy.node import Node
from std_msgs.msg import String


class Listener(Node):
    """Turns speech into text, and logs what it heard."""

    def __init__(self) -> None:
        super().__init__("listener")
        self.model = whisper.load_model("base")
        self.speech = self.create_publisher(String, "~/speech", 10)
        self.create_subscription(AudioStamped, "audio", self.listen, 10)

    def listen(self, message: AudioStamped) -> None:
        """Publish what was said."""
        sound = np.array(message.audio.audio_data.int16_data, dtype=np.float32) / 32768
        heard = self.model.transcribe(sound)
        self.get_logger().info(f"heard: {heard['text']}")
        self.speech.publish(String(data=heard["text"]))


def main() -> None:
    """Run the node."""
    rclpy.init()
    rclpy.spin(Listener())
