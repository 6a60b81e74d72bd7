"""What is known of bags in, out come the JSON document, lines for the terminal and a table."""
