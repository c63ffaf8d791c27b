"""The converter and the DMA channel that stores its readings."""

from __future__ import annotations

import struct
from collections.abc import Callable

from fdvv_m0.bus import POLLED, Bus
from fdvv_m0.records import TickInputs
from fdvv_m0.system import Clocks

ADC_CTRLA, ADC_CTRLB, ADC_SWTRIG, ADC_INPUTCTRL = 0x42004000, 0x42004004, 0x4200400C, 0x42004010
ADC_EVCTRL, ADC_INTFLAG, ADC_RESULT = 0x42004014, 0x42004018, 0x4200401A
ADC_PERIPHERAL, FREERUN, FLUSH, START, START_BY_EVENT, READY = 0x1E, 1 << 2, 1, 2, 1, 1
CONVERSION_CLOCKS = 8  # 1 + 12 / 2 + 1: data sheet, single-ended, 12 bits; the last 1 is the longer case
PRESCALE_SHIFT = 2  # CTRLB.PRESCALER 0 divides by 4
SUPPLY_INPUT, FORCE_INPUT, THERMISTOR_INPUT = 4, 5, 10
DMAC_CTRL, BASEADDR, CHCTRLA, CHCTRLB, CHINTFLAG = 0x41004800, 0x41004834, 0x41004840, 0x41004844, 0x4100484E
DMA_ENABLE, TRIGGER_ADC, COMPLETE, VALID, HALFWORDS, COUNT_UP = 2, 0x27, 2, 1, 1 << 8, 1 << 11


class Converter:
    """Starts at the tick's event, runs free, and hands its readings to DMA channel 0."""

    def __init__(self, bus: Bus, clocks: Clocks, inputs: Callable[[], TickInputs]) -> None:
        self._bus, self._clocks, self._inputs = bus, clocks, inputs
        self._run = 0  # of conversions; what an older run had planned is void
        self._is_running = False
        self.burst_ready_cycle: int | None = None
        bus.on_write(ADC_SWTRIG, self._triggered)
        bus.on_write(CHCTRLA, self._channel)
        bus.mark(CHINTFLAG, POLLED)

    def conversion_cycles(self) -> int:
        """Return the processor cycles that one conversion takes."""
        shift = PRESCALE_SHIFT + (self._bus.get(ADC_CTRLB, 2) >> 8 & 7)
        clock = self._clocks.cycles_per_clock(ADC_PERIPHERAL) * (1 << shift)
        if clock * 2.1 < 48:
            raise ValueError(f"the converter is clocked with {48 / clock:.2f} MHz, it may have 2.1")
        return round(CONVERSION_CLOCKS * clock)

    def reads(self) -> int:
        """Return how many readings DMA is to store; 0 before the program has set it up."""
        base = self._bus.get(BASEADDR, 4)
        return int.from_bytes(self._bus.ram_read(base + 2, 2), "little") if base else 0

    def event(self) -> None:
        """Start converting, as the tick's event does; ignored while a conversion runs."""
        enabled = self._bus.get(ADC_CTRLA, 1) & 2 and self._bus.get(ADC_EVCTRL, 1) & START_BY_EVENT
        if enabled and not self._is_running:
            self._start()

    def _triggered(self, _size: int, value: int) -> None:
        if value & FLUSH:
            # its data sheet: if a conversion was pending, the converter starts a new one
            is_pending = self._is_running and bool(self._bus.get(ADC_CTRLB, 2) & FREERUN)
            self._run += 1
            self._is_running = False
            if is_pending:
                self._start()
        if value & START:
            self._start()

    def _start(self) -> None:
        self._run += 1
        self._is_running = True
        this = self._run
        if self._bus.get(ADC_CTRLB, 2) & FREERUN:
            self._begin_burst()
        else:
            self._bus.after(self.conversion_cycles(), lambda: self._finish_one(this))

    def _finish_one(self, this: int) -> None:
        if this != self._run:
            return
        self._is_running = False
        source = self._bus.get(ADC_INPUTCTRL, 4) & 31
        inputs = self._inputs()
        others = {
            SUPPLY_INPUT: inputs.supply_counts,
            FORCE_INPUT: inputs.force_counts,
            THERMISTOR_INPUT: inputs.thermistor_counts,
        }
        self._bus.put(ADC_RESULT, 2, others.get(source, inputs.reading(0)))
        self._bus.put(ADC_INTFLAG, 1, READY)

    def _channel(self, size: int, value: int) -> None:
        self._bus.put(CHCTRLA, size, value)
        if value & DMA_ENABLE and self._is_running and self._bus.get(ADC_CTRLB, 2) & FREERUN:
            self._begin_burst()

    def _begin_burst(self) -> None:
        armed = self._bus.get(CHCTRLA, 1) & DMA_ENABLE and self._bus.get(DMAC_CTRL, 2) & DMA_ENABLE
        trigger = self._bus.get(CHCTRLB, 4) >> 8 & 0x3F
        if armed and trigger == TRIGGER_ADC:
            descriptor = self._bus.ram_read(self._bus.get(BASEADDR, 4), 16)
            control, count, _source, end, _next = struct.unpack("<HHIII", descriptor)
            if control != VALID | HALFWORDS | COUNT_UP:
                raise ValueError(f"DMA descriptor {control:#06x} is not modelled")
            this = self._run
            self._bus.after(count * self.conversion_cycles(), lambda: self._finish_burst(this, count, end))

    def _finish_burst(self, this: int, count: int, end: int) -> None:
        if this != self._run or not self._bus.get(CHCTRLA, 1) & DMA_ENABLE:
            return
        inputs = self._inputs()
        readings = [inputs.reading(i) for i in range(count)]
        self._bus.ram_write(end - 2 * count, struct.pack(f"<{count}H", *readings))
        self._bus.put(CHCTRLA, 1, 0)
        self._bus.put(CHINTFLAG, 1, COMPLETE)
        self.burst_ready_cycle = self._bus.cycles
