"""The command line ``python -m models``: one file a group of commands."""
