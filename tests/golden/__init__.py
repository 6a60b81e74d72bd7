"""What the program answers, as hashes: a change that is meant to change no answer leaves ``hashes.tsv`` as it is."""
