"""Sessions on disk: MCAP files that can be replayed, checked and opened with other tools."""
