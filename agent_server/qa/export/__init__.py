"""Recordings for other tools: tables, arrays, and scenes in three dimensions."""
