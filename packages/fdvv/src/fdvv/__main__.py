"""Run the command line as ``python -m fdvv``."""

from fdvv.cli.main import main

main()
