"""An analysis in, out come rows in Neo4j; what is in Neo4j goes in, out comes a graph to analyse."""
