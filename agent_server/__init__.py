"""A real-time server that lets a virtual agent understand a person's body and face."""

__version__ = "0.1.0"
