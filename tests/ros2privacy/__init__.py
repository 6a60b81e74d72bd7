"""The package ros2privacy: what ros2cli does with it."""
