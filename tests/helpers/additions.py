"""What people add to a database in Cypher."""

from __future__ import annotations

ADD_STORAGE = """
MATCH (n:RosNode {name: '/recorder'}), (video:DataCategory {name: 'Video'})
CREATE (bucket:Storage {name: 'footage bucket', retention: 'P30D', country: 'DE'}),
       (n)-[:FLOWS_TO]->(bucket), (bucket)-[:LEAKS]->(video)
"""
