"""Label files and a graph in, out come statements about its vertices and flows (rules S7 to S9, S13)."""
