"""Run the command line as ``python -m fdvv``."""

from fdvv.cli import main

main()
