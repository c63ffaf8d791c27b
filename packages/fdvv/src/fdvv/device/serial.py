"""The line to a device on a serial port."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from fdvv.errors import BuildError, DeviceError

if TYPE_CHECKING:
    import serialx

WRITE_s = 1.0
REOPEN_s = 10.0
"""Time in which a device that restarts must be back."""
MISSING = "serial ports need serialx; pip install 'fdvv[serial]'"


def serial_ports() -> list[tuple[str, str]]:
    """List the machine's serial ports and what is on them. BuildError without the extra `serial`."""
    try:
        import serialx
    except ImportError:
        raise BuildError(MISSING) from None
    ports = serialx.list_serial_ports()
    return sorted((port.device, port.product or port.manufacturer or "") for port in ports)


class SerialPort:
    """A line through the system's serial driver, such as /dev/ttyACM0; needs the extra `serial`."""

    def __init__(self, path: str) -> None:
        self._path = path
        self._line = self._open()

    def _open(self) -> serialx.BaseSerial:
        try:
            import serialx
        except ImportError:
            raise BuildError(MISSING) from None
        try:
            line = serialx.serial_for_url(self._path, baudrate=115200, write_timeout=WRITE_s)
            if not line.is_open:
                line.open()
        except (OSError, ValueError, serialx.SerialException) as error:
            reason = getattr(error, "strerror", None) or error
            raise DeviceError(
                f"{self._path}: cannot be opened ({reason}); check the cable, the port's name and permissions"
            ) from error
        return line

    @property
    def name(self) -> str:
        return self._path

    def now_s(self) -> float:
        return time.monotonic()

    def write(self, data: bytes) -> None:
        import serialx

        try:
            self._line.write(data)
        except (OSError, ValueError, serialx.SerialException) as error:
            raise self._disconnect_error(error) from error

    def read(self, until_s: float) -> bytes:
        import serialx

        buffer = bytearray(4096)
        try:
            count = self._line.readinto(buffer, timeout=max(0.0, until_s - time.monotonic()))
        except (OSError, ValueError, serialx.SerialException) as error:
            raise self._disconnect_error(error) from error
        return bytes(buffer[:count])

    def _disconnect_error(self, error: Exception) -> DeviceError:
        return DeviceError(f"{self._path}: the device is gone ({error}); plug it in again")

    def reopen(self) -> None:
        self.close()
        until_s = time.monotonic() + REOPEN_s
        while True:
            try:
                self._line = self._open()
                return
            except DeviceError:
                if time.monotonic() >= until_s:
                    raise
                time.sleep(0.1)

    def close(self) -> None:
        self._line.close()
