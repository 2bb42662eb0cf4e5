"""Time stamps: integer nanoseconds from the start of the session.

They stay below 2**53, so that JavaScript keeps them exactly.
"""

NS_PER_S = 1_000_000_000
NS_PER_MS = 1_000_000
MAX_STAMP_NS = 2**53 - 1


def to_ns(seconds: float) -> int:
    """Seconds as whole nanoseconds."""
    return round(seconds * NS_PER_S)
