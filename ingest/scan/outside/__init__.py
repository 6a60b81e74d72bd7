"""What code, compose files and bridges say of the world outside ROS, and what code writes into logs.

In: sources that were read, configurations. Out: ``External`` and ``LogCall`` of ``scan_facts.py``, and a label file.
"""
