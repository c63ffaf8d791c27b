"""Optimisation and a device for another program on this machine: JSON over one WebSocket."""
