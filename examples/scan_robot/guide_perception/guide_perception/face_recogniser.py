"""Who stands before the guide."""

import pickle
from pathlib import Path

import face_recognition
import rclpy
from cv_bridge import CvBridge
from rclpy.node import Node
from sensor_msgs.msg import Image
from std_msgs.msg import String

FACES = Path("/data/faces.pickle")


class FaceRecogniser(Node):
    """Names the visitors that it has seen before, and keeps the faces of new ones."""

    def __init__(self) -> None:
        super().__init__("face_recogniser")
        self.bridge = CvBridge()
        self.faces = pickle.loads(FACES.read_bytes()) if FACES.exists() else []  # noqa: S301 - written by itself
        self.visitors = self.create_publisher(String, "visitor", 10)
        self.create_subscription(Image, "image", self.recognise, 10)

    def recognise(self, message: Image) -> None:
        """Publish the number of each visitor in an image."""
        image = self.bridge.imgmsg_to_cv2(message, "rgb8")
        for face in face_recognition.face_encodings(image):
            same = face_recognition.compare_faces(self.faces, face)
            if True not in same:
                self.faces.append(face)
                same.append(True)
                with FACES.open("wb") as file:
                    pickle.dump(self.faces, file)
            self.visitors.publish(String(data=f"visitor {same.index(True)}"))


def main() -> None:
    """Run the node."""
    rclpy.init()
    rclpy.spin(FaceRecogniser())
