"""A Neo4j of our own, without Docker: a state folder in, out comes a server to connect to."""
