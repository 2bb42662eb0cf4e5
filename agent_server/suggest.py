"""The way out of a name that is not known."""

import difflib
from collections.abc import Iterable


def suggest(wrong: str, kind: str, known: Iterable[str]) -> str:
    """The nearest known name, if there is a near one, then all of them.

    Args:
        wrong: The name that is not known.
        kind: What the names are, in the plural, for example ``objects``.
        known: The names that would do.
    """
    names = sorted(known)
    listed = f"known {kind}: {', '.join(names) or 'none'}"
    near = difflib.get_close_matches(wrong, names, n=1)
    return f"did you mean '{near[0]}'? {listed}" if near else listed
