"""Questions in Cypher on the page of a database: posted forms in, out rows and what is drawn of them. It only reads."""
