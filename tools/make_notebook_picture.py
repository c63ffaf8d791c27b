"""Photograph what notebooks show of a model, on a light and a dark page: docs/images/notebook.png.

Run from the repository root; needs Chromium and the development installation.
"""

from __future__ import annotations

import io
import shutil
from pathlib import Path

from PIL import Image
from playwright.sync_api import sync_playwright

from fdvv.model.file import load_builtin
from fdvv.model.landmarks import landmarks
from fdvv.report.notebook import to_html

TARGET = Path(__file__).resolve().parents[1] / "docs" / "images" / "notebook.png"
SCALE = 1.5
PAGES = (("#ffffff", "#1f2328"), ("#111417", "#d7dbe0"))
STYLE = "margin:0;padding:14px;font:14px sans-serif"


def main() -> None:
    """Draw both pages under each other and write the picture."""
    model = load_builtin("mx-blue")
    shown = to_html(model) + '<div style="height:10px"></div>' + to_html(landmarks(model))
    strips = []
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=shutil.which("chromium"))
        for ground, ink in PAGES:
            page = browser.new_page(viewport={"width": 760, "height": 300}, device_scale_factor=SCALE)
            page.set_content(f'<body style="{STYLE};background:{ground};color:{ink}">{shown}</body>')
            strips.append(Image.open(io.BytesIO(page.screenshot(full_page=True))).convert("RGB"))
        browser.close()
    whole = Image.new("RGB", (strips[0].width, sum(strip.height for strip in strips)))
    for i, strip in enumerate(strips):
        whole.paste(strip, (0, sum(above.height for above in strips[:i])))
    whole.quantize(64).save(TARGET, optimize=True)
    print(f"{TARGET.name}: {whole.size}, {TARGET.stat().st_size} bytes")


if __name__ == "__main__":
    main()
