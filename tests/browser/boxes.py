"""Measure the boxes of a page's text: what is cut, what lies over other text, what leaves the screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from playwright.sync_api import Page

RECORD = r"""() => {
  // every canvas keeps what is written on it, as boxes on the screen, until it is cleared
  const context = CanvasRenderingContext2D.prototype;
  const texts = new WeakMap(), clips = new WeakMap(), lasts = new WeakMap();
  const was = {};
  for (const name of ["fillText", "clearRect", "rect", "clip", "save", "restore"]) was[name] = context[name];
  const placed = (c, left, top, right, bottom) => {
    const at = c.getTransform();
    const corners = [[left, top], [right, top], [left, bottom], [right, bottom]];
    const points = corners.map(([x, y]) => at.transformPoint(new DOMPoint(x, y)));
    const x = points.map((p) => p.x), y = points.map((p) => p.y);
    return { left: Math.min(...x), right: Math.max(...x), top: Math.min(...y), bottom: Math.max(...y) };
  };
  const stack = (c) => clips.get(c) ?? clips.set(c, [null]).get(c);
  context.save = function () { stack(this).push(stack(this).at(-1)); was.save.call(this); };
  context.restore = function () { if (stack(this).length > 1) stack(this).pop(); was.restore.call(this); };
  context.rect = function (x, y, w, h) {
    lasts.set(this, placed(this, x, y, x + w, y + h));
    was.rect.call(this, x, y, w, h);
  };
  context.clip = function (...rest) {
    stack(this)[stack(this).length - 1] = lasts.get(this) ?? null;
    was.clip.apply(this, rest);
  };
  context.clearRect = function (...rest) { texts.set(this.canvas, []); was.clearRect.apply(this, rest); };
  context.fillText = function (text, x, y, ...rest) {
    const m = this.measureText(text);
    const box = placed(this, x - m.actualBoundingBoxLeft, y - m.actualBoundingBoxAscent,
      x + m.actualBoundingBoxRight, y + m.actualBoundingBoxDescent);
    if (!texts.has(this.canvas)) texts.set(this.canvas, []);
    texts.get(this.canvas).push({ text, ...box, clip: stack(this).at(-1) });
    was.fillText.call(this, text, x, y, ...rest);
  };
  globalThis.fdvvCut = (canvas) => (texts.get(canvas) ?? []).filter(({ left, right, top, bottom, clip }) => {
    const edge = clip ?? { left: 0, top: 0, right: canvas.width, bottom: canvas.height };
    return left < edge.left - 2 || right > edge.right + 2 || top < edge.top - 2 || bottom > edge.bottom + 2;
  });
}"""

MEASURE = r"""() => {
  const AIR = 1.5;
  const ROOT = document.documentElement;
  // what lies over the rest on purpose; text is compared within one of them
  const LAYERS = "main, aside, .driver-popover, " +
    ["dialog", "alertdialog", "menu", "tooltip"].map((role) => `[role=${role}]`).join();
  const layerOf = (e) => {
    for (let up = e; up; up = up.parentElement)
      if (up.matches(LAYERS) || of(up).position === "sticky") return up;
    return null;
  };
  const LEFT_OUT = "script, style, noscript, option, .visually-hidden, .skip, [data-sonner-toaster]";
  const hides = (overflow) => overflow === "hidden" || overflow === "clip";
  const found = [];
  const words = (text) => JSON.stringify(text.trim().replace(/\s+/g, " ").slice(0, 50));
  const where = (e) => `${e.tagName.toLowerCase()}${e.className?.baseVal === undefined && e.className
    ? "." + String(e.className).trim().split(/\s+/).join(".") : ""}`;
  const style = new Map();
  const of = (e) => style.get(e) ?? style.set(e, getComputedStyle(e)).get(e);
  const boxes = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const element = node.parentElement;
    if (!node.data.trim() || element.closest(LEFT_OUT)) continue;
    if (!element.checkVisibility({ visibilityProperty: true })) continue;
    const range = document.createRange();
    range.selectNodeContents(node);
    for (const rect of range.getClientRects()) {
      if (rect.width < 1 || rect.height < 1) continue;
      const { left, right, top, bottom } = rect;
      const layer = layerOf(element);
      const box = { left, right, top, bottom, element, node, page: element.closest("main"), layer };
      let cut = false;
      // the page itself scrolls down, never sideways
      for (let up = element; up && up !== box.page && up !== ROOT; up = up.parentElement) {
        const { overflowX, overflowY, position, textOverflow, webkitLineClamp } = of(up);
        const edge = up.getBoundingClientRect();
        // what is shortened may say in full what it is
        const said = up.closest("[title]") || up.querySelector("[title]");
        const shortened = (textOverflow === "ellipsis" || webkitLineClamp !== "none") && said;
        if (overflowX !== "visible" || overflowY !== "visible") {
          const aside = box.right > edge.right + AIR || box.left < edge.left - AIR;
          const below = box.bottom > edge.bottom + 3 || box.top < edge.top - 3;
          if ((hides(overflowX) && aside) || (hides(overflowY) && below)) cut ||= !shortened;
          box.left = Math.max(box.left, edge.left);
          box.right = Math.min(box.right, edge.right);
          box.top = Math.max(box.top, edge.top);
          box.bottom = Math.min(box.bottom, edge.bottom);
        }
        if (position === "fixed") break;
      }
      if (cut) found.push(`cut: ${words(node.data)} in ${where(element)}`);
      if (box.right - box.left < 1 || box.bottom - box.top < 1) continue;
      if (box.right > innerWidth + AIR || box.left < -AIR)
        found.push(`outside: ${words(node.data)} in ${where(element)}`);
      boxes.push(box);
    }
  }
  for (const field of document.querySelectorAll("button, a.button, select")) {
    if (!field.checkVisibility()) continue;
    const { overflowX } = of(field);
    if (field.scrollWidth > field.clientWidth + AIR && overflowX === "visible" && field.clientWidth)
      found.push(`too wide for its button: ${words(field.textContent)} in ${where(field)}`);
  }
  for (const canvas of document.querySelectorAll("canvas"))
    if (canvas.checkVisibility() && globalThis.fdvvCut)
      for (const { text } of globalThis.fdvvCut(canvas))
        found.push(`cut in a plot: ${words(text)} in ${where(canvas.parentElement)}`);
  boxes.sort((a, b) => a.top - b.top);
  for (let i = 0; i < boxes.length; i++) {
    const a = boxes[i];
    for (let j = i + 1; j < boxes.length && boxes[j].top < a.bottom - 2; j++) {
      const b = boxes[j];
      const wide = Math.min(a.right, b.right) - Math.max(a.left, b.left);
      const high = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      // line boxes are higher than their letters: a third of one may be shared
      const least = Math.min(a.bottom - a.top, b.bottom - b.top) / 3;
      if (a.node !== b.node && a.layer === b.layer && wide > 2 && high > Math.max(3, least))
        found.push(`over each other: ${words(a.node.data)} and ${words(b.node.data)} in ${where(b.element)}`);
    }
  }
  for (const part of [ROOT, document.querySelector("main")])
    if (part.scrollWidth > part.clientWidth + AIR) found.push(`the page is ${part.scrollWidth} px wide`);
  return [...new Set(found)];
}"""


def record(page: Page) -> None:
    """Let the canvases of a page keep what is written on them; before it is opened."""
    page.add_init_script(f"({RECORD})()")


def faults(page: Page) -> list[str]:
    """Return what is wrong with the boxes of a page as it is shown now, one line each."""
    found: list[str] = page.evaluate(MEASURE)
    return found
