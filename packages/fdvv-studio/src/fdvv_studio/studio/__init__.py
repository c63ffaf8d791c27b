"""The studio: a web page for the whole laboratory, served on this machine."""
