"""The command ``asperity``, which comes with the package."""

from __future__ import annotations

import sys

from . import _core


def main() -> None:
    """Run the command with the arguments of this process."""
    sys.exit(_core.main(["asperity", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
