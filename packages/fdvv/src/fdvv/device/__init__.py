"""The device contract, and devices: twin, linked firmware, emulated board, serial port, replay."""
