"""`python -m rga` is `rga`."""

from rga.cli import main

main()
