"""``python -m rosprivacy``."""

from rosprivacy.cli.app import main

main()
