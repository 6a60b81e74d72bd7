"""``python -m rosprivacy``."""

from rosprivacy.cli import main

main()
