/** Short notices at the edge of the page, read out by screen readers; errors stay until they are closed. */

import { toast as sonner } from "svelte-sonner";
import { lineOf } from "../math/words";
import Alert from "./Alert.svelte";

export type ToastKind = "info" | "done" | "wrong";

const SHOWN_ms = 5000;

/** Show a notice, and what can be done about it; the returned function removes it. */
export function toast(
  text: string,
  kind: ToastKind = "info",
  action?: [label: string, act: () => void],
): () => void {
  const options = {
    class: `toast ${kind}`,
    ...(action && { action: { label: action[0], onClick: action[1] } }),
  };
  const id =
    kind === "wrong"
      ? sonner(Alert, {
          ...options,
          componentProps: { text },
          important: true,
          duration: Number.POSITIVE_INFINITY,
        })
      : sonner(text, { ...options, duration: SHOWN_ms });
  return () => void sonner.dismiss(id);
}

/** What went wrong, whatever was thrown. */
export function tell(error: unknown): void {
  toast(lineOf(error), "wrong");
}

/** Put a text on the clipboard, and say so. */
export async function copyText(text: string, said = "Copied"): Promise<void> {
  try {
    // a browser has none for an address of another machine without TLS
    if (!navigator.clipboard) throw new Error("the browser allows no copying here: select the text instead");
    await navigator.clipboard.writeText(text);
    toast(said, "done");
  } catch (error) {
    tell(error);
  }
}

/** Remove the errors of what goes, and with a whole page all of its notices. */
export function dismissNotices(all: boolean): void {
  for (const { id, important } of sonner.getActiveToasts()) if (all || important) sonner.dismiss(id);
}
