"""Who writes a file says so to all processes of the machine, as long as it does.

On POSIX by a lock that ends with the process, however it ends. Windows itself refuses to delete
a file that somebody has open.
"""

import sys
from contextlib import suppress
from pathlib import Path

if sys.platform == "win32":

    def hold(descriptor: int) -> None:
        """Do nothing: an open file is held."""

    def is_held(path: Path) -> bool:
        """Say no: deleting tells."""
        return False

else:
    import fcntl
    import os

    def hold(descriptor: int) -> None:
        """Hold an open file until it is closed; a file system without locks is no mistake."""
        with suppress(OSError):
            fcntl.flock(descriptor, fcntl.LOCK_EX)

    def is_held(path: Path) -> bool:
        """Whether somebody, this process included, holds the file."""
        try:
            descriptor = os.open(path, os.O_RDONLY)
        except OSError:
            return False
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            return True
        finally:
            os.close(descriptor)
        return False
