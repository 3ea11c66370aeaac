"""``python -m asperity`` is the command ``asperity``."""

from ._command import main

main()
