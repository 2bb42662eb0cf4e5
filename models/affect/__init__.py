"""Valence and arousal from faces."""
