/** Short notices at the edge of the page, read out by screen readers; errors stay until they are closed. */

import { lineOf } from "../math/words";
import { h } from "./element";

export type ToastKind = "info" | "done" | "wrong";

const SHOWN_ms = 5000;

function place(): HTMLElement {
  return (
    document.getElementById("toasts") ??
    document.body.appendChild(h("div", { id: "toasts", role: "status", "aria-live": "polite" }))
  );
}

/** Show a notice; the returned function removes it. */
export function toast(text: string, kind: ToastKind = "info"): () => void {
  const remove = () => note.remove();
  const close = h(
    "button",
    { type: "button", class: "button quiet glyph", "aria-label": "Close notice", on: { click: remove } },
    "×",
  );
  const note = h(
    "div",
    { class: `toast ${kind}`, role: kind === "wrong" ? "alert" : null },
    h("span", {}, text),
    close,
  );
  place().append(note);
  if (kind !== "wrong") setTimeout(remove, SHOWN_ms);
  return remove;
}

/** What went wrong, whatever was thrown. */
export function tell(error: unknown): void {
  toast(lineOf(error), "wrong");
}
