"""The ``fdvv`` command."""
