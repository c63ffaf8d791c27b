"""Import and export of buttons, vibrations and recordings in other programs' formats."""
