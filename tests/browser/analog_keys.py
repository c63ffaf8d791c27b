"""A keyboard that tells how deep its keys are, made up in the page: WebHID's events and real bytes."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from playwright.sync_api import Page

SPACE, KEY_A = 0x2C, 0x04

FAKE = """() => {
  class Keyboard extends EventTarget {
    vendorId = 0x31e3;
    productId = 0x1312;
    productName = "Wooting 60HE";
    opened = false;
    collections = [{ usagePage: 0xff54, usage: 1 }];
    async open() { this.opened = true; }
    async close() { this.opened = false; }
    send(bytes, reportId = 0) {
      if (!this.opened) return;
      const event = new Event("inputreport");
      const data = new DataView(Uint8Array.from(bytes).buffer);
      this.dispatchEvent(Object.assign(event, { device: this, reportId, data }));
    }
    /** Report keys as [code, byte], in the 48 bytes of Wooting's first interface. */
    keys(...down) {
      const bytes = new Uint8Array(48);
      down.forEach(([code, value], i) => bytes.set([code >> 8, code & 255, value], 3 * i));
      this.send(bytes);
    }
  }
  const keyboard = new Keyboard();
  const hid = Object.assign(new EventTarget(), {
    permitted: false,
    asked: [],
    getDevices: async () => (hid.permitted ? [keyboard] : []),
    requestDevice: async ({ filters }) => {
      hid.asked.push(filters);
      hid.permitted = true;
      return [keyboard];
    },
  });
  Object.defineProperty(navigator, "hid", { value: hid, configurable: true });
  globalThis.fakeKeyboard = keyboard;
  /** Move a key from place to place (ms, byte), a report every millisecond if the page can. */
  globalThis.fakeMove = (code, points) => new Promise((done) => {
    const start = performance.now();
    const timer = setInterval(() => {
      const now = performance.now() - start;
      const i = points.findIndex(([ms]) => ms > now);
      if (i < 0) { clearInterval(timer); keyboard.keys(); return done(); }
      const [[t0, a], [t1, b]] = [points[i - 1] ?? [0, 0], points[i]];
      keyboard.keys([code, Math.round(a + ((b - a) * (now - t0)) / (t1 - t0))]);
    }, 1);
  });
}"""
"""A made-up Wooting: `fakeKeyboard.keys([code, byte], …)` is a report, `fakeMove` many of them."""


def plug_in(page: Page) -> None:
    """Have the page find a keyboard; before it is opened."""
    page.add_init_script(f"({FAKE})()")


def report(page: Page, *keys: tuple[int, int]) -> None:
    """Have the keyboard report keys that are down: code and depth of 255."""
    page.evaluate("keys => fakeKeyboard.keys(...keys)", [list(key) for key in keys])


def move(page: Page, code: int, *points: tuple[float, float]) -> None:
    """Move a key from place to place (ms, depth of 255), and let it go."""
    page.evaluate("([code, points]) => fakeMove(code, points)", [code, [list(point) for point in points]])
