"""The command ``ros2 privacy``: the words after it go in, what ``rosprivacy`` answers comes out."""
