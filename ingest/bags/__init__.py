"""Bags (recordings of ROS messages) in, out comes what they say of themselves: topics, types, counts; no message."""
