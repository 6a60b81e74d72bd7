"""What runs, and what was recorded: a middleware, a program, texts or bags in, out come observations and bags (S16)."""
