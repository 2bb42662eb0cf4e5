"""Recordings of other people's tools and data sets as skeleton frames, one file a source."""
