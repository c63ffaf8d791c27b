"""When and how is a vibration of the rig felt? Simulated: two-way exciter, latency, lead.

Run as ``python -m benchmarks.rig_vibration``.
"""

from __future__ import annotations

from tests.support.cap_vibration import SNAP_AT_mm, SNAP_DURATION_s, SNAP_Hz, cap_vibration, ways

VELOCITIES_mm_s = (50.0, 100.0, 150.0, 200.0, 300.0)


def main() -> None:
    lasts_ms = 1e3 * SNAP_DURATION_s
    print(f"vibration of {SNAP_Hz:g} Hz, {lasts_ms:g} ms at {SNAP_AT_mm:g} mm on MX Clear, simulated")
    print("onset on the cap after its displacement, ms, at mm/s:")
    print(f"{'':34}" + "".join(f"{v:8g}" for v in VELOCITIES_mm_s))
    for name, rig, settings, at_mm in ways():
        shown = [cap_vibration(rig, settings, at_mm, v) for v in VELOCITIES_mm_s]
        print(f"{name:34}" + "".join(f"{f.late_ms:+8.1f}" for f in shown))
    print("rendered, of the last row:")
    for v, f in zip(VELOCITIES_mm_s, shown, strict=True):
        print(
            f"  {v:4g} mm/s: {f.peak_m_s2:5.1f} m/s2, strongest at {f.frequency_Hz:4.0f} Hz,"
            f" lasts {f.lasts_ms:4.1f} ms, likeness {f.likeness:.2f}"
        )


if __name__ == "__main__":
    main()
