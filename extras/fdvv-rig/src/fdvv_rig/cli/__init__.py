"""The commands of ``fdvv hardware``."""
