"""Recordings cut, joined, labelled and made anonymous; each tool writes a new file."""
