"""What every device behind the link has in common: limits, uploads, faults."""

from __future__ import annotations

from types import TracebackType
from typing import Self

from fdvv.device._client import Client
from fdvv.device._contract import DeviceInfo, FaultReport
from fdvv.device._image import surface_image
from fdvv.device._limits import check_speed, check_table
from fdvv.device._wire import RefusedError
from fdvv.errors import DeviceError
from fdvv.model import ForceSurface
from fdvv.protocol import BoardFlag, CN64_PER_cN, Fault, Refusal, Settings, UM16_PER_mm, travel_mm_of


class Remote:
    """What every device behind the link has in common: limits, uploads, faults.

    Attributes
    ----------
    client : the connection.
    travel_mm, image : of the active program as uploaded here; None and empty before.
    """

    def __init__(self, client: Client) -> None:
        self.client = client
        self._settings = client.read_settings()
        self.travel_mm: float | None = None
        self.image = b""
        self._closed = False

    def info(self) -> DeviceInfo:
        """Tell who this is."""
        hello, settings = self.client.hello, self._settings
        return DeviceInfo(
            hello.name.rstrip(b"\0").decode("ascii", "replace"),
            bool(hello.board_flags & (BoardFlag.SIMULATED | BoardFlag.EMULATED)),
            settings.force_limit_cN64 / CN64_PER_cN,
            hello.travel_um16_256 * 256 / UM16_PER_mm,
            settings.tick_us * 1e-6,
        )

    def settings(self) -> Settings:
        """Give calibration and limits, as read on opening or written since."""
        return self._settings

    def configure(self, settings: Settings) -> None:
        """Replace calibration and limits, whole or not at all; the device forgets its program.

        Raises DeviceError with the device's reason, one of which is that it is rendering.
        """
        self.client.write_settings(settings)
        self._settings, self.travel_mm = settings, None

    def upload(self, surface: ForceSurface, travel_mm: float, paced: bool = False) -> None:
        """Make surface the active command table and set the stop; DeviceError beyond the limits."""
        check_table(self.info(), surface, travel_mm)
        self.upload_program(surface_image(surface, travel_mm, paced))

    def upload_program(self, image: bytes) -> None:
        """Make a program the active one, whole or not at all; DeviceError with the device's reason."""
        travel_mm = travel_mm_of(image)
        self.client.upload(image)
        self.travel_mm, self.image = travel_mm, image

    def stop(self) -> None:
        """Fall to zero force at once."""
        try:
            self.client.disarm()
        except RefusedError as error:
            if error.refusal is not Refusal.FAULT_LATCHED:
                raise  # in a fault there is no force to end
        self.client.stream(0)

    def fault(self) -> FaultReport:
        """Tell the latched fault."""
        reply = self.client.read_fault()
        return FaultReport(
            Fault(reply.fault),
            reply.value,
            reply.bound,
            reply.time_us * 1e-6,
            reply.displacement_um16 / UM16_PER_mm,
            reply.commanded_cN64 / CN64_PER_cN,
            reply.count,
        )

    def clear_fault(self) -> None:
        """Clear the latched fault; DeviceError while its cause lasts."""
        self.client.clear_fault(self.fault().fault)

    def close(self) -> None:
        """Stop, and let the device go; a second time does nothing."""
        if self._closed:
            return
        self._closed = True
        try:
            self.stop()
        except DeviceError:
            pass  # it is gone, or in fault, and then at zero force already
        finally:
            self.client.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _check_press(self, velocity_mm_s: float) -> float:
        """Give the active program's travel; DeviceError without one, or at an absurd speed."""
        name = self.client.port.name
        if self.travel_mm is None:
            raise DeviceError(f"{name}: press before upload; upload a surface or a program first")
        check_speed(name, velocity_mm_s)
        return self.travel_mm

    def _fail_on_fault(self) -> None:
        """Raise DeviceError if the device fell to zero force."""
        report = self.fault()
        if report.fault is not Fault.NONE:
            raise DeviceError(f"{self.client.port.name}: fell to zero force, {report}; clear the fault")
