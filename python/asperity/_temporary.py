"""A directory that is removed with its user."""

from __future__ import annotations

import os
import weakref


class Temporary:
    """A new directory, `path`, removed with this object by the process that made it."""

    def __init__(self) -> None:
        # Imported where it is needed: with it the package would take twice as long to import.
        import tempfile

        self.path = tempfile.mkdtemp(prefix="asperity-")
        weakref.finalize(self, _remove, self.path, os.getpid())


def _remove(path: str, owner: int) -> None:
    # A process that has forked off holds the same objects, and ends before its parent does.
    if os.getpid() == owner:
        import shutil

        shutil.rmtree(path, ignore_errors=True)
