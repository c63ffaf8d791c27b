"""Make the rig's parts anew, with drawings and pictures: ``python tools/make_hardware.py [--pictures]``.

Needs the extras cad, hardware and plot. Writes hardware/ and what the package tells of the printed parts.
--pictures : only draw the pictures, from the exported files; the CAD kernel is not needed.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from fdvv.io.files import write_atomic
from fdvv_rig.dimensions import Dimensions
from fdvv_rig.manifest import Manifest, read_manifest

ROOT = Path(__file__).parents[1]
HARDWARE = ROOT / "hardware"
PRINTED = ROOT / "extras" / "fdvv-rig" / "src" / "fdvv_rig" / "printed.json"


def printed(manifest: Manifest) -> str:
    """Write what the package tells of the default parts: volume, area and size of each."""
    parts = {
        name: {"volume_cm3": made.volume_cm3, "area_cm2": made.area_cm2, "box_mm": list(made.box_mm)}
        for name, made in manifest.parts.items()
    }
    return json.dumps({"digest": manifest.digest, "parts": parts}, indent=1) + "\n"


def main() -> None:
    """Export the parts of the default dimensions, then draw them."""
    if "--pictures" not in sys.argv[1:]:
        from fdvv_rig.cad.export import export_parts

        export_parts(HARDWARE, Dimensions(), lambda name, done, total: print(f"{done + 1}/{total} {name}"))
        write_atomic(PRINTED, printed(read_manifest(HARDWARE)))
    sys.path.insert(0, str(ROOT))
    from tools.hardware_pictures import draw_all

    draw_all(HARDWARE)


if __name__ == "__main__":
    main()
