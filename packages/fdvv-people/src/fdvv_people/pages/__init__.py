"""The studio's calls and screens of studies and optimisation."""
