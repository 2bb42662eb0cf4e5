"""Bodies from any sensor as nine core joints at 25 Hz, and how far they can be trusted."""
