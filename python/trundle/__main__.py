"""`python -m trundle`: the command `trundle`."""

from ._command import main

main()
