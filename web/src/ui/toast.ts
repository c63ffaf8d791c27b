/** Short notices at the edge of the page, read out by screen readers; errors stay until they are closed. */

import { flushSync, mount } from "svelte";
import { toast as sonner, Toaster } from "svelte-sonner";
import { lineOf } from "../math/words";

export type ToastKind = "info" | "done" | "wrong";

let place: object | null = null;

/** Show a notice, and what can be done about it; the returned function removes it. */
export function toast(
  text: string,
  kind: ToastKind = "info",
  action?: [label: string, act: () => void],
): () => void {
  if (!place)
    place = mount(Toaster, {
      target: document.body,
      props: {
        theme: "light",
        closeButton: true,
        closeButtonAriaLabel: "Close notice",
        containerAriaLabel: "Notices",
      },
    });
  const id = sonner(text, {
    unstyled: true,
    class: `toast ${kind}`,
    classes: { closeButton: "button quiet glyph", actionButton: "button" },
    important: kind === "wrong",
    duration: kind === "wrong" ? Number.POSITIVE_INFINITY : 5000,
    ...(action && { action: { label: action[0], onClick: action[1] } }),
  });
  flushSync();
  return () => void sonner.dismiss(id);
}

/** What went wrong, whatever was thrown. */
export function tell(error: unknown): void {
  toast(lineOf(error), "wrong");
}
