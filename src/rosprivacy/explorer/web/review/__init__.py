"""The review, one question at a time in plain words: how a session stands goes in, pages for who signs come out."""
