"""A fleet in parts, for fleets past one machine: each part is analysed where it is, and only its border travels.

In: a fleet file. Out: the answer of ``systems/fleet_system.py``, and results as Parquet. ``workers.py`` is what is
done with one part, ``border.py`` and ``part_patterns.py`` are what its border says,
``distributed.py`` puts the parts together. ``fleet_on_spark.py`` is the way through; ``session.py`` and ``parquet.py``
alone know Apache Spark, which hands out the parts.
"""
